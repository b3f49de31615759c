#![allow(warnings)]
use pleach_automaton::*;
use pleach_discrete::vocabulary;
use pleach_guards::*;
use pleach_verify::temporal::{
    self as tl, Formula, Status, always as alw, eventually as ev, within,
};
use std::f64::consts::*;
use std::time::Instant;

vocabulary! {
    enum P: Location { A = "a", B = "b" }
    enum C: Event { Go = "go", Back = "back" }
}
coordinates! { struct S { x, y, t } }

fn c() -> [Coordinate<S>; 3] {
    let S { x, y, t } = S::coordinates();
    [x, y, t]
}
fn b(s: [f64; 2], r: [Expression; 2]) -> Builder<P, C, S> {
    let [x, y, t] = c();
    let [p, q] = r;
    Automaton::starting_in(P::A)
        .initially(S { x: s[0], y: s[1], t: 0.0 })
        .flow(P::A, [x.rate(p), y.rate(q), t.rate(1.0)])
}
fn e(
    name: &str,
    s: [f64; 2],
    r: [Expression; 2],
    g: Predicate,
    h: f64,
    want: Option<f64>,
    tol: f64,
) {
    let begin = Instant::now();
    let m = b(s, r).transition(from(P::A).on(C::Go).to(P::B).must(g)).build().unwrap();
    let tr = m.run(h).unwrap();
    let got = tr.jumps().first().map(|j| j.at.t);
    let ok = match (got, want) {
        (Some(g), Some(w)) => (g - w).abs() <= tol * w.abs().max(1e-300),
        (None, None) => true,
        _ => false,
    };
    println!(
        "{} {name}: {got:?} want {want:?} err {:e} doubts {} {:?} {:?}",
        if ok { "ok " } else { "BAD" },
        got.zip(want).map_or(0.0, |(g, w)| (g - w) / w),
        tr.doubts().len(),
        tr.doubts().first().map(|d| d.to_string()),
        begin.elapsed()
    );
    if !ok {
        println!("      ending {:?}", tr.ending());
    }
}
fn run(s: [f64; 2], r: [Expression; 2], h: f64) -> Trajectory {
    b(s, r).build().unwrap().run(h).unwrap()
}
fn v(name: &str, tr: &Trajectory, at: f64, want: f64, tol: f64) {
    let got = tr.value("x", at).unwrap_or(f64::NAN);
    println!(
        "{} {name}: x({at}) = {got} want {want} err {:e} doubts {} end {:?}",
        if (got - want).abs() <= tol * want.abs() { "ok " } else { "BAD" },
        (got - want) / want,
        tr.doubts().len(),
        tr.ending().reason
    );
}
fn j(name: &str, tr: &Trajectory, f: impl Into<Formula>, want: Status, rob: Option<f64>) {
    let f = f.into();
    let begin = Instant::now();
    match f.judge(tr) {
        Ok(g) => {
            let r_ok = rob.is_none_or(|r| {
                g.robustness.lower <= r + 1e-8 * r.abs().max(1e-3)
                    && r - 1e-8 * r.abs().max(1e-3) <= g.robustness.upper
            });
            println!(
                "{} {name}: {} rob [{:e}, {:e}] want {want:?} {rob:?} doubts {} {:?} {:?}",
                if g.status == want && r_ok { "ok " } else { "BAD" },
                g.status,
                g.robustness.lower,
                g.robustness.upper,
                g.doubts.len(),
                g.doubts.first().map(|d| d.to_string()),
                begin.elapsed()
            );
        }
        Err(x) => println!("BAD {name}: {x}"),
    }
}
fn n(v: f64) -> Expression {
    constant(v)
}
fn w(a: f64, b: f64) -> tl::Window {
    within(a, b).unwrap()
}

