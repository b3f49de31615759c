//! The album of a mission: chooses the telling moments and keeps the curves.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use pleach_automaton::network::record::{End, Faults, MissionEvent, Snapshot};
use pleach_automaton::network::scenario::ValidScenario;

use crate::mission::Watcher;
use crate::page::MissionPage;
use crate::story;

use super::animation::Film;
use super::canvas::quantity;
use super::curves::{Alike, Chart, Curve, Limit, Sign};
use super::lanes::Lanes;
use super::palette;
use super::plan::Plan;
use super::scene::Scene;
use super::series::Series;

/// The file of the animation.
pub const ANIMATION: &str = "animation.svg";
/// The most curves of robots in a figure.
const MOST_CURVES: usize = 6;
/// Robots are alike that depart from the median by less than this share of the largest departure.
const ALIKE: f64 = 0.25;
/// Ways shorter than this share of ρ are not drawn.
const TRAIL_STEP: f64 = 0.25;

/// Watches a mission period by period and writes its figures at the end, and the page on which it
/// plays.
#[derive(Debug)]
pub struct Album {
    plan: Plan,
    page: MissionPage,
    pictures: Vec<Picture>,
    film: Film,
    trails: Vec<Vec<[f64; 2]>>,
    last: Option<Snapshot>,
    distances: Series,
    residuals: Series,
    multipliers: Series,
    signs: Vec<Sign>,
    lanes: Lanes,
}

/// A telling moment.
#[derive(Clone, Debug)]
struct Picture {
    snapshot: Snapshot,
    headlines: Vec<String>,
    slug: String,
    trails: Vec<Vec<[f64; 2]>>,
}

impl Album {
    /// Opens an empty album of a mission of `scenario`.
    #[must_use]
    pub fn new(scenario: &ValidScenario) -> Album {
        Album::with_faults(scenario, Faults::default())
    }

    /// The same of a mission in which these faults occur.
    #[must_use]
    pub fn with_faults(scenario: &ValidScenario, faults: Faults) -> Album {
        let robots = scenario.robot.len();
        Album {
            plan: Plan::of(scenario),
            page: MissionPage::with_faults(scenario, faults),
            pictures: Vec::new(),
            film: Film::default(),
            trails: Vec::new(),
            last: None,
            distances: Series::new(2),
            residuals: Series::new(robots),
            multipliers: Series::new(robots),
            signs: Vec::new(),
            lanes: Lanes::default(),
        }
    }

    /// The same album with figures that have no title, for papers with captions of their own.
    #[must_use]
    pub fn plain(self) -> Album {
        Album { plan: self.plan.plain(), ..self }
    }

    /// The start, each election, stationary point, release, arrival of a recruit and serviced
    /// task becomes a picture.
    fn extend_pictures(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) {
        self.extend_trails(snapshot);
        self.film.push(snapshot);
        let started = self.last.is_none();
        let captions = || events.iter().filter_map(story::caption);
        self.signs.extend(captions().map(|caption| Sign {
            step: snapshot.step,
            moment: caption.moment,
            number: caption.number,
        }));
        self.lanes.observe(snapshot);
        if started || captions().next().is_some() {
            self.add_picture(snapshot, events, started);
        }
        self.last = Some(snapshot.clone());
    }

    /// Writes the pictures, the curves, an animation and the page, `index.html`, into a folder, which it
    /// creates, and returns the paths in the order of the story, the page last. Pictures that an earlier
    /// mission has left there are removed.
    ///
    /// # Errors
    ///
    /// When the folder or a file cannot be written; the error of the system is passed on.
    pub fn write(&self, folder: &Path, end: &End) -> io::Result<Vec<PathBuf>> {
        fs::create_dir_all(folder)?;
        remove_pictures(folder)?;
        let mut pictures = self.pictures.clone();
        if let Some(last) = &self.last {
            self.add_end(&mut pictures, last, end);
        }
        let digits = pictures.len().to_string().len().max(2);
        let drawn = pictures.iter().enumerate().map(|(index, picture)| {
            let (step, slug) = (picture.snapshot.step, &picture.slug);
            let scene = Scene {
                snapshot: &picture.snapshot,
                title: &picture.title(),
                trails: &picture.trails,
            };
            (format!("{index:0digits$}-k{step:05}-{slug}.svg"), self.plan.render(&scene))
        });
        let curves = self.curve_figures().map(|(name, svg)| (name.to_owned(), svg));
        let film = (ANIMATION.to_owned(), self.film.render(&self.plan, self.last.as_ref()));
        let page = ("index.html".to_owned(), self.page.render());
        let mut written = Vec::new();
        for (name, text) in drawn.chain(curves).chain([film, page]) {
            let path = folder.join(name);
            let named = |error: io::Error| {
                io::Error::new(error.kind(), format!("{}: {error}", path.display()))
            };
            fs::write(&path, text).map_err(named)?;
            written.push(path);
        }
        Ok(written)
    }

