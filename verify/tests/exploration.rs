//! Exploration.
#![allow(clippy::unwrap_used)]
use pleach_verify::exploration::{Fairness, explore};
use pleach_verify::network::exploration::{ALWAYS, Configuration, Medium, Places, Protocol, has_ended, story};

fn run(places: Places, medium: Medium, contacts: u32, limit: usize) {
    let begin = std::time::Instant::now();
    let mut protocol = Protocol::new(Configuration { places, medium, contacts }).unwrap();
    let exploration = explore(&mut protocol, ALWAYS, limit).unwrap();
    println!("{} states, {} transitions, depth {}, {} locals, {:?}", exploration.states().len(), exploration.transition_count(), exploration.depth(), protocol.nodes().len(), begin.elapsed());
    for violation in exploration.violations() {
        println!("VIOLATED {}:\n{}", violation.property, story(&protocol, &exploration, violation.state));
    }
    let traps = exploration.traps(|state| has_ended(&protocol, state), Fairness::Weak);
    println!("{} traps", traps.len());
    if let Some(&trap) = traps.first() {
        println!("TRAP\n{}", story(&protocol, &exploration, trap));
    }
    let ends: std::collections::BTreeMap<String, usize> = exploration.states().iter().filter(|s| has_ended(&protocol, s)).map(|s| format!("{:?}", protocol.locals(s).last().unwrap().notice())).fold(Default::default(), |mut m, k| { *m.entry(k).or_default() += 1; m });
    println!("{ends:#?}");
}

#[test]
fn small() {
    let medium = match std::env::var("MEDIUM").as_deref() { Ok("any") => Medium::AnyOrder, Ok(n) => Medium::Rounds { losses: n.parse().unwrap() }, _ => Medium::Rounds { losses: 0 } };
    let num = |name: &str, default: usize| std::env::var(name).map_or(default, |v| v.parse().unwrap());
    let robots = num("ROBOTS", 2);
    // A line: access point, then robots, then places to the task.
    let extra = num("EXTRA", 1);
    let places = robots + 1 + extra;
    let mut edges: Vec<_> = vec![(robots, 0)];
    edges.extend((1..robots).map(|r| (r - 1, r)));
    let mut last = robots - 1;
    for place in robots + 1..places { edges.push((last, place)); last = place; }
    let places = Places::new(robots, 1, places, &edges, &[last]).unwrap();
    run(places, medium, num("CONTACTS", 0) as u32, num("LIMIT", 1_000_000));
}
