//! Fewer faults that still do the same.

use pleach_automaton::network::Trouble;
use pleach_automaton::node::Weather;

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
    let weather = |change: &dyn Fn(&mut Weather)| {
        let mut smaller = storm.clone();
        change(&mut smaller.weather);
        smaller
    };
    found.push(weather(&|weather| weather.loss = 0.0));
    found.push(weather(&|weather| weather.silence = 0.0));
    found.push(weather(&|weather| weather.lateness = 0.0));
    found.push(weather(&|weather| weather.copies = 0.0));
    for at in 0..storm.weather.partitions.len() {
        found.push(weather(&|weather| drop(weather.partitions.remove(at))));
    }
    for at in 0..storm.troubles.len() {
        let mut smaller = storm.clone();
        smaller.troubles.remove(at);
        found.push(smaller);
    }
    let halved = |rate: f64| if rate >= LEAST_RATE { rate / 2.0 } else { rate };
    found.push(weather(&|weather| weather.loss = halved(weather.loss)));
    found.push(weather(&|weather| weather.silence = halved(weather.silence)));
    found.push(weather(&|weather| weather.lateness = halved(weather.lateness)));
    found.push(weather(&|weather| weather.copies = halved(weather.copies)));
    found.push(weather(&|weather| weather.longest_delay /= 2));
    for at in 0..storm.troubles.len() {
        let Trouble { crash: Some(crash), .. } = &storm.troubles[at].1 else { continue };
        let mut smaller = storm.clone();
        let mut stops = *crash;
        (stops.back, stops.inputs) = (None, 0);
        smaller.troubles[at].1.crash = Some(stops);
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
        let weather = Weather { loss: 0.4, copies: 0.2, lateness: 0.1, ..Weather::default() };
        let storm = Storm { seed: 3, weather, troubles: vec![(1, Trouble::default())] };
        let smallest = shrink(&storm, |storm| storm.weather.copies > 0.04);
        let expected = Weather { copies: 0.05, ..Weather::default() };
        assert_eq!(smallest, Storm { seed: 3, weather: expected, troubles: Vec::new() });
    }
}
