"""Models made from data, held against what can be worked out by hand."""

import math
import time

import numpy
import pytest

import pleach


def ball(bounce=0.8):
    return (
        pleach.Automaton("falling", {"h": 10.0, "v": 0.0}, parameters={"g": 9.81})
        .flow("falling", {"h": "v", "v": "-g"})
        .invariant("falling", "h >= 0")
        .transition("falling", "bounce", "falling", must="h <= 0 and v < 0", then={"v": f"-{bounce} * v"})
    )


def test_a_ball_falls_by_the_square_of_time():
    run = ball().run(3.0)
    first = run.jumps[0]
    assert first["t"] == pytest.approx(math.sqrt(20 / 9.81), abs=1e-12)
    assert first["label"] == "bounce" and first["moves"] == [("automaton", "falling", "falling")]
    times = numpy.linspace(0, 1.4, 50)
    assert numpy.allclose(run.at(times)[:, 0], 10 - 9.81 / 2 * times**2, atol=1e-12)
    assert run.at(numpy.array([5.0])).shape == (1, 2) and numpy.isnan(run.at(numpy.array([5.0]))).all()


def test_arrays_have_one_row_for_each_sample():
    run = ball().run(3.0)
    samples = len(run)
    assert run.variables == ["h", "v"] and run.components == {"automaton": ["falling"]}
    assert run.times.shape == run.jumped.shape == run["h"].shape == (samples,)
    assert run.values.shape == (samples, 2) and run.locations.shape == (samples, 1)
    assert run.times.dtype == run.values.dtype == numpy.float64
    assert numpy.all(numpy.diff(run.times) >= 0)
    before, after = numpy.flatnonzero(run.times == run.jumps[0]["t"])
    assert run["v"][after] == pytest.approx(-0.8 * run["v"][before])
    assert run.jumped[[before, after]].tolist() == [0, 1]


def test_infinitely_many_jumps_are_told():
    run = ball().run(20.0)
    fall = math.sqrt(20 / 9.81)
    assert run.end == pytest.approx(fall * (1 + 0.8) / (1 - 0.8), rel=1e-6)
    assert "Zeno" in run.outcome and "Zeno" in repr(run)


def test_settings_say_when_a_transition_is_taken():
    lamp = (
        pleach.Automaton("lit", {"x": 0.0})
        .flow("lit", {"x": 1})
        .invariant("lit", "x <= 3")
        .transition("lit", "out", "dark", may="x >= 1")
    )
    assert lamp.run(9.0, policy="Early").jumps[0]["t"] == pytest.approx(1.0)
    assert lamp.run(9.0, policy="Late").jumps[0]["t"] == pytest.approx(3.0)
    drawn = [lamp.run(9.0, policy={"Random": {"seed": s}}).jumps[0]["t"] for s in (1, 1, 2)]
    assert drawn[0] == drawn[1] != drawn[2] and all(1 <= t <= 3 for t in drawn)
    assert lamp.run(9.0).locations[-1, 0] == lamp.run(9.0).components["automaton"].index("dark")


def test_a_controller_beside_its_plant():
    cart = (
        pleach.Automaton("rolling", {"p": 1.0, "v": 0.0, "f": 0.0})
        .flow("rolling", {"p": "v", "v": "f"})
    )
    controller = (
        pleach.Automaton("waiting", {"p": 1.0, "v": 0.0, "u": 0.0, "clock": 0.0})
        .flow("waiting", {"clock": 1})
        .transition("waiting", "sample", "waiting", must="clock >= 0.1",
                    then={"u": "-2 * p - 3 * v", "clock": 0})
    )
    both = pleach.Composition(
        {"cart": cart, "controller": controller},
        connect={"controller.p": "cart.p", "controller.v": "cart.v", "cart.f": "controller.u"},
    )
    run = both.run(10.0)
    assert abs(run["cart.p"][-1]) < 1e-3 and set(run.components) == {"cart", "controller"}
    assert len(run.jumps) in (99, 100)


