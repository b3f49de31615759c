//! Pages of trajectories.

use super::chromium::Page;
use super::missions::kept;
use crate::book::{bouncing_ball, heater_and_controller};
use pleach::automaton::{Automaton, Trajectory};
use pleach::page::TrajectoryPage;
use pleach::prelude::*;

vocabulary! {
    enum Motion: Location { Rising = "rising", Falling = "falling" }
    enum Contact: Event { Top = "top", Bounce = "bounce" }
}
coordinates! { struct Ball { height = "h", velocity = "v" } }

/// A ball that keeps a part of its speed at each bounce.
fn ball() -> Automaton<Motion, Contact, Ball> {
    use {Contact::*, Motion::*};
    let Ball { height, velocity } = Ball::coordinates();
    let fall = || [height.rate(&velocity), velocity.rate(-9.81)];
    Automaton::starting_in(Falling)
        .initially(Ball { height: 10.0, velocity: 0.0 })
        .flow(Falling, fall())
        .flow(Rising, fall())
        .transition(
            from(Falling)
                .on(Bounce)
                .to(Rising)
                .must(height.at_most(0.0) & velocity.less_than(0.0))
                .then([velocity.becomes(-0.8 * &velocity)]),
        )
        .transition(from(Rising).on(Top).to(Falling).must(velocity.at_most(0.0)))
        .build()
        .unwrap()
}

fn open(run: &Trajectory) -> Page {
    let page = TrajectoryPage::new("A ball", run).drawing(&ball()).render();
    Page::open(&kept("ball", &page), [1360, 900])
}

const STATE: &str = "(({ run, player }) => run.variables.map((_, i) => \
                     run.state(run.phase(player.passed), i, player.at).value))(pleach)";
const LIT: &str = "[...document.querySelector('.drawing').shadowRoot.querySelectorAll('.lit')]\
                   .map(box => box.dataset.location)";

#[test]
#[ignore = "needs Chromium: tests/browser/check"]
fn a_trajectory_says_what_was_computed_and_lights_its_location() {
    let run = ball().run(8.0).unwrap();
    let mut page = open(&run);
    for tenths in 0..80 {
        let t = f64::from(tenths) / 10.0 + 0.03;
        page.value(&format!("pleach.player.seek({t})"));
        let shown: Vec<f64> = serde_json::from_value(page.value(STATE)).unwrap();
        let Some(computed) = run.values_at(t) else { continue };
        for (one, other) in shown.iter().zip(&computed) {
            assert!((one - other).abs() < 1e-6, "at {t} s: {shown:?} is not {computed:?}");
        }
        let location = run.location(0, t).unwrap();
        assert_eq!(page.value(LIT), serde_json::json!([location]), "at {t} s");
    }
    // From jump to jump, where instants alone do not tell the state.
    page.press("Home");
    for jump in run.jumps().iter().take(4) {
        page.press("ArrowDown");
        assert!((page.number("pleach.player.at") - jump.at.t).abs() < 1e-6);
        let target = jump.moves[0].target;
        let name = &run.components()[0].locations[target];
        assert_eq!(page.value(LIT), serde_json::json!([name]));
    }
    page.click("#play", None);
    page.value("new Promise(done => setTimeout(done, 500))");
    assert_eq!(page.value("pleach.player.isPlaying"), true);
    page.press(" ");
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
#[ignore = "needs Chromium: tests/browser/check"]
fn classics_play() {
    let (_, heater) = heater_and_controller::exhibit().unwrap().pages().next().unwrap();
    let (_, ball) = bouncing_ball::exhibit().unwrap().pages().next().unwrap();
    for (name, text) in [("heater", heater), ("bouncing-ball", ball)] {
        let mut page = Page::open(&kept(name, &text), [1360, 900]);
        page.value("pleach.player.seek(pleach.player.end * 0.3)");
        for scheme in ["light", "dark"] {
            page.prefer("color-scheme", scheme);
            page.photograph(&format!("{name}-{scheme}"));
        }
        page.resize([400, 820]);
        page.value("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))");
        let width = page.number("document.documentElement.scrollWidth");
        assert!(width <= 400.0, "{name} is {width} pixels wide");
        page.photograph(&format!("{name}-narrow"));
        assert_eq!(page.complaints, Vec::<String>::new());
    }
}
