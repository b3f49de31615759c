//! The album of a mission: chooses the telling moments and keeps the curves.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use pleach_automaton::network::record::{End, MissionEvent, Snapshot};
use pleach_automaton::network::scenario::Scenario;

use crate::mission::Watcher;

use super::canvas::quantity;
use super::curves::{Chart, Curve, DISTINCT_CURVES, Limit, Sign};
use super::palette;
use super::plan::{Plan, sides};
use super::scene::Scene;
use super::series::Series;
use super::spacing::{smallest_clearance, smallest_pair_distance};
use super::{page, story};

/// Ways shorter than this share of ρ are not drawn.
const TRAIL_STEP: f64 = 0.25;

/// Watches a mission period by period and writes its figures at the end.
#[derive(Clone, Debug)]
pub struct Album {
    plan: Plan,
    walls: Vec<([f64; 2], [f64; 2])>,
    pages: Vec<Page>,
    /// Sentences since the last page.
    meanwhile: Vec<String>,
    trails: Vec<Vec<[f64; 2]>>,
    last: Option<Snapshot>,
    distances: Series,
    residuals: Series,
    multipliers: Series,
    signs: Vec<Sign>,
    tasks: Vec<(usize, usize)>,
}

/// A telling moment.
#[derive(Clone, Debug)]
struct Page {
    snapshot: Snapshot,
    headlines: Vec<String>,
    slug: String,
    narration: Vec<String>,
    trails: Vec<Vec<[f64; 2]>>,
}

impl Album {
    /// Opens an empty album. `free_space_outline` holds the loops of the boundary of W_f, in any
    /// orientation; where it is empty the figures leave it out.
    #[must_use]
    pub fn new(scenario: &Scenario, free_space_outline: Vec<Vec<[f64; 2]>>) -> Album {
        let plan = Plan::new(scenario, free_space_outline);
        let walls = plan.loops().flat_map(|corners| sides(corners)).collect();
        let robots = scenario.robot.len();
        Album {
            plan,
            walls,
            pages: Vec::new(),
            meanwhile: Vec::new(),
            trails: Vec::new(),
            last: None,
            distances: Series::new(2),
            residuals: Series::new(robots),
            multipliers: Series::new(robots),
            signs: Vec::new(),
            tasks: Vec::new(),
        }
    }

