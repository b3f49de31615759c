//! Instants do not drift.

use pleach_automaton::{Automaton, Composition, Reason, from};

use super::Cue::Go;
use super::Place::Here;
use super::{Body, built, go, metronome, ramp, run, times, x};

#[test]
fn ticks_at_the_horizon_are_taken() {
    for (period, horizon, ticks) in [(1.0, 1000.0, 1000), (0.1, 1.0, 10), (0.1, 100.0, 1000)] {
        let trajectory = run(&metronome(period, 1.0), horizon);
        assert_eq!(trajectory.jumps().len(), ticks, "{period} {horizon}");
        assert_eq!(trajectory.ending().at.t, horizon);
    }
}

/// A hundred tenths are a little more than 10, for a tenth is no number: the last tick is due after that of
/// the other clock, and nearest to the horizon all the same.
#[test]
fn ticks_of_several_clocks_at_the_horizon_are_taken() {
    let apart = Composition::builder()
        .add("slow", &metronome(0.25, 1.0))
        .add("fast", &metronome(0.1, 1.0))
        .build()
        .expect("the parts fit");
    let trajectory = apart.run(10.0).expect("it can be run");
    assert_eq!(trajectory.jumps().len(), 40 + 100);
    assert_eq!(trajectory.ending().reason, Reason::Horizon);

    let Body { h, v, clock } = Body::coordinates();
    let tick = |guard, reset| from(Here).on(Go).to(Here).must(guard).then(reset);
    let together = Automaton::starting_in(Here)
        .initially(Body { h: 0.0, v: 0.0, clock: 1.0 })
        .flow(Here, [h.rate(1.0), v.rate(1.0), clock.rate(-1.0 * &clock)])
        .transition(tick(h.at_least(0.25), h.becomes(0.0)))
        .transition(tick(v.at_least(0.1), v.becomes(0.0)));
    let trajectory = run(&built(together), 10.0);
    assert_eq!(trajectory.jumps().len(), 40 + 100);
    assert_eq!((&trajectory.ending().reason, trajectory.ending().at.t), (&Reason::Horizon, 10.0));
}

#[test]
fn a_million_ticks_happen_at_the_nearest_numbers() {
    for (period, rate, ticks) in [(0.1, 1.0, 1_000_000), (0.7, 3.0, 200_000)] {
        let until = (f64::from(ticks) + 0.5) * period / rate;
        let found = times(&run(&metronome(period, rate), until));
        assert_eq!(found.len(), ticks as usize);
        for (tick, found) in (1..).zip(found) {
            let exact = nearest_multiple(tick, period, rate);
            assert!(exact.contains(&found), "{found} {exact:?}, {tick} · {period} ÷ {rate}");
        }
    }
}

/// The number nearest to k · p ÷ r, by whole numbers: p = m · 2⁻ˢ. Of two that are equally near, the
/// smaller and the larger.
fn nearest_multiple(tick: u32, period: f64, rate: f64) -> [f64; 2] {
    let shift = 58 - period.log2().floor() as i32;
    let mantissa = (period * 2f64.powi(shift)) as u128;
    let scaled = (u128::from(tick) * mantissa) << 20;
    let (quotient, rest) = (scaled / rate as u128, scaled % rate as u128);
    let spare = (128 - quotient.leading_zeros()).saturating_sub(53);
    let (kept, dropped) = (quotient >> spare, quotient & ((1 << spare) - 1));
    let half = 1u128 << (spare - 1);
    let number = |kept: u128| kept as f64 * 2f64.powi(spare as i32 - shift - 20);
    let is_half = dropped == half && rest == 0;
    let up = number(kept + u128::from(dropped >= half));
    [if is_half { number(kept) } else { up }, up]
}

/// A sampled controller: at every tick the force is set by what is measured, and the clock set back.
#[test]
fn sampled_controls_do_not_drift() {
    let Body { h, v, clock } = Body::coordinates();
    let machine = built(
        Automaton::starting_in(Here)
            .initially(Body { h: 1.0, v: 0.0, clock: 0.0 })
            .flow(Here, [h.rate(&v), v.rate(-1.0 * &v - &h), clock.rate(1.0)])
            .transition(
                from(Here)
                    .on(Go)
                    .to(Here)
                    .must(clock.at_least(0.01))
                    .then([v.becomes(&v - 0.1 * &h), clock.becomes(0.0)]),
            ),
    );
    let trajectory = run(&machine, 1000.0);
    let found = times(&trajectory);
    assert_eq!(found.len(), 100_000);
    for (tick, found) in (1..).zip(found) {
        assert!(nearest_multiple(tick, 0.01, 1.0).contains(&found), "tick {tick} at {found}");
    }
}

/// A clock that may be set back where its invariant ends is set back at the last instant that the
/// invariant allows, also at the horizon.
#[test]
fn what_may_happen_where_an_invariant_ends_does_not_drift() {
    let due = |period: f64| x().at_least(period) & x().at_most(period);
    for period in [0.1, 0.3, 1.0] {
        for invariant in [x().at_most(period), x().less_than(period)] {
            for guard in [x().at_least(period), due(period)] {
                let back = from(Here).on(Go).to(Here).may(guard).then(x().becomes(0.0));
                let clock = built(ramp().invariant(Here, invariant.clone()).transition(back));
                let found = times(&run(&clock, 1000.0 * period));
                assert_eq!(found.len(), 1000, "{period}");
                for (tick, found) in (1..).zip(found) {
                    let exact = nearest_multiple(tick, period, 1.0);
                    assert!(exact.contains(&found), "{found} {exact:?}");
                }
            }
        }
    }
    // The sum of two clocks, 0.03 + 0.27, is rounded to a number beyond 0.3.
    let Body { h, v, clock } = Body::coordinates();
    let sum = || &clock + &h;
    let back = [clock.becomes(0.0), h.becomes(0.0)];
    let clocks = Automaton::starting_in(Here)
        .initially(Body { h: 0.0, v: 0.0, clock: 0.0 })
        .flow(Here, [h.rate(9.0), v.rate(0.0), clock.rate(1.0)])
        .invariant(Here, sum().at_most(0.3))
        .transition(from(Here).on(Go).to(Here).may(sum().at_least(0.3)).then(back));
    let found = times(&run(&built(clocks), 300.0));
    assert_eq!(found.len(), 10_000);
    for (tick, found) in (1..).zip(found) {
        assert!(nearest_multiple(tick, 0.3, 10.0).contains(&found), "tick {tick} at {found}");
    }
    // Without a transition the run lasts to the horizon.
    let clock = built(ramp().invariant(Here, x().at_most(1.0)));
    assert_eq!(run(&clock, 1.0).ending().reason, Reason::Horizon);
}

#[test]
fn early_events_are_as_exact_before_a_far_horizon() {
    let found = times(&run(&go(x().at_least(0.1)), 1e9));
    assert_eq!(found, [0.1]);
    let found = times(&run(&go(x().power(3.0).at_least(0.001)), 1e9));
    assert!((found[0] - 0.1).abs() < 1e-16, "{found:?}");
}
