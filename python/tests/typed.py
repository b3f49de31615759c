"""What a type checker must accept; it is not run."""

import numpy
from numpy.typing import NDArray

import pleach

mission: pleach.Mission = pleach.run("room.toml", {"control.period": 0.5}, seed=1)
positions: NDArray[numpy.float64] = mission.positions
model = pleach.Automaton("on", {"x": 0.0}).flow("on", {"x": 1}).invariant("on", "x <= 1")
run: pleach.Trajectory = pleach.Composition({"one": model, "two": model}).run(1.0, policy="Early")
values: NDArray[numpy.float64] = run.at(numpy.linspace(0, 1, 5))
findings: list[str] = model.check()
