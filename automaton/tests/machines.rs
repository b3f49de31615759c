//! Machines of the literature, each written as the README writes its model, with an answer in closed form,
//! by fractions or by mpmath at 30 digits.

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

use pleach_automaton::{
    Accumulation, Automaton, Composition, Reason, Settings, Trajectory, coordinates, from,
};
use pleach_discrete::vocabulary;
use pleach_guards::Expression;

fn assert_near(found: f64, exact: f64, tolerance: f64) {
    assert!((found - exact).abs() < tolerance, "{found} is not {exact}");
}

/// The events and their instants, to within a tolerance; nothing is in doubt.
fn tells(trajectory: &Trajectory, expected: &[(&str, f64)], tolerance: f64) {
    let found: Vec<_> =
        trajectory.jumps().iter().map(|jump| (jump.label.as_str(), jump.at.t)).collect();
    assert!(trajectory.doubts().is_empty(), "{:?}", trajectory.doubts());
    assert!(found.len() >= expected.len(), "{found:?}, {:?}", trajectory.ending());
    for ((event, time), (name, exact)) in found.iter().zip(expected) {
        assert!(
            event == name && (time - exact).abs() < tolerance,
            "{event} {time}: {name} {exact}"
        );
    }
}

vocabulary! {
    enum Rods: Location { Out = "no rod", First = "first rod", Second = "second rod", Down = "shut down" }
    enum Control: Event { Insert = "insert", Remove = "remove", Stop = "stop" }
}
coordinates! {
    struct Reactor { heat = "θ", first = "x₁", second = "x₂" }
}

/// The reactor of R. Alur et al. 1995 (doi:10.1016/0304-3975(94)00202-T): a rod may be used again 20 s
/// after it was removed. It takes 10 ln 5 to warm up or to cool by the first rod, 10 ln (9 ÷ 5) by the
/// second, and with these they take turns for ever.
#[test]
fn a_reactor_is_cooled_by_two_rods_in_turn() {
    let Reactor { heat, first, second } = Reactor::coordinates();
    let rates =
        |constant: f64| [heat.rate(0.1 * &heat + constant), first.rate(1.0), second.rate(1.0)];
    let hot = || heat.at_least(550.0);
    let reactor = Automaton::starting_in(Rods::Out)
        .initially(Reactor { heat: 510.0, first: 20.0, second: 20.0 })
        .flow(Rods::Out, rates(-50.0))
        .flow(Rods::First, rates(-56.0))
        .flow(Rods::Second, rates(-60.0))
        .transition(
            from(Rods::Out).on(Control::Insert).to(Rods::First).must(hot() & first.at_least(20.0)),
        )
        .transition(
            from(Rods::Out)
                .on(Control::Insert)
                .to(Rods::Second)
                .must(hot() & first.less_than(20.0) & second.at_least(20.0)),
        )
        .transition(
            from(Rods::Out)
                .on(Control::Stop)
                .to(Rods::Down)
                .must(hot() & first.less_than(20.0) & second.less_than(20.0)),
        )
        .transition(
            from(Rods::First)
                .on(Control::Remove)
                .to(Rods::Out)
                .must(heat.at_most(510.0))
                .then(first.becomes(0.0)),
        )
        .transition(
            from(Rods::Second)
                .on(Control::Remove)
                .to(Rods::Out)
                .must(heat.at_most(510.0))
                .then(second.becomes(0.0)),
        )
        .build()
        .expect("the model is sound");
    let trajectory = reactor.run(1000.0).expect("it can be run");
    let (slow, fast) = (10.0 * 5f64.ln(), 10.0 * 1.8f64.ln());
    let (mut time, mut expected) = (0.0, Vec::new());
    for number in 0..18 {
        time += slow;
        expected.push(("insert", time));
        time += if number % 2 == 0 { slow } else { fast };
        expected.push(("remove", time));
    }
    tells(&trajectory, &expected, 1e-9);
    assert!(trajectory.jumps().iter().all(|jump| jump.label != "stop"));
}

