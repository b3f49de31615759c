//! Fewer faults that still do the same.

use pleach_automaton::network::NodeFaults;
use pleach_automaton::node::MessageFaults;

use super::Storm;

/// The smallest storm found by leaving faults out, and by halving them, that still `fails`.
pub fn shrink(storm: &Storm, mut fails: impl FnMut(&Storm) -> bool) -> Storm {
    let mut smallest = storm.clone();
    loop {
        let Some(smaller) = simpler(&smallest).into_iter().find(|storm| fails(storm)) else {
            return smallest;
        };
        smallest = smaller;
    }
}

/// Rates below this are not halved any more.
const LEAST_RATE: f64 = 0.02;

/// Storms with one fault less, or one that is half as bad.
fn simpler(storm: &Storm) -> Vec<Storm> {
    let mut found = Vec::new();
    let messages = |change: &dyn Fn(&mut MessageFaults)| {
        let mut smaller = storm.clone();
        change(&mut smaller.messages);
        smaller
    };
    found.push(messages(&|messages| messages.loss = 0.0));
    found.push(messages(&|messages| messages.silence = 0.0));
    found.push(messages(&|messages| messages.lateness = 0.0));
    found.push(messages(&|messages| messages.copies = 0.0));
    for at in 0..storm.messages.partitions.len() {
        found.push(messages(&|messages| drop(messages.partitions.remove(at))));
    }
    for at in 0..storm.nodes.len() {
        let mut smaller = storm.clone();
        smaller.nodes.remove(at);
        found.push(smaller);
    }
    let halved = |rate: f64| if rate >= LEAST_RATE { rate / 2.0 } else { rate };
    found.push(messages(&|messages| messages.loss = halved(messages.loss)));
    found.push(messages(&|messages| messages.silence = halved(messages.silence)));
    found.push(messages(&|messages| messages.lateness = halved(messages.lateness)));
    found.push(messages(&|messages| messages.copies = halved(messages.copies)));
    found.push(messages(&|messages| messages.longest_delay /= 2));
    for at in 0..storm.nodes.len() {
        let NodeFaults { crash: Some(crash), .. } = &storm.nodes[at].1 else { continue };
        let mut smaller = storm.clone();
        let mut stops = *crash;
        (stops.back, stops.inputs) = (None, 0);
        smaller.nodes[at].1.crash = Some(stops);
        found.push(smaller);
    }
    found.retain(|smaller| smaller != storm);
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_no_harm_is_left_out() {
        let messages =
            MessageFaults { loss: 0.4, copies: 0.2, lateness: 0.1, ..MessageFaults::default() };
        let storm = Storm { seed: 3, messages, nodes: vec![(1, NodeFaults::default())] };
        let smallest = shrink(&storm, |storm| storm.messages.copies > 0.04);
        let expected = MessageFaults { copies: 0.05, ..MessageFaults::default() };
        assert_eq!(smallest, Storm { seed: 3, messages: expected, nodes: Vec::new() });
    }
}