    /// Takes the snapshot of a period and the events that led to it.
    ///
    /// The start, each election, stationary point, release, arrival of a recruit and serviced
    /// task becomes a picture; other events become sentences between the pictures.
    pub fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) {
        self.extend_curves(snapshot);
        self.extend_trails(snapshot);
        let started = self.last.is_none();
        let moments = events.iter().filter_map(story::moment);
        self.signs.extend(moments.map(|(moment, number)| Sign {
            step: snapshot.step,
            moment,
            number,
        }));
        if let Some(task) = snapshot.task
            && self.tasks.last().is_none_or(|(_, pursued)| *pursued != task)
        {
            self.tasks.push((snapshot.step, task));
        }
        self.meanwhile.extend(events.iter().filter_map(|event| {
            Some(format!("k = {}: {}", snapshot.step, story::sentence(event)?))
        }));
        if started || events.iter().any(|event| story::moment(event).is_some()) {
            self.add_page(snapshot, events, started);
        }
        self.last = Some(snapshot.clone());
    }

    /// Writes the pictures, the curves and `index.html` into a folder, which it creates, and
    /// returns the paths in the order of the story, the index last.
    ///
    /// # Errors
    ///
    /// When the folder or a file cannot be written; the error of the system is passed on.
    pub fn write(&self, folder: &Path, end: &End) -> io::Result<Vec<PathBuf>> {
        fs::create_dir_all(folder)?;
        let mut pages = self.pages.clone();
        if let Some(last) = &self.last {
            self.add_end(&mut pages, last, end);
        }
        let digits = pages.len().to_string().len().max(2);
        let mut figures: Vec<page::Figure> = pages
            .iter()
            .enumerate()
            .map(|(index, entry)| page::Figure {
                file: format!("{index:0digits$}-k{:05}-{}.svg", entry.snapshot.step, entry.slug),
                narration: entry.narration.clone(),
                picture: self.plan.render(&Scene {
                    snapshot: &entry.snapshot,
                    title: &entry.title(),
                    trails: &entry.trails,
                }),
            })
            .collect();
        figures.extend(self.curve_figures());
        let index = page::render(&self.plan.scenario, &figures, end);
        let mut written = Vec::new();
        for figure in &figures {
            written.push(folder.join(&figure.file));
            fs::write(folder.join(&figure.file), &figure.picture)?;
        }
        written.push(folder.join("index.html"));
        fs::write(folder.join("index.html"), index)?;
        Ok(written)
    }

    fn extend_curves(&mut self, snapshot: &Snapshot) {
        let points: Vec<[f64; 2]> = snapshot.positions.iter().map(|p| [p.x, p.y]).collect();
        let pair = smallest_pair_distance(&points);
        let clearance = smallest_clearance(&points, &self.walls);
        self.distances.push(snapshot.step, [pair, clearance].into_iter());
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

    fn add_page(&mut self, snapshot: &Snapshot, events: &[MissionEvent], started: bool) {
        let named = events.iter().find_map(story::task_of).or(snapshot.task);
        let mut headlines: Vec<String> = named.iter().map(|task| format!("task {task}")).collect();
        let mut slugs: Vec<String> = named.iter().map(|task| format!("task-{task}")).collect();
        if started {
            headlines.push("the start".to_owned());
            slugs.push("start".to_owned());
        }
        headlines.extend(events.iter().filter_map(story::headline));
        slugs.extend(events.iter().find_map(story::slug));
        let here = snapshot.positions.iter().map(|point| vec![[point.x, point.y]]).collect();
        self.pages.push(Page {
            snapshot: snapshot.clone(),
            headlines,
            slug: slugs.join("-"),
            narration: std::mem::take(&mut self.meanwhile),
            trails: std::mem::replace(&mut self.trails, here),
        });
    }

    /// Adds the end, to the last picture if that shows the same period.
    fn add_end(&self, pages: &mut Vec<Page>, last: &Snapshot, end: &End) {
        let headline = format!("the end: {}", end.outcome.name().replace('_', " "));
        match pages.last_mut() {
            Some(page) if page.snapshot.step == last.step => {
                page.headlines.push(headline);
                page.slug.push_str("-end");
                page.narration.extend(self.meanwhile.iter().cloned());
            }
            _ => pages.push(Page {
                snapshot: last.clone(),
                headlines: vec![headline],
                slug: "end".to_owned(),
                narration: self.meanwhile.clone(),
                trails: self.trails.clone(),
            }),
        }
    }

    fn curve_figures(&self) -> [page::Figure; 3] {
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
        let residuals = Chart {
            subtitle: "what a robot can send beyond what it must: the network holds while none \
                       falls below the dashed line, eq. (5)"
                .to_owned(),
            curves: robot_curves(&self.residuals),
            limits: vec![Limit { value: -tolerance, label: limit_name(tolerance) }],
            ..self.chart("Residuals cᵢ of all robots", "cᵢ (share of the radio's rate)")
        };
        let multipliers = Chart {
            subtitle: "the price of rate at every robot; it settles when the routes do, eq. (14)"
                .to_owned(),
            curves: robot_curves(&self.multipliers),
            limits: Vec::new(),
            ..self.chart("Lagrange multipliers λᵢ of all robots", "λᵢ")
        };
        [
            (
                "distances.svg",
                distances,
                "Nothing touches anything: the curves stay above their limits.",
            ),
            (
                "residuals.svg",
                residuals,
                "Every robot can always send on what it makes and receives.",
            ),
            (
                "multipliers.svg",
                multipliers,
                "The multipliers of the routing problem, one curve a robot.",
            ),
        ]
        .map(|(file, chart, caption)| page::Figure {
            file: file.to_owned(),
            narration: vec![caption.to_owned()],
            picture: chart.render(),
        })
    }

    fn chart<'a>(&'a self, title: &'a str, axis: &'a str) -> Chart<'a> {
        let period = self.plan.scenario.control.period.unwrap_or(1.0);
        Chart {
            title,
            subtitle: String::new(),
            axis,
            period_axis: format!("control period k (of {} s each)", quantity(period)),
            curves: Vec::new(),
            limits: Vec::new(),
            signs: &self.signs,
            tasks: &self.tasks,
            last_step: self.last.as_ref().map_or(0, |snapshot| snapshot.step),
        }
    }
}

impl Page {
    fn title(&self) -> String {
        format!("k = {} · {}", self.snapshot.step, self.headlines.join(" · "))
    }
}

fn limit_name(tolerance: f64) -> String {
    if tolerance == 0.0 { "limit".to_owned() } else { "−c_min".to_owned() }
}

fn bold_curve(label: &str, colour: &'static str, points: Vec<[f64; 2]>) -> Curve {
    Curve { label: label.to_owned(), colour, dashed: false, width: 1.6, opacity: 1.0, points }
}

/// One curve a robot; in crowds they are faint and without names.
fn robot_curves(series: &Series) -> Vec<Curve> {
    let robots = series.curves();
    let distinct = robots <= DISTINCT_CURVES;
    (0..robots)
        .map(|robot| Curve {
            label: if distinct { format!("robot {robot}") } else { String::new() },
            colour: palette::CURVES[robot % palette::CURVES.len()],
            dashed: distinct && robot >= palette::CURVES.len(),
            width: if distinct { 1.2 } else { 0.8 },
            opacity: if distinct { 0.9 } else { 0.45 },
            points: series.points(robot),
        })
        .collect()
}

impl Watcher for Album {
    fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()> {
        Album::observe(self, snapshot, events);
        Ok(())
    }
}