    fn extend_curves(&mut self, snapshot: &Snapshot, distances: [f64; 2]) {
        self.distances.push(snapshot.step, distances.into_iter());
        self.residuals.push(snapshot.step, snapshot.residuals.iter().copied());
        self.multipliers.push(snapshot.step, snapshot.multipliers.iter().copied());
    }

    fn extend_trails(&mut self, snapshot: &Snapshot) {
        self.trails.resize(snapshot.positions.len(), Vec::new());
        let step = TRAIL_STEP * self.plan.clearance();
        for (trail, position) in self.trails.iter_mut().zip(&snapshot.positions) {
            let far = trail
                .last()
                .is_none_or(|last| (position.x - last[0]).hypot(position.y - last[1]) > step);
            if far {
                trail.push([position.x, position.y]);
            }
        }
    }

    fn add_picture(&mut self, snapshot: &Snapshot, events: &[MissionEvent], started: bool) {
        let captions: Vec<_> = events.iter().filter_map(story::caption).collect();
        let of_team = |robot: usize| {
            let pursuits = snapshot.pursuits();
            pursuits.iter().find(|it| it.primary_team.contains(&robot)).and_then(|it| it.task)
        };
        let pursued = captions.first().and_then(|caption| of_team(caption.number));
        let named = events.iter().find_map(story::task_of).or(pursued).or(snapshot.task);
        let mut headlines: Vec<String> = named.iter().map(|task| format!("task {task}")).collect();
        let mut slugs: Vec<String> = named.iter().map(|task| format!("task-{task}")).collect();
        if started {
            headlines.push("the start".to_owned());
            slugs.push("start".to_owned());
        }
        headlines.extend(captions.iter().map(|caption| caption.headline.clone()));
        slugs.extend(captions.first().map(|caption| caption.slug.clone()));
        let here = snapshot.positions.iter().map(|point| vec![[point.x, point.y]]).collect();
        self.pictures.push(Picture {
            snapshot: snapshot.clone(),
            headlines,
            slug: slugs.join("-"),
            trails: std::mem::replace(&mut self.trails, here),
        });
    }

    /// Adds the end, to the last picture if that shows the same period.
    fn add_end(&self, pictures: &mut Vec<Picture>, last: &Snapshot, end: &End) {
        let headline = format!("the end: {}", end.outcome.name().replace('_', " "));
        match pictures.last_mut() {
            Some(picture) if picture.snapshot.step == last.step => {
                picture.headlines.push(headline);
                picture.slug.push_str("-end");
            }
            _ => pictures.push(Picture {
                snapshot: last.clone(),
                headlines: vec![headline],
                slug: "end".to_owned(),
                trails: self.trails.clone(),
            }),
        }
    }

    fn curve_figures(&self) -> [(&'static str, String); 3] {
        let clearance = self.plan.clearance();
        let tolerance = self.plan.scenario.control.residual_tolerance.unwrap_or(0.0);
        let distances = Chart {
            subtitle: format!(
                "robots keep 2ρ = {} from each other and ρ = {} from walls and holes",
                quantity(2.0 * clearance),
                quantity(clearance)
            ),
            curves: vec![
                bold_curve("robots", palette::ACCESS_POINT, self.distances.points(0)),
                bold_curve("walls", palette::MEMBER, self.distances.points(1)),
            ],
            limits: vec![
                Limit { value: 2.0 * clearance, label: "2ρ".to_owned() },
                Limit { value: clearance, label: "ρ".to_owned() },
            ],
            ..self.chart(
                "Smallest distance between robots, and from a robot to a wall",
                "distance (scenario's unit)",
            )
        };
        let (curves, alike) = robot_curves(&self.residuals);
        let residuals = Chart {
            curves,
            alike,
            subtitle:
                "what a robot can send beyond what it must, eq. (5): no curve falls below the \
                       dashed line while the network carries all traffic"
                    .to_owned(),
            limits: vec![Limit { value: -tolerance, label: limit_name(tolerance) }],
            ..self.chart("Residuals cᵢ of all robots", "cᵢ (share of the radio's rate)")
        };
        let (curves, alike) = robot_curves(&self.multipliers);
        let multipliers = Chart {
            curves,
            alike,
            subtitle: "the price of rate at every robot; it settles when the routes do, eq. (14)"
                .to_owned(),
            ..self.chart("Lagrange multipliers λᵢ of all robots", "λᵢ")
        };
        [
            ("distances.svg", distances),
            ("residuals.svg", residuals),
            ("multipliers.svg", multipliers),
        ]
        .map(|(name, chart)| (name, chart.render()))
    }

    fn chart<'a>(&'a self, title: &'a str, axis: &'a str) -> Chart<'a> {
        let period = self.plan.scenario.control.period.unwrap_or(1.0);
        Chart {
            title,
            subtitle: String::new(),
            axis,
            period_axis: format!("control period k (of {} s each)", quantity(period)),
            curves: Vec::new(),
            alike: None,
            limits: Vec::new(),
            signs: &self.signs,
            lanes: &self.lanes,
            last_step: self.last.as_ref().map_or(0, |snapshot| snapshot.step),
            is_plain: self.plan.is_plain,
        }
    }
}

