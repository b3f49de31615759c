"""Missions of a distributed robot network, and models of your own, with runs as numpy arrays.

Robots and tasks are numbered from 0, access points follow after the robots. Lengths are in the unit
of the scenario, times in seconds.
"""

import os
from collections.abc import Mapping, Sequence
from typing import Any, Literal, final

from typing_extensions import Self

import numpy
from numpy.typing import NDArray

__version__: str

ROLES: tuple[str, ...]
"""The names of the roles; `Mission.roles` holds indices into it."""

LOCATIONS: tuple[str, ...]
"""The names of the locations of the duty automaton; `Mission.locations` holds indices into it."""

class ScenarioError(ValueError):
    """No mission can start from a scenario: every mistake with its place and what would be right."""

class ModelError(ValueError):
    """The parts do not make a model, or it cannot be run: what is wrong, and where."""

@final
class Mission:
    """A mission that has ended. K control periods, N robots."""

    @property
    def name(self) -> str:
        """The name of the scenario."""
    @property
    def scenario(self) -> dict[str, Any]:
        """The scenario, every default filled in."""
    @property
    def outcome(self) -> str:
        """How it ended, such as `serviced`."""
    @property
    def reason(self) -> str:
        """Why it ended, as a sentence."""
    @property
    def task(self) -> int | None:
        """The task that the end concerns."""
    @property
    def given_up(self) -> list[int]:
        """The tasks that no robot could service; the event `task_given_up` of each has the reason."""
    @property
    def times(self) -> NDArray[numpy.float64]:
        """Shape (K,): the instants at which the periods begin."""
    @property
    def positions(self) -> NDArray[numpy.float64]:
        """Shape (K, N, 2)."""
    @property
    def residuals(self) -> NDArray[numpy.float64]:
        """Shape (K, N): c_i, as a share of the radio's rate."""
    @property
    def multipliers(self) -> NDArray[numpy.float64]:
        """Shape (K, N): λ_i."""
    @property
    def roles(self) -> NDArray[numpy.uint8]:
        """Shape (K, N): indices into `ROLES`."""
    @property
    def locations(self) -> NDArray[numpy.uint8]:
        """Shape (K, N): where each robot is in the duty automaton, indices into `LOCATIONS`."""
    @property
    def targets(self) -> NDArray[numpy.float64]:
        """Shape (K, N, 2): where each robot goes; NaN if it stands still."""
    @property
    def messages(self) -> NDArray[numpy.uint64]:
        """Shape (K, N, 2): how many messages each robot has sent and heard in the period."""
    @property
    def events(self) -> list[dict[str, Any]]:
        """The events with their period `k`, as in traces."""
    @property
    def routes(self) -> NDArray[numpy.float64]:
        """Shape (M, 5): rows (k, from, to, T, R) of every route in use."""
    @property
    def tree(self) -> NDArray[numpy.int64]:
        """Shape (M, 3): rows (k, child, parent) of every edge of the tree."""

def run(
    scenario: str | os.PathLike[str],
    settings: Mapping[str, object] | None = None,
    *,
    seed: int | None = None,
) -> Mission:
    """Run the mission of a scenario file.

    `settings` replaces values of the file by their keys, such as `{"control.period": 0.5}` or
    `{"robot[*].rate": 0.05}`: truth values, numbers, texts, lists and mappings. Tuples and arrays of
    numpy are lists; a text that TOML reads as a value is that value. With a seed the robots start at random places. Ctrl-C ends the mission
    in order, with the outcome `interrupted`.
    """

def run_text(
    text: str,
    settings: Mapping[str, object] | None = None,
    *,
    seed: int | None = None,
) -> Mission:
    """Run the mission of a scenario that is given as TOML."""

def check(
    scenario: str | os.PathLike[str],
    settings: Mapping[str, object] | None = None,
) -> list[str]:
    """Remarks on a scenario from which a mission can start: tasks that no robot can service, links
    through walls. Raises `ScenarioError` if none can start."""

