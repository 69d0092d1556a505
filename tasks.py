"""Many independent tasks: what a stage asks for, whoever runs them.

A task is a function at the top level of a module and one plain frozen value that carries everything it needs, so that
it can travel to another process or another machine. A stage takes ``workers: Workers`` and never asks where they are.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Protocol, TypeVar

Task = TypeVar("Task")
Result = TypeVar("Result")


class Workers(Protocol):
    """Whoever runs tasks."""

    def map(self, what: str, function: Callable[[Task], Result], tasks: Mapping[str, Task]) -> dict[str, Result]:
        """``{name: function(task)}`` in the order of the tasks.

        what: one or two words for the progress bar, different for each call of a stage
        function: at the top level of a module; its result is what ``codec`` can write
        tasks: by a name that says to a person which one it is
        """


class InThisProcess:
    """One task after another, for tests and small studies."""

    def map(self, what: str, function: Callable[[Task], Result], tasks: Mapping[str, Task]) -> dict[str, Result]:
        """See ``Workers.map``."""
        return {name: function(task) for name, task in tasks.items()}