vocabulary! {
    enum Standing: Location { Rocking = "rocking" }
    enum Touch: Event { Impact = "impact" }
}
coordinates! {
    struct Block { tilt = "θ", speed = "ω" }
}

/// The slender block of G. W. Housner 1963 ("The behavior of inverted pendulum structures during
/// earthquakes", *Bulletin of the Seismological Society of America* 53) with p = 4, α = ¼, which keeps 0.9
/// of its speed at each impact: θ̈ = p² (θ − α) between them, where tilts to both sides count as positive.
/// The times between impacts are (2 ÷ p) artanh (0.9ⁿ r); their infinite sum is by mpmath.
#[test]
fn a_rocking_block_comes_to_rest() {
    let Block { tilt, speed } = Block::coordinates();
    let block = Automaton::starting_in(Standing::Rocking)
        .initially(Block { tilt: 0.1, speed: 0.0 })
        .flow(Standing::Rocking, [tilt.rate(&speed), speed.rate(16.0 * (&tilt - 0.25))])
        .invariant(Standing::Rocking, tilt.at_least(0.0))
        .transition(
            from(Standing::Rocking)
                .on(Touch::Impact)
                .to(Standing::Rocking)
                .must(tilt.at_most(0.0) & speed.less_than(0.0))
                .then([tilt.becomes(0.0), speed.becomes(-0.9 * &speed)]),
        )
        .build()
        .expect("the model is sound");
    let trajectory = block.run(10.0).expect("it can be run");
    let expected = [
        0.274_653_072_167_027_4,
        0.728_475_563_826_589_7,
        1.114_397_197_544_419_7,
        1.448_046_423_506_719_4,
        1.739_572_321_935_022_5,
        1.996_144_818_048_388,
        2.223_127_330_216_486,
        2.424_700_295_510_03,
    ];
    tells(&trajectory, &expected.map(|time| ("impact", time)), 1e-12);
    let Reason::Zeno(zeno) = &trajectory.ending().reason else { panic!("it comes to rest") };
    assert_near(zeno.accumulation, 4.172_954_385_259_485, 1e-5);
}

vocabulary! {
    enum Served: Location { One = "first", Two = "second", Three = "third" }
    enum Switch: Event { First = "to first", Second = "to second", Third = "to third" }
}
coordinates! {
    struct Tanks { one = "x", two = "y", three = "z" }
}

/// The switched arrival system of C. Chase, J. Serrano and P. J. Ramadge 1993 (doi:10.1109/9.186313): work
/// comes in at rates ½, ¼ and ¼, a server clears one buffer at rate 1 and then goes to the fullest. The
/// instants are by fractions.
#[test]
fn a_server_goes_to_the_fullest_buffer() {
    use Served::{One, Three, Two};
    use Switch::{First, Second, Third};
    let Tanks { one, two, three } = Tanks::coordinates();
    let rates = |served: usize| {
        let rate = |tank: usize, comes: f64| comes - f64::from(u8::from(tank == served));
        [one.rate(rate(0, 0.5)), two.rate(rate(1, 0.25)), three.rate(rate(2, 0.25))]
    };
    let mut system = Automaton::starting_in(One)
        .initially(Tanks { one: 0.375, two: 0.125, three: 0.5 })
        .flow(One, rates(0))
        .flow(Two, rates(1))
        .flow(Three, rates(2));
    let places = [(One, First, &one), (Two, Second, &two), (Three, Third, &three)];
    for (number, &(here, _, tank)) in places.iter().enumerate() {
        let [next, last] = [places[(number + 1) % 3], places[(number + 2) % 3]];
        let empty = || tank.at_most(0.0);
        system = system
            .transition(from(here).on(next.1).to(next.0).must(empty() & next.2.at_least(last.2)))
            .transition(from(here).on(last.1).to(last.0).must(empty() & last.2.more_than(next.2)));
    }
    let trajectory = system.build().expect("it is sound").run(17.0).expect("it can be run");
    let expected = [
        ("to third", 0.75),
        ("to second", 5.0 / 3.0),
        ("to first", 2.388_888_888_888_889),
        ("to third", 4.027_777_777_777_778),
        ("to second", 4.814_814_814_814_815),
        ("to first", 5.623_456_790_123_456_5),
        ("to third", 7.219_135_802_469_136),
        ("to second", 8.020_576_131_687_243),
        ("to first", 8.819_615_912_208_505),
        ("to third", 10.420_096_021_947_874),
        ("to second", 11.219_935_985_368_084),
        ("to first", 12.020_042_676_421_276),
        ("to third", 13.619_989_330_894_681),
        ("to second", 14.420_007_112_736_88),
        ("to first", 15.219_995_258_175_414),
        ("to third", 16.820_001_185_456_146),
    ];
    tells(&trajectory, &expected, 1e-13);
}

