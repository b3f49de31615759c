"""The wheel, as a user of it would see it."""

import math
import pathlib

import numpy
import pytest

import pleach

SCENARIOS = pathlib.Path(__file__).parents[2] / "scenarios"


@pytest.fixture(scope="module")
def mission():
    return pleach.run(SCENARIOS / "too-few.toml")


def test_arrays_have_one_row_for_each_period(mission):
    periods, robots = mission.times.size, len(mission.scenario["robot"])
    assert mission.positions.shape == (periods, robots, 2)
    for array in (mission.residuals, mission.multipliers, mission.roles, mission.locations):
        assert array.shape == (periods, robots)
    assert mission.positions.dtype == numpy.float64
    assert numpy.all(mission.residuals >= -1e-6)
    assert numpy.all(numpy.diff(mission.times) > 0)
    assert mission.roles.max() < len(pleach.ROLES)
    assert mission.targets.shape == mission.messages.shape == (periods, robots, 2)
    goes = ~numpy.isnan(mission.targets).any(axis=2)
    assert goes.any() and not goes.all()
    leading = mission.locations == pleach.LOCATIONS.index("leading the team")
    assert leading.any() and numpy.all(mission.roles[leading] == pleach.ROLES.index("leader"))
    assert mission.messages.min() > 0, "robots repeat their beacons in every period"
    assert mission.tree.shape[1] == 3 and mission.routes.shape[1] == 5


def test_the_story_is_that_of_the_scenario(mission):
    assert mission.outcome == "insufficient_robots" and mission.reason
    assert mission.events[0] == {"event": "task_announced", "task": 0, "k": 1}
    assert "too-few" in repr(mission)
    assert mission.scenario["control"]["max_steps"] == 20000


def test_tasks_that_are_given_up_are_named_with_reasons(mission):
    assert mission.given_up == [1, 2]
    reasons = {e["task"]: e["reason"] for e in mission.events if e["event"] == "task_given_up"}
    assert list(reasons) == mission.given_up and all("recruit" in it for it in reasons.values())
    ended = pleach.run(SCENARIOS / "too-few.toml", {"mission.unreachable": "end"})
    assert ended.task == 1 and all(event.get("task") != 2 for event in ended.events)


def test_robots_move_at_most_a_step(mission):
    steps = numpy.linalg.norm(numpy.diff(mission.positions, axis=0), axis=2)
    assert 0 < steps.max() <= mission.scenario["control"]["step_radius"] + 1e-9


def test_settings_and_seeds(mission):
    short = pleach.run(SCENARIOS / "too-few.toml", {"control.max_steps": 10, "robot[*].rate": 0.05})
    assert short.outcome == "step_limit" and short.times.size == 10
    assert short.scenario["robot"][0]["rate"] == 0.05
    one, two, again = (
        pleach.run(SCENARIOS / "too-few.toml", {"control.max_steps": 2}, seed=seed)
        for seed in (1, 2, 1)
    )
    assert not numpy.array_equal(one.positions, two.positions)
    assert numpy.array_equal(one.positions, again.positions)


def described(settings):
    """The scenario with these settings, as its mission has it."""
    return pleach.run(SCENARIOS / "too-few.toml", {"control.max_steps": 1, **settings}).scenario


@pytest.mark.parametrize("corners", [
    [(-1, -1), (3, -1), (3, 3), (-1, 3)],
    ((-1, -1), [3, -1], (3, 3), [-1, 3]),
    [[numpy.float64(-1), numpy.int64(-1)], [numpy.float32(3), -1], [3, 3], [-1, 3]],
    numpy.array([[-1, -1], [3, -1], [3, 3], [-1, 3]], dtype=float),
], ids=["tuples in a list", "lists in a tuple", "numbers of numpy", "an array of numpy"])
def test_settings_are_lists_however_python_holds_them(corners):
    workspace = described({"workspace.boundary": corners})["workspace"]
    assert workspace["boundary"] == [[-1, -1], [3, -1], [3, 3], [-1, 3]]


def test_settings_are_of_every_kind():
    one = {"position": (0.1, 0.1), "rate": numpy.float64(0.04)}
    robot, = described({"robot": [one], "task": [{"position": (0.2, 0.2)}]})["robot"]
    assert robot["position"] == [0.1, 0.1] and robot["rate"] == 0.04
    assert described({"description": "an 'x' = \"y\""})["description"] == "an 'x' = \"y\""
    assert described({"control.max_steps": "2"})["control"]["max_steps"] == 2
    assert described({"control.max_steps": numpy.int64(2)})["control"]["max_steps"] == 2


def test_a_setting_of_a_wrong_kind_is_told_with_what_it_is():
    def said(key, value):
        with pytest.raises(pleach.ScenarioError) as raised:
            described({key: value})
        return str(raised.value)

    assert "boundary[0][1]: the truth value false stands where" in said("workspace.boundary", [(0, False), (1, 1)])
    assert said("control.period", math.inf) == (
        "control.period: inf is not a finite number: write one, such as 0.5"
    )
    assert "control.period: None is no value" in said("control.period", None)
    assert "control.period: {1} is no value" in said("control.period", {1})
    assert "too large: write at most 9223372036854775807" in said("control.max_steps", 2**63)
    assert "robot: the key 1 is no text" in said("robot", [{1: 2}])
    endless = []
    endless.append(endless)
    assert "does one hold itself?" in said("control.period", endless)


def test_mistakes_are_told():
    with pytest.raises(pleach.ScenarioError, match="control.period: -1 is not positive"):
        pleach.run(SCENARIOS / "too-few.toml", {"control.period": -1})
    with pytest.raises(ValueError, match="<text>:1:8: name"):
        pleach.run_text("name = 3")
    with pytest.raises(FileNotFoundError):
        pleach.check("nowhere.toml")
    assert any("no robot can service it" in r for r in pleach.check(SCENARIOS / "unreachable.toml"))