@final
class Automaton:
    """A hybrid automaton that is put together part by part.

    Locations and events are names; those that are mentioned exist. Formulas are text over the names
    of coordinates and parameters, such as `"-0.8 * v"`, and predicates such as `"h <= 0 and v < 0"`.
    """

    def __new__(
        cls,
        initial: str,
        state: Mapping[str, float],
        *,
        parameters: Mapping[str, float] | None = None,
    ) -> Self:
        """An automaton that starts in the location `initial` with the coordinates in `state`."""

    def flow(self, location: str, rates: Mapping[str, str | float]) -> Self:
        """Say how fast coordinates change in a location, per second; others rest."""

    def invariant(self, location: str, predicate: str) -> Self:
        """Say while what time may pass in a location; without it, it always may."""

    def transition(
        self,
        source: str,
        event: str,
        target: str,
        *,
        must: str | None = None,
        may: str | None = None,
        at_once: str | None = None,
        then: Mapping[str, str | float] | None = None,
        priority: int = 0,
    ) -> Self:
        """Add a transition with exactly one guard.

        With `must` it is taken when the guard becomes true, with `may` it can be, with `at_once` no
        time passes where the guard holds. `then` gives coordinates new values, each a formula over
        the state before.
        """

    def check(self) -> list[str]:
        """What is wrong with the model or could be, the worst first, each with its place."""

    def diagram(self, format: Literal["mermaid", "dot", "svg"] = "mermaid") -> str:
        """The drawing of the automaton."""

    def run(self, horizon: float, **settings: Any) -> Trajectory:
        """Run the automaton by itself for `horizon` seconds.

        Settings are `policy` (`"Late"`, `"Early"` or `{"Random": {"seed": 1}}`: when a transition is
        taken that only may be), `method` (`"Automatic"`, `"Explicit"` or `"Implicit"`: how flows are
        integrated), `relative_tolerance`, `absolute_tolerance`, `largest_step` (infinite by default),
        `resolution`, `round_limit`, `jump_limit`, `step_limit`, `memory_limit` and `accumulation`
        (`"End"` or `"Off"`).
        """

@final
class Composition:
    """Automata side by side."""

    def __new__(
        cls,
        components: Mapping[str, Automaton],
        *,
        connect: Mapping[str, str] | None = None,
        labels: Sequence[str] = ...,
    ) -> Self:
        """Automata by their names.

        `connect` maps inputs to the outputs that they read, as in `{"controller.p": "cart.p"}`.
        Components that have an event among `labels` take it together.
        """

    def check(self) -> list[str]:
        """What is wrong with the model or could be, the worst first, each with its place."""

    def run(self, horizon: float, **settings: Any) -> Trajectory:
        """Run the composition for `horizon` seconds, with settings as for an automaton."""

@final
class Trajectory:
    """A run of a model. S samples, V variables, C components.

    Samples lie so close together that cubics through them look like the run; `at` gives the values
    at other instants, as exactly as they were computed.
    """

    @property
    def variables(self) -> list[str]:
        """The names of the variables; in a composition `component.coordinate`."""
    @property
    def components(self) -> dict[str, list[str]]:
        """The names of the locations of each component."""
    @property
    def times(self) -> NDArray[numpy.float64]:
        """Shape (S,). The instant of a jump is there twice, before and after it."""
    @property
    def jumped(self) -> NDArray[numpy.uint32]:
        """Shape (S,): how many jumps are past."""
    @property
    def values(self) -> NDArray[numpy.float64]:
        """Shape (S, V)."""
    @property
    def locations(self) -> NDArray[numpy.uint32]:
        """Shape (S, C): indices into the lists of `components`."""
    @property
    def jumps(self) -> list[dict[str, Any]]:
        """The jumps: `t`, `label`, and `moves` as (component, source, target)."""
    @property
    def end(self) -> float:
        """The instant at which the run ended."""
    @property
    def outcome(self) -> str:
        """How long the run was and why it ended, in a line."""
    def __getitem__(self, variable: str, /) -> NDArray[numpy.float64]:
        """Shape (S,): the values of one variable."""
    def __len__(self) -> int:
        """S."""
    def at(self, times: NDArray[numpy.float64]) -> NDArray[numpy.float64]:
        """Shape (len(times), V): the values after all jumps at these instants; NaN outside the run."""
    def page(self, title: str = "A run") -> str:
        """The page on which the run plays, an HTML document."""
    def plot(self) -> str:
        """The variables over time, an SVG picture."""
    def to_json(self) -> str:
        """The trajectory as JSON, which the Rust library reads back."""