coordinates! {
    struct Billiard { x, y, u, v }
}

/// A billiard in a circle (G. D. Birkhoff 1927): all chords of an orbit have one length, here
/// 2 √(1 − b²) with b the distance of the line of motion from the centre.
#[test]
fn a_thousand_chords_of_a_circular_billiard_have_one_length() {
    let Billiard { x, y, u, v } = Billiard::coordinates();
    let outward = || &x * &u + &y * &v;
    let reflected = |speed: &Expression, place: &Expression| {
        speed - 2.0 * outward() * place / (&x * &x + &y * &y)
    };
    let [px, py, pu, pv] = [&x, &y, &u, &v].map(Expression::from);
    let billiard = Automaton::starting_in(Standing::Rocking)
        .initially(Billiard { x: 0.3, y: 0.0, u: FRAC_1_SQRT_2, v: FRAC_1_SQRT_2 })
        .flow(Standing::Rocking, [x.rate(&u), y.rate(&v), u.rate(0.0), v.rate(0.0)])
        .transition(
            from(Standing::Rocking)
                .on(Touch::Impact)
                .to(Standing::Rocking)
                .must((&x * &x + &y * &y).at_least(1.0) & outward().more_than(0.0))
                .then([u.becomes(reflected(&pu, &px)), v.becomes(reflected(&pv, &py))]),
        )
        .build()
        .expect("it is sound");
    let trajectory = billiard.run(1900.0).expect("it can be run");
    let along = 0.3 * FRAC_1_SQRT_2;
    let chord = 2.0 * f64::sqrt(1.0 - along * along);
    let first = -along + f64::sqrt(along * along + 0.91);
    let expected: Vec<_> =
        (0..970).map(|number| ("impact", f64::from(number).mul_add(chord, first))).collect();
    tells(&trajectory, &expected, 1e-9);
}

vocabulary! {
    enum Diode: Location { Conducting = "conducting", Blocking = "blocking" }
    enum Turn: Event { Off = "off", On = "on" }
}
coordinates! {
    struct Circuit { current = "i", time = "t" }
}

