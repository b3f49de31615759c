//! The shipped scenarios once more: what an oracle that knows nothing of the monitor reads out of their traces.

use missions::oracle::audit;
use missions::{shipped_mission, shipped_names};
use pleach::trace::TraceReader;
use pleach::verify::network::Extreme;

#[test]
fn the_oracle_agrees_with_the_monitor_on_every_shipped_scenario() {
    for name in shipped_names() {
        let (mission, _) = shipped_mission(&name);
        let findings = audit(TraceReader::new(mission.trace().as_slice()).unwrap())
            .unwrap_or_else(|fault| panic!("{name}: {fault}"));
        let close = |what: &str, measured: f64, extreme: &Option<Extreme>| {
            let monitored = extreme.as_ref().unwrap();
            let difference = (measured - monitored.value).abs();
            assert!(difference < 1e-9, "{name}, {what}: {measured} {monitored:?}");
        };
        close("distance of a pair", findings.pair_distance, &mission.extremes.pair_distance);
        close("clearance", findings.clearance, &mission.extremes.clearance);
        close("residual", findings.residual, &mission.extremes.residual);
        close("load", findings.load, &mission.extremes.load);
    }
}
