"""What a base model says of its own errors, for all rows of a stack."""

from __future__ import annotations

import numpy as np

from workbench.data.stack import Stack
from workbench.models.model import Model


def numerical(model: Model, stack: Stack) -> np.ndarray:
    """Shapes of the base model's own error at its design, each with a standard normal weight that all tables share
    (n, L)."""
    shapes = [model.base.numerical(model.design, table) for table in stack.tables]
    columns = np.zeros((stack.size, max(map(len, shapes), default=0)))
    for channel in stack.channels:
        for k, shape in enumerate(shapes[channel.table]):
            columns[channel.rows, k] = shape.get(channel.response, 0.0)
    return columns


def left_open(model: Model, stack: Stack) -> np.ndarray:
    """What the base model cannot say of readings, one standard deviation of each, every channel by itself (n, L)."""
    of_tables = [model.base.left_open(model.design, table) for table in stack.tables]
    found = [of_tables[c.table].get(c.response, np.zeros((c.size, 0))) for c in stack.channels]
    columns = np.zeros((stack.size, max((shapes.shape[1] for shapes in found), default=0)))
    for channel, shapes in zip(stack.channels, found):
        columns[channel.rows, : shapes.shape[1]] = shapes
    return columns