/// Removes the pictures of moments from a folder.
fn remove_pictures(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.file_name().and_then(|name| name.to_str()).is_some_and(is_picture) {
            fs::remove_file(path)?;
        }
    }
    Ok(())
}

/// Whether a file is called as pictures of moments are, `08-k00290-task-0-serviced.svg`, or the PDF
/// beside one is.
fn is_picture(name: &str) -> bool {
    let is_number = |text: &str, digits: usize| {
        text.len() >= digits && text.bytes().all(|byte| byte.is_ascii_digit())
    };
    let stem = name.strip_suffix(".svg").or_else(|| name.strip_suffix(".pdf"));
    let mut parts = stem.unwrap_or_default().splitn(3, '-');
    let (number, step, slug) = (parts.next(), parts.next(), parts.next());
    number.is_some_and(|number| is_number(number, 2))
        && step.and_then(|step| step.strip_prefix('k')).is_some_and(|step| is_number(step, 5))
        && slug.is_some_and(|slug| !slug.is_empty())
}

impl Picture {
    fn title(&self) -> String {
        format!("k = {} · {}", self.snapshot.step, self.headlines.join(" · "))
    }
}

fn limit_name(tolerance: f64) -> String {
    if tolerance == 0.0 { "limit".to_owned() } else { "−c_min".to_owned() }
}

fn bold_curve(label: &str, colour: &'static str, points: Vec<[f64; 2]>) -> Curve {
    Curve { label: label.to_owned(), colour, width: 1.6, points }
}

/// A curve for each robot that departs from the others, at most [`MOST_CURVES`], and the range of the others.
fn robot_curves(series: &Series) -> (Vec<Curve>, Option<Alike>) {
    let departures = series.departures();
    let farthest = departures.iter().copied().fold(0.0, f64::max);
    let mut robots: Vec<usize> = (0..departures.len()).collect();
    robots.sort_by(|&one, &other| departures[other].total_cmp(&departures[one]));
    let departs = |&&robot: &&usize| departures[robot] > ALIKE * farthest;
    let apart = match robots.len() {
        few @ ..=MOST_CURVES => few,
        _ => robots.iter().take(MOST_CURVES).take_while(departs).count(),
    };
    let (apart, alike) = robots.split_at_mut(apart);
    apart.sort_unstable();
    let curve = |(&robot, colour): (&usize, &&'static str)| Curve {
        label: format!("robot {robot}"),
        colour,
        width: 1.2,
        points: series.points(robot),
    };
    let ranges = (!alike.is_empty())
        .then(|| Alike { label: format!("{} others", alike.len()), ranges: series.range(alike) });
    (apart.iter().zip(&palette::CURVES).map(curve).collect(), ranges)
}

impl Watcher for Album {
    fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()> {
        let distances = self.page.take_in(snapshot, events)?;
        self.extend_curves(snapshot, distances);
        self.extend_pictures(snapshot, events);
        Ok(())
    }

    fn end(&mut self, end: &End) -> io::Result<()> {
        self.page.end(end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twenty robots of which two depart, one of them in a single period.
    #[test]
    fn robots_that_are_alike_share_a_band() {
        let mut series = Series::new(20);
        for step in 0..10 {
            let value = |robot: usize| match robot {
                3 => 2.0,
                7 if step == 4 => 3.0,
                _ => 0.01 * robot as f64,
            };
            series.push(step, (0..20).map(value));
        }
        let (curves, alike) = robot_curves(&series);
        let labels: Vec<&str> = curves.iter().map(|curve| curve.label.as_str()).collect();
        assert_eq!(labels, ["robot 3", "robot 7"]);
        let alike = alike.unwrap();
        assert_eq!(alike.label, "18 others");
        assert!(alike.ranges.iter().all(|range| range[1..] == [0.0, 0.19]), "{:?}", alike.ranges);
    }

    #[test]
    fn a_few_robots_have_a_curve_each() {
        let mut series = Series::new(MOST_CURVES);
        series.push(0, (0..MOST_CURVES).map(|_| 1.0));
        let (curves, alike) = robot_curves(&series);
        assert!(curves.len() == MOST_CURVES && alike.is_none());
    }
}