/// A diode that feeds an inductive load from u = sin t: i̇ = sin t − i until i is 0 again, which is where
/// sin β − cos β + e^−β = 0 (N. Mohan, T. M. Undeland and W. P. Robbins, *Power Electronics*, section 5.2);
/// β by mpmath. Guards depend on the time.
#[test]
fn a_diode_lets_the_current_fade() {
    let Circuit { current, time } = Circuit::coordinates();
    let circuit = Automaton::starting_in(Diode::Conducting)
        .initially(Circuit { current: 0.0, time: 0.0 })
        .flow(Diode::Conducting, [current.rate(time.sin() - &current), time.rate(1.0)])
        .flow(Diode::Blocking, time.rate(1.0))
        .transition(
            from(Diode::Conducting)
                .on(Turn::Off)
                .to(Diode::Blocking)
                .must(current.at_most(0.0) & time.sin().less_than(0.0))
                .then(current.becomes(0.0)),
        )
        .transition(
            from(Diode::Blocking).on(Turn::On).to(Diode::Conducting).must(time.sin().at_least(0.0)),
        )
        .build()
        .expect("it is sound");
    let trajectory = circuit.run(60.0).expect("it can be run");
    let expected = (0..9).flat_map(|turn| {
        let begin = f64::from(turn) * TAU;
        [("off", begin + 3.940_733_135_692_915), ("on", begin + TAU)]
    });
    tells(&trajectory, &expected.collect::<Vec<_>>(), 1e-7);
}

vocabulary! {
    enum Slide: Location { Left = "left", Right = "right", Stuck = "stuck" }
    enum Halt: Event { Turn = "turn", Stick = "stick", Slip = "slip" }
}
coordinates! {
    struct Mass { place = "x", speed = "v" }
}

/// C. A. de Coulomb's friction 0.1 on a mass on a spring: every half turn takes π and 0.2 of the
/// amplitude, until the spring is too weak.
#[test]
fn dry_friction_stops_a_spring_after_five_half_turns() {
    let Mass { place, speed } = Mass::coordinates();
    let rates = |push: f64| [place.rate(&speed), speed.rate(push - &place)];
    let weak = || place.abs().at_most(0.1);
    let mass = Automaton::starting_in(Slide::Left)
        .initially(Mass { place: 1.05, speed: 0.0 })
        .flow(Slide::Left, rates(0.1))
        .flow(Slide::Right, rates(-0.1))
        .transition(
            from(Slide::Left)
                .on(Halt::Turn)
                .to(Slide::Right)
                .must(speed.at_least(0.0) & place.less_than(-0.1)),
        )
        .transition(
            from(Slide::Right)
                .on(Halt::Turn)
                .to(Slide::Left)
                .must(speed.at_most(0.0) & place.more_than(0.1)),
        )
        .transition(
            from(Slide::Left).on(Halt::Stick).to(Slide::Stuck).must(speed.at_least(0.0) & weak()),
        )
        .transition(
            from(Slide::Right).on(Halt::Stick).to(Slide::Stuck).must(speed.at_most(0.0) & weak()),
        )
        .build()
        .expect("it is sound");
    let trajectory = mass.run(100.0).expect("it can be run");
    let turns = ["turn", "turn", "turn", "turn", "stick"];
    let expected: Vec<_> =
        turns.iter().zip(1..).map(|(&event, number)| (event, f64::from(number) * PI)).collect();
    tells(&trajectory, &expected, 1e-12);
    assert_eq!(trajectory.jumps().len(), 5);
    assert_near(trajectory.value("x", 50.0).expect("it lasts"), -0.05, 1e-13);
}

/// A block on a belt of speed ½ that a spring pulls back: it sticks up to x = 1, slips with friction 0.6,
/// and sticks again where the belt is as fast as it. With r = (1 − 0.6) ÷ ½ a slip takes
/// 2π − 2 arctan r, and the belt takes 2 r to carry it back.
#[test]
fn a_block_on_a_belt_sticks_and_slips() {
    let Mass { place, speed } = Mass::coordinates();
    let (belt, kinetic) = (0.5, 0.6);
    let block = Automaton::starting_in(Slide::Stuck)
        .initially(Mass { place: 0.0, speed: belt })
        .flow(Slide::Stuck, place.rate(belt))
        .flow(Slide::Right, [place.rate(&speed), speed.rate(kinetic - &place)])
        .transition(from(Slide::Stuck).on(Halt::Slip).to(Slide::Right).must(place.at_least(1.0)))
        .transition(
            from(Slide::Right)
                .on(Halt::Stick)
                .to(Slide::Stuck)
                .must(speed.at_least(belt) & place.less_than(kinetic))
                .then(speed.becomes(belt)),
        )
        .build()
        .expect("it is sound");
    let trajectory = block.run(60.0).expect("it can be run");
    let ratio: f64 = (1.0 - kinetic) / belt;
    let (slips, sticks) = (TAU - 2.0 * ratio.atan(), 2.0 * ratio);
    let (mut time, mut expected) = (2.0, Vec::new());
    for _ in 0..8 {
        expected.extend([("slip", time), ("stick", time + slips)]);
        time += slips + sticks;
    }
    tells(&trajectory, &expected, 1e-10);
}

