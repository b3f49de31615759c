//! The mission on the map of a real building, and its picture in the how-to.

use crate::generated::{keep_up_to_date, root};
use pleach::automaton::network::record::Outcome;
use pleach::figures::Album;
use pleach::import::{self, Choices, Reading};
use pleach::mission;
use std::path::Path;

#[test]
fn a_real_building_is_serviced() {
    let map = root().join("../maps/willow.yaml");
    let plan = import::read(&map, &Reading::default()).unwrap();
    let choices = Choices { robots: 12, clearance: Some(0.25), ..Choices::named("willow") };
    let (scenario, _) = import::skeleton(&plan, &choices).unwrap();
    let mut album = Album::new(&scenario);
    let end = mission::run(&scenario, &mut [&mut album]).unwrap().end;
    assert_eq!(end.outcome, Outcome::Serviced, "{}", end.reason);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("willow");
    let figures = album.write(&folder, &end).unwrap();
    let last = figures.iter().find(|path| path.to_string_lossy().contains("end.svg"));
    let picture = std::fs::read_to_string(last.unwrap()).unwrap();
    keep_up_to_date("../../docs/pictures/willow.svg", &picture, "imported");
}
