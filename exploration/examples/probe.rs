use pleach_exploration::network::*;
use std::time::Instant;
fn main() {
    let a: Vec<String> = std::env::args().skip(1).collect();
    let n = |i: usize| a[i].parse::<u32>().unwrap();
    let robots = n(0) as usize;
    let faults = Faults { stops: n(1), restarts: n(2), losses: n(3), ..Faults::NONE };
    let graphs = match a[4].as_str() { "line" => Graphs::Line, "num" => Graphs::Numbered, _ => Graphs::UpToSymmetry };
    let tasks = n(5) as usize;
    let steps: &'static [usize] = if a[6] == "2" { &[1, 2] } else { &[1] };
    let rounds = a.get(7).map_or(4, |r| r.parse().unwrap());
    let most = a.get(8).map_or(usize::MAX, |r| r.parse().unwrap());
    let campaign = Campaign { name: "probe", robots, access_points: 1, graphs, tasks, steps, in_a_row: false,
        medium: Medium::Periods { faults, rounds }, contacts: 0, expected: Counts::default() };
    let begin = Instant::now();
    let mut all = Findings::default();
    for (at, it) in campaign.configurations().enumerate().take(most) {
        let (name, configuration) = it.unwrap();
        if let Ok(wanted) = std::env::var("OUTCOME") {
            let mut protocol = Protocol::new(configuration).unwrap();
            let graph = pleach_exploration::explore(&mut protocol, &[], 3_000_000).unwrap();
            let hit = graph.states().iter().position(|state| {
                has_ended(&protocol, state) && protocol.locals(state).any(|l| match l.notice() {
                    pleach_automaton::network::beacon::Notice::Ended { outcome, .. } => outcome.name() == wanted,
                    _ => false,
                })
            });
            if let Some(at) = hit { println!("{name}\n{}", story(&protocol, &graph, at as u32)); return; }
            continue;
        }
        let f = Findings::of(&name, configuration, 3_000_000).unwrap();
        let failed: Vec<_> = f.failures.iter().map(|f| f.property).collect();
        println!("{at} {name}: {:?} {:?} {failed:?} {:.1}s", f.counts, f.outcomes, begin.elapsed().as_secs_f64());
        all = all.and(f);
    }
    println!("{:?} {:?} largest {} {:.1}s", all.counts, all.outcomes, all.largest, begin.elapsed().as_secs_f64());
    let mut by: std::collections::BTreeMap<&str, Vec<&Failure>> = Default::default();
    for f in &all.failures { by.entry(f.property).or_default().push(f); }
    for (p, fs) in by {
        let s = fs.iter().min_by_key(|f| f.story.len()).unwrap();
        println!("==== {p}: {} configurations\n{s}", fs.len());
    }
}