vocabulary! {
    enum Gait: Location { Flight = "flight", Stance = "stance" }
    enum Foot: Event { Down = "down", Up = "up" }
}
coordinates! {
    struct Hopper { height = "y", speed = "v" }
}

/// A hopper on a spring without losses (R. Blickhan 1989, doi:10.1016/0021-9290(89)90224-8), along the
/// vertical: it lands with speed w after √(2 h ÷ g), and its spring, which swings at ω = √k, throws it off
/// after 2 (π − arctan (w ω ÷ g)) ÷ ω.
#[test]
fn a_hopper_hops_for_ever() {
    let Hopper { height, speed } = Hopper::coordinates();
    let (gravity, stiffness, apex) = (9.81, 400.0, 1.5);
    let pushes = stiffness * (1.0 - &height) - gravity;
    let hopper = Automaton::starting_in(Gait::Flight)
        .initially(Hopper { height: apex, speed: 0.0 })
        .flow(Gait::Flight, [height.rate(&speed), speed.rate(-gravity)])
        .flow(Gait::Stance, [height.rate(&speed), speed.rate(pushes)])
        .transition(
            from(Gait::Flight)
                .on(Foot::Down)
                .to(Gait::Stance)
                .must(height.at_most(1.0) & speed.less_than(0.0)),
        )
        .transition(
            from(Gait::Stance)
                .on(Foot::Up)
                .to(Gait::Flight)
                .must(height.at_least(1.0) & speed.more_than(0.0)),
        )
        .build()
        .expect("it is sound");
    let trajectory = hopper.run(200.0).expect("it can be run");
    assert_eq!(trajectory.ending().reason, Reason::Horizon);
    let fall = f64::sqrt(2.0 * (apex - 1.0) / gravity);
    let swing = f64::sqrt(stiffness);
    let stance = 2.0 * (PI - (fall * swing).atan()) / swing;
    let period = 2.0 * fall + stance;
    let expected: Vec<_> = (0..200)
        .flat_map(|hop| {
            let lands = f64::from(hop).mul_add(period, fall);
            [("down", lands), ("up", lands + stance)]
        })
        .collect();
    tells(&trajectory, &expected, 1e-9);
}

vocabulary! {
    enum Lit: Location { Dark = "dark" }
    enum Flash: Event { Both = "both", One = "one", Other = "other" }
}
coordinates! {
    struct Fireflies { one = "φ", other = "ψ" }
}