def test_what_a_model_shows():
    model = ball()
    run = model.run(3.0)
    assert model.diagram().startswith("stateDiagram-v2") and "<svg" in model.diagram("svg")
    page = run.page("A ball")
    assert page.startswith("<!DOCTYPE html>") and "A ball" in page and '"drawing":0' in page
    assert "<svg" in run.plot() and '"variables"' in run.to_json()


def test_formulas_are_text_or_numbers():
    def stopping(value):
        return pleach.Automaton("on", {"x": 0.0}).transition(
            "on", "stop", "off", must="x >= 1", then={"x": value}
        )

    for number, text in (
        (0.5, "0.5"), (-2, "-2"), (numpy.float64(1e-7), "1e-7"),
        (math.inf, "infinity"), (-math.inf, "-infinity"), (math.nan, "NaN"),
    ):
        assert stopping(number).diagram() == stopping(text).diagram()
    with pytest.raises(pleach.ModelError, match="x: None is neither a formula nor a number"):
        stopping(None)


def test_settings_may_be_infinite_where_they_are_by_default():
    free, unbounded, bounded = (
        ball().run(1.0, largest_step=step) for step in (None, math.inf, numpy.float64(0.01))
    )
    assert free.times.tolist() == unbounded.times.tolist() == ball().run(1.0).times.tolist()
    assert ball().run(20.0, jump_limit=numpy.int64(3)).jumps[-1]["t"] < 10

    def said(**settings):
        with pytest.raises(pleach.ModelError) as raised:
            ball().run(1.0, **settings)
        return str(raised.value)

    wanted = "is not a finite number: write one, such as 0.5"
    assert said(resolution=math.inf) == f"the setting resolution: inf {wanted}"
    assert said(largest_step=math.nan) == f"the setting largest_step: NaN {wanted}, or infinity"
    assert said(largest_step=-math.inf) == f"the setting largest_step: -inf {wanted}, or infinity"
    assert said(policy={"Random": {"seed": math.inf}}) == f"the setting policy: inf {wanted}"
    assert "the setting policy: unknown variant `Never`, expected one of" in said(policy="Never")


def test_parts_are_added_as_fast_to_a_large_model_as_to_a_small_one():
    def seconds_to_grow(model, transitions=200):
        began = time.perf_counter()
        for _ in range(transitions):
            model.transition("on", "go", "on", may="x >= 1", then={"x": "x + 1"})
        return time.perf_counter() - began

    small = min(seconds_to_grow(pleach.Automaton("on", {"x": 0.0})) for _ in range(5))
    large = pleach.Automaton("on", {"x": 0.0})
    seconds_to_grow(large, 4000)
    assert min(seconds_to_grow(large) for _ in range(5)) < 5 * small


def test_a_part_that_is_refused_leaves_the_model_as_it_was():
    model = ball()
    before = model.diagram()
    for refused in (
        lambda: model.flow("falling", {"w": 1}),
        lambda: model.invariant("falling", "h <> 0"),
        lambda: model.transition("falling", "stop", "resting"),
        lambda: model.transition("falling", "stop", "resting", may="h <= 0", then={"v": "1 +"}),
    ):
        with pytest.raises(pleach.ModelError):
            refused()
    assert model.diagram() == before


def test_mistakes_are_told():
    with pytest.raises(pleach.ModelError, match="no coordinate called 'w'|no coordinate called \"w\""):
        ball().flow("rising", {"w": 1})
    with pytest.raises(pleach.ModelError, match="h <>"):
        ball().invariant("falling", "h <> 0")
    with pytest.raises(pleach.ModelError, match="exactly one guard"):
        ball().transition("falling", "stop", "resting")
    with pytest.raises(pleach.ModelError, match="variable `w`"):
        ball().invariant("resting", "w >= 0").run(1.0)
    with pytest.raises(pleach.ModelError):
        ball().run(-1.0)
    with pytest.raises(KeyError, match="no variable is called"):
        ball().run(1.0)["w"]
    with pytest.raises(KeyError, match="no setting is called"):
        ball().run(1.0, tolerance=1)
    stuck = pleach.Automaton("on", {"x": 0.0}).flow("on", {"x": 1}).invariant("on", "x <= 1")
    assert any("x" in finding for finding in stuck.check())
