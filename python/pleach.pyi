"""Missions of a distributed robot network, as numpy arrays.

Robots and tasks are numbered from 0, access points follow after the robots. Lengths are in the unit
of the scenario, times in seconds.
"""

import os
from collections.abc import Mapping
from typing import Any

import numpy
from numpy.typing import NDArray

__version__: str

ROLES: tuple[str, ...]
"""The names of the roles; `Mission.roles` holds indices into it."""

class ScenarioError(ValueError):
    """No mission can start from a scenario: every mistake with its place and what would be right."""

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
    `{"robot[*].rate": 0.05}`. With a seed the robots start at random places. Ctrl-C ends the mission
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