/// R. E. Mirollo and S. H. Strogatz's fireflies (1990, doi:10.1137/0150098) with b = 3 and ε = 0.1: a
/// flash brings the other on by φ ↦ e^{bε} φ + (e^{bε} − 1) ÷ (e^b − 1), and who reaches 1 by it flashes
/// along. Their phases follow that map, by mpmath, until they flash together, which they do ever after.
#[test]
fn fireflies_come_to_flash_together() {
    let Fireflies { one, other } = Fireflies::coordinates();
    let (slope, shift) = (0.3f64.exp(), 0.3f64.exp_m1() / 3f64.exp_m1());
    let brought_on = |phase: Expression| slope * phase + shift;
    let [phi, psi] = [&one, &other].map(Expression::from);
    let together = (one.at_least(1.0) & brought_on(psi.clone()).at_least(1.0))
        | (other.at_least(1.0) & brought_on(phi.clone()).at_least(1.0));
    let fireflies = Automaton::starting_in(Lit::Dark)
        .initially(Fireflies { one: 0.1, other: 0.55 })
        .flow(Lit::Dark, [one.rate(1.0), other.rate(1.0)])
        .transition(
            from(Lit::Dark)
                .on(Flash::Both)
                .to(Lit::Dark)
                .must(together)
                .priority(0)
                .then([one.becomes(0.0), other.becomes(0.0)]),
        )
        .transition(
            from(Lit::Dark)
                .on(Flash::One)
                .to(Lit::Dark)
                .must(one.at_least(1.0))
                .priority(1)
                .then([one.becomes(0.0), other.becomes(brought_on(psi))]),
        )
        .transition(
            from(Lit::Dark)
                .on(Flash::Other)
                .to(Lit::Dark)
                .must(other.at_least(1.0))
                .priority(1)
                .then([other.becomes(0.0), one.becomes(brought_on(phi))]),
        )
        .build()
        .expect("it is sound");
    let trajectory = fireflies.run(10.0).expect("it can be run");
    let mut expected = vec![
        ("other", 0.45),
        ("one", 0.689_246_559_936_653_3),
        ("other", 1.347_966_387_927_356_7),
        ("one", 1.440_456_530_492_611),
    ];
    expected.extend((0..8).map(|turn| ("both", 2.297_276_801_040_397 + f64::from(turn))));
    tells(&trajectory, &expected, 1e-13);
    assert_eq!(trajectory.jumps().len(), expected.len());
}

vocabulary! {
    enum Cell: Location { Charging = "charging" }
    enum Spike: Event { Fires = "fires" }
}
coordinates! {
    struct Neuron { voltage = "v", recovery = "u" }
}

/// E. M. Izhikevich's neuron that spikes regularly (2003, doi:10.1109/TNN.2003.820440), at I = 10: its
/// first spikes by Taylor series of 30 terms in mpmath.
#[test]
fn a_neuron_spikes_regularly() {
    let Neuron { voltage, recovery } = Neuron::coordinates();
    let charge = 0.04 * &voltage * &voltage + 5.0 * &voltage + 140.0 - &recovery + 10.0;
    let neuron = Automaton::starting_in(Cell::Charging)
        .initially(Neuron { voltage: -65.0, recovery: -13.0 })
        .flow(
            Cell::Charging,
            [voltage.rate(charge), recovery.rate(0.02 * (0.2 * &voltage - &recovery))],
        )
        .transition(
            from(Cell::Charging)
                .on(Spike::Fires)
                .to(Cell::Charging)
                .must(voltage.at_least(30.0))
                .then([voltage.becomes(-65.0), recovery.becomes(&recovery + 8.0)]),
        )
        .build()
        .expect("it is sound");
    // In a composition with another of its kind, which it does not disturb.
    let pair = Composition::builder().add("one", &neuron).add("other", &neuron);
    let settings = Settings { accumulation: Accumulation::Off, ..Settings::default() };
    let pair = pair.build().expect("they fit").run_with(settings, 210.0).expect("it can be run");
    let expected = [
        3.127_055_303_876_976,
        26.226_024_634_148_404,
        71.057_097_328_209_6,
        115.869_510_996_278_26,
        160.681_924_664_373_8,
        205.494_338_332_469_38,
    ];
    assert!(pair.doubts().is_empty());
    for component in 0..2 {
        let spikes = pair.jumps().iter().filter(|jump| jump.moves[0].component == component);
        let spikes: Vec<f64> = spikes.map(|jump| jump.at.t).collect();
        assert_eq!(spikes.len(), expected.len());
        spikes.iter().zip(expected).for_each(|(&found, exact)| assert_near(found, exact, 1e-6));
    }
}
