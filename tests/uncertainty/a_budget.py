"""A budget whose numbers are all alike."""

from __future__ import annotations

from dataclasses import fields
from typing import get_type_hints

from uncertainty.budget import Budget, Uncertain


def budget_of_alike(known: Uncertain) -> Budget:
    """Every number of every group is this one."""
    groups = get_type_hints(Budget).values()
    return Budget(*(group(*[known] * len(fields(group))) for group in groups))