fn main() {
    let [x, y, t] = c();
    let z = || 0.0 * x.power(3.0);
    // events
    e(
        "decay 1e-20 h2000",
        [1., 0.],
        [-&x, n(0.)],
        x.at_most(1e-20),
        2000.,
        Some(46.051701859880914),
        1e-12,
    );
    e(
        "decay 1e-18",
        [1., 0.],
        [-&x, n(0.)],
        x.at_most(1e-18),
        2000.,
        Some(41.44653167389282),
        1e-12,
    );
    e(
        "decay 1e6",
        [1e6, 0.],
        [-0.1 * &x, n(0.)],
        x.at_most(1e-12),
        1e4,
        Some(414.46531673892823),
        1e-12,
    );
    e("decay with offset -> 1", [0., 0.], [1.0 - &x, n(0.)], x.at_least(1.0), 100., None, 0.);
    e(
        "decay with offset -> 1-1e-15",
        [0., 0.],
        [1.0 - &x, n(0.)],
        x.at_least(1.0 - 1e-15),
        100.,
        Some(34.538776394910684),
        1e-1,
    );
    e(
        "fast slave of slow",
        [1., 1.],
        [-1000.0 * (&x - &y), -&y],
        x.at_most(1e-20),
        1e3,
        Some(46.051701859880914 + 0.0010005003335835344),
        1e-10,
    );
    e(
        "double decay difference",
        [1., 1.],
        [-&x, -2.0 * &y],
        (&x - 1e3 * &y).at_least(0.0),
        100.,
        Some(1e3f64.ln()),
        1e-11,
    );
    e(
        "resonance t e^-t",
        [0., 1.],
        [-&x + &y, -&y],
        (x.at_most(1e-30) & t.at_least(1.0)),
        1e3,
        Some(73.4),
        2e-2,
    );
    e(
        "growth",
        [1e-300, 0.],
        [&x.clone() * 1.0, n(0.)],
        x.at_least(1e300),
        2000.,
        Some(600.0 * 10f64.ln()),
        1e-12,
    );
    e("underdamped", [1., 0.], [y.clone() * 1.0, -&x - 0.2 * &y], x.at_most(-0.9), 1e4, None, 0.);
    e(
        "kink abs zero",
        [0., 0.],
        [n(1.), n(0.)],
        (&x - 0.7).abs().at_most(0.0),
        2.,
        Some(0.7),
        1e-15,
    );
    e(
        "spike table guard",
        [0., 0.],
        [n(1.), n(0.)],
        Table::linear([(0., 0.), (0.7, 0.), (0.7 + 5e-10, 1.), (0.7 + 1e-9, 0.), (9., 0.)])
            .unwrap()
            .at(&x)
            .at_least(0.5),
        2.,
        Some(0.7 + 2.5e-10),
        1e-14,
    );
    e(
        "pole guard crossing",
        [0., 0.],
        [n(1.), n(0.)],
        (1.0 / (&x - 1.0)).at_least(5.0),
        3.,
        Some(1.0),
        1e-6,
    );
    e(
        "plain crossing of product",
        [-1., 0.],
        [n(1.), n(0.)],
        (&x * &x * &x).at_least(0.0),
        3.,
        Some(1.0),
        1e-15,
    );
    e(
        "circle energy",
        [1., 0.],
        [-&y, x.clone() * 1.0],
        (x.power(2.) + y.power(2.)).more_than(1.0 + 1e-9),
        10.,
        None,
        0.,
    );
    e(
        "circle energy 1e-13",
        [1., 0.],
        [-&y, x.clone() * 1.0],
        (x.power(2.) + y.power(2.)).more_than(1.0 + 1e-13),
        10.,
        None,
        0.,
    );
    e(
        "pendulum energy",
        [1., 0.],
        [y.clone() * 1.0, -x.sin()],
        (0.5 * y.power(2.) - x.cos()).at_least(-(1f64.cos()) + 1e-6),
        10.,
        None,
        0.,
    );
    e(
        "spike rate",
        [0., 0.],
        [(-((&t - 50.) / 0.001).power(2.)).exp(), n(0.)],
        x.at_least(1e-3),
        100.,
        Some(50.0 + 0.001 * 0.09),
        1e-5,
    );
    e(
        "spike rate state",
        [0., 0.],
        [(-((&t - 50.) / 1e-5).power(2.)).exp() * 1e5, n(0.)],
        x.at_least(1.0),
        1e3,
        Some(50.0),
        1e-6,
    );
    e(
        "cos^1000 rate",
        [0., 0.],
        [(0.01 * &t).cos().power(2000.), n(0.)],
        x.at_least(8.0),
        500.,
        None,
        0.,
    );
    e(
        "vdp stiff",
        [2., 0.],
        [y.clone() * 1.0, 1000.0 * ((1.0 - x.power(2.)) * &y) - &x],
        x.at_most(-1.0),
        2000.,
        Some(807.0),
        1e-2,
    );
    e(
        "bell tanh",
        [0., 0.],
        [(1e4 * (&t - 3.0)).tanh(), n(0.)],
        x.at_least(0.0) & t.at_least(1.0),
        100.,
        Some(6.0),
        1e-6,
    );
    e(
        "sqrt drain",
        [1., 0.],
        [-x.max(0.0).square_root(), n(0.)],
        x.at_most(1e-12),
        10.,
        Some(2.0 - 2e-6),
        1e-9,
    );
    e("blow up", [1., 0.], [x.power(2.), n(0.)], x.at_least(1e9), 2., Some(1.0 - 1e-9), 1e-8);
    e(
        "Lorentz guard",
        [0., 0.],
        [n(1.), n(0.)],
        (1.0 / (1.0 + (1e6 * (&x - 33.0)).power(2.))).at_least(0.5),
        100.,
        Some(33.0 - 1e-6),
        1e-14,
    );
    e(
        "beats",
        [0., 0.],
        [n(1.), n(0.)],
        (&x.sin() + (1.001 * &x).sin()).at_least(1.99999),
        1e5,
        None,
        0.,
    );
    e(
        "atan2 winding",
        [1., 0.],
        [-&y, x.clone() * 1.0],
        y.atan2(&x).at_most(-3.0),
        10.,
        Some(PI + (PI - 3.0) * 0.0),
        1e-9,
    );
    e(
        "floor sum",
        [0., 0.],
        [n(1.), n(0.)],
        ((3.0 * &x).floor() + (7.0 * &x).floor()).at_least(29.0),
        10.,
        Some(3.0),
        1e-14,
    );
    e(
        "long horizon square",
        [0., 0.],
        [n(1.), n(0.)],
        (x.power(2.) - 2.0 * 1e5 * &x + 1e10).at_most(1e-6),
        1e6,
        Some(1e5 - 1e-3),
        1e-11,
    );
    e(
        "quadratic flow tangency",
        [0., 1.],
        [y.clone() * 1.0, n(-1.)],
        x.at_least(0.5),
        3.,
        Some(1.0),
        1e-7,
    );
    e(
        "just above tangency",
        [0., 1.],
        [y.clone() * 1.0, n(-1.)],
        x.at_least(0.5 + 1e-12),
        3.,
        None,
        0.,
    );
    e(
        "just below tangency",
        [0., 1.],
        [y.clone() * 1.0, n(-1.)],
        x.at_least(0.5 - 1e-12),
        3.,
        Some(1.0 - 2e-12f64.sqrt()),
        1e-9,
    );
    e("at start boundary", [1., 0.], [-&y, x.clone() * 1.0], x.more_than(1.0), 6.0, None, 0.);
    e(
        "at start boundary nonlinear",
        [1., 0.],
        [-&y, x.clone() * 1.0 + z()],
        x.more_than(1.0),
        6.0,
        None,
        0.,
    );
    e(
        "robertson-like",
        [1., 0.],
        [
            -0.04 * &x + 1e4 * &y * (1.0 - &x - &y),
            0.04 * &x - 1e4 * &y * (1.0 - &x - &y) - 3e7 * y.power(2.),
        ],
        x.at_most(0.5),
        1e4,
        None,
        0.,
    );

    // values
    v(
        "gauss",
        &run([0., 0.], [(-((&t - 50.) / 0.001).power(2.)).exp(), n(0.)], 100.),
        100.,
        0.001 * PI.sqrt(),
        1e-6,
    );
    v(
        "gauss+1",
        &run([0., 0.], [1.0 + (-((&t - 50.) / 0.001).power(2.)).exp(), n(0.)], 100.),
        100.,
        100. + 0.001 * PI.sqrt(),
        1e-9,
    );
    v(
        "gauss 1e-6 amplitude 1",
        &run([0., 0.], [(-((&t - 50.) / 1e-6).power(2.)).exp(), n(0.)], 100.),
        100.,
        1e-6 * PI.sqrt(),
        1e-2,
    );
    v(
        "sech2",
        &run(
            [0., 0.],
            [1.0 / ((1e4 * (&t - 20.)).exp() + (-1e4 * (&t - 20.)).exp()).power(2.) * 1e4, n(0.)],
            40.,
        ),
        40.,
        0.5,
        1e-6,
    );
    v(
        "pulse by tanh difference",
        &run(
            [0., 0.],
            [0.5e4 * ((1e6 * (&t - 20.)).tanh() - (1e6 * (&t - 20.0001)).tanh()), n(0.)],
            40.,
        ),
        40.,
        1.0,
        1e-6,
    );
    v(
        "sin fast burst",
        &run([0., 0.], [(1e3 * &t).sin(), n(0.)], 10.),
        10.,
        (1.0 - (1e4f64).cos()) / 1e3,
        1e-5,
    );
    v("decay value", &run([1., 0.], [-&x, n(0.)], 700.), 100., (-100f64).exp(), 1e-12);
    v("decay value late", &run([1., 0.], [-&x, n(0.)], 1e5), 600., (-600f64).exp(), 1e-11);
    v("nonlinear decay", &run([1., 0.], [-&x + z(), n(0.)], 100.), 100., (-100f64).exp(), 1e30);

    // temporal
    let clock = run([0., 0.], [n(1.), n(0.)], 10.);
    let circle = run([1., 0.], [-&y, x.clone() * 1.0], 100.);
    let decay = run([1., 0.], [-&x, n(0.)], 200.);
    j("decay always > 0", &decay, alw(w(0., 200.), x.more_than(0.0)), Status::Satisfied, None);
    j(
        "decay eventually <=1e-40",
        &decay,
        ev(w(0., 200.), x.at_most(1e-40)),
        Status::Satisfied,
        None,
    );
    j("decay ever < 0", &decay, ev(w(0., 200.), x.less_than(0.0)), Status::Violated, None);
    j(
        "until",
        &clock,
        Formula::holds(x.less_than(3.0)).until(w(0., 5.), x.at_least(3.0)),
        Status::Satisfied,
        Some(0.0),
    );
    j(
        "until gap",
        &clock,
        Formula::holds(x.less_than(3.0)).until(w(0., 5.), x.at_least(3.0 + 1e-9)),
        Status::Violated,
        None,
    );
    j(
        "complement",
        &circle,
        alw(w(0., 90.), Formula::holds(x.less_than(0.3)).or(x.at_least(0.3))),
        Status::Satisfied,
        None,
    );
    j(
        "nested response",
        &circle,
        alw(
            w(0., 90.),
            Formula::holds(x.at_least(0.9)).implies(ev(w(0., PI + 0.46), x.at_most(-0.9))),
        ),
        Status::Satisfied,
        None,
    );
    j(
        "nested response tight",
        &circle,
        alw(w(0., 90.), Formula::holds(x.at_least(0.9)).implies(ev(w(0., 2.9), x.at_most(-0.9)))),
        Status::Violated,
        None,
    );
    j("peak", &circle, ev(w(1., 90.), x.at_least(1.0 - 1e-13)), Status::Satisfied, Some(1e-13));
    j("peak not", &circle, ev(w(1., 90.), x.at_least(1.0 + 1e-12)), Status::Violated, Some(-1e-12));
    j(
        "window between peaks",
        &circle,
        ev(w(TAU - 1e-6, TAU + 1e-6), x.at_least(1.0 - 1e-12)),
        Status::Satisfied,
        Some(1e-12),
    );
    j(
        "window cut",
        &circle,
        alw(w(0.5, 1.0), x.at_least(0.5)),
        Status::Satisfied,
        Some(1f64.cos() - 0.5),
    );
    j(
        "min of two waves",
        &circle,
        alw(w(0., 90.), x.max(&*y).at_least(-SQRT_2 / 2.0 - 1e-9)),
        Status::Satisfied,
        Some(1e-9),
    );
    j(
        "min of two waves exact",
        &circle,
        alw(w(0., 90.), x.max(&*y).at_least(-SQRT_2 / 2.0 + 1e-9)),
        Status::Violated,
        Some(-1e-9),
    );
    j(
        "or of comparisons",
        &circle,
        alw(w(0., 90.), x.at_least(-SQRT_2 / 2.0 - 1e-9) | y.at_least(-SQRT_2 / 2.0 - 1e-9)),
        Status::Satisfied,
        Some(1e-9),
    );
    j(
        "or of comparisons no",
        &circle,
        alw(w(0., 90.), x.at_least(-SQRT_2 / 2.0 + 1e-9) | y.at_least(-SQRT_2 / 2.0 + 1e-9)),
        Status::Violated,
        Some(-1e-9),
    );
    j("pole", &clock, alw(w(0., 10.), (1.0 / (&x - 5.0)).at_most(1e6)), Status::Violated, None);
    j(
        "pole ever",
        &clock,
        ev(w(0., 4.), (1.0 / (&x - 5.0)).at_most(-1.0)),
        Status::Satisfied,
        Some(0.0),
    );
    j("floor", &clock, alw(w(0., 10.), (&x - x.floor()).less_than(1.0)), Status::Satisfied, None);
    j(
        "floor exact",
        &clock,
        ev(w(0.5, 10.), (&x - x.floor()).at_most(0.0)),
        Status::Satisfied,
        Some(0.0),
    );
    j("sign", &circle, ev(w(0., 10.), x.sign().at_least(1.0)), Status::Satisfied, Some(0.0));
    j(
        "exp",
        &clock,
        alw(w(0., 10.), (-x.power(2.)).exp().at_least(0.0)),
        Status::Satisfied,
        Some(0.0),
    );
    j(
        "thin gaussian",
        &clock,
        ev(w(0., 10.), (-(1e7 * (&x - PI)).power(2.)).exp().at_least(0.999)),
        Status::Satisfied,
        Some(0.001),
    );
    j(
        "thin gaussian never",
        &clock,
        alw(w(0., 10.), (-(1e7 * (&x - PI)).power(2.)).exp().at_most(0.5)),
        Status::Violated,
        Some(-0.5),
    );
    j(
        "square",
        &clock,
        alw(w(0., 10.), (&x - PI).power(2.).at_least(0.0)),
        Status::Satisfied,
        None,
    );
    j(
        "square strict",
        &clock,
        alw(w(0., 10.), (&x - 5.0).power(2.).more_than(0.0)),
        Status::Violated,
        None,
    );
    j(
        "unbounded always",
        &clock,
        alw(tl::Window::UNBOUNDED, x.at_least(-1.0)),
        Status::Inconclusive,
        None,
    );
    j("too short", &clock, ev(w(0., 20.), x.at_least(15.0)), Status::Inconclusive, None);
    j(
        "norm",
        &circle,
        alw(w(0., 90.), norm([x.clone() * 1.0, y.clone() * 1.0]).at_most(1.0 + 1e-9)),
        Status::Satisfied,
        Some(1e-9),
    );
    j(
        "angle",
        &circle,
        alw(w(0., 90.), (x.power(2.) + y.power(2.)).square_root().at_least(1.0 - 1e-9)),
        Status::Satisfied,
        Some(1e-9),
    );
    let vdp = run([2., 0.], [y.clone() * 1.0, (1.0 - x.power(2.)) * &y - &x], 100.);
    j("vdp amplitude", &vdp, alw(w(0., 100.), x.abs().at_most(2.0087)), Status::Satisfied, None);
    j(
        "vdp amplitude reached",
        &vdp,
        ev(w(0., 100.), x.at_least(2.0086)),
        Status::Satisfied,
        Some(2.00861986087484313650940188 - 2.0086),
    );
    let big = run([0., 0.], [n(1.), n(0.)], 1e6);
    j(
        "ms pulse in 1e6",
        &big,
        ev(
            w(0., 1e6),
            piecewise(
                [(x.at_least(123456.789) & x.at_most(123456.79), n(1.0))]
                    .map(|(p, e)| match p {
                        Predicate::All(_) => (x.at_least(123456.789), e),
                        other => (other, e),
                    })
                    .into_iter()
                    .filter_map(|(p, e)| match p {
                        Predicate::Comparison(c) => Some((c, e)),
                        _ => None,
                    }),
                n(0.0),
            )
            .at_least(0.5),
        ),
        Status::Satisfied,
        Some(0.5),
    );
    // bouncing ball
    let ball = Automaton::<P, C, S>::starting_in(P::A)
        .initially(S { x: 1.0, y: 0.0, t: 0.0 })
        .flow(P::A, [x.rate(&y), y.rate(-9.81), t.rate(1.0)])
        .transition(
            from(P::A)
                .on(C::Go)
                .to(P::A)
                .must(x.at_most(0.0) & y.less_than(0.0))
                .then(y.becomes(-0.8 * &y)),
        )
        .build()
        .unwrap()
        .run(3.0)
        .unwrap();
    j("ball height", &ball, alw(w(0., 3.), x.at_least(-1e-9)), Status::Satisfied, None);
    j(
        "ball rises to 0.64",
        &ball,
        ev(w(0.5, 3.), x.at_least(0.64 - 1e-12)),
        Status::Satisfied,
        Some(1e-12),
    );
    j(
        "ball rises above 0.64",
        &ball,
        ev(w(0.5, 3.), x.at_least(0.64 + 1e-12)),
        Status::Violated,
        Some(-1e-12),
    );
    j("ball at impact", &ball, ev(w(0.4, 0.5), y.at_most(-4.429)), Status::Satisfied, None);
    println!("{:?}", b([f64::NAN, 0.], [n(1.), n(0.)]).build().map(|_| ()));
    println!(
        "{:?}",
        b([0., 0.], [n(1.), n(0.)])
            .invariant(P::A, x.at_least(1.0))
            .build()
            .unwrap()
            .run(1.0)
            .unwrap()
            .ending()
    );
    println!(
        "{:?}",
        b([0., 0.], [n(1.), n(0.)])
            .build()
            .unwrap()
            .run_from(S { x: f64::NAN, y: 0.0, t: 0.0 }, 1.0)
            .map(|_| ())
    );
}
