"""What a model says of its own errors, for all rows of a stack: its base, and the laws of the effects that it has."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from workbench.data.stack import Channel, Stack
from workbench.likelihood.conditions import readings
from workbench.likelihood.unknown import smooth
from workbench.models.model import Model

LAW_LENGTH = 1  # number of the length over which the error of a law changes, see ``likelihood.unknown.LENGTHS``


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
    """What a base model and the laws of its effects cannot say of readings, one standard deviation of each, every
    channel by itself (n, L)."""
    return np.hstack([left_open_by_base(model, stack), _of_laws(stack, errors_of_laws(model, stack))])


def left_open_by_base(model: Model, stack: Stack) -> np.ndarray:
    """What the base model alone cannot say of readings, as ``left_open`` (n, L)."""
    of_tables = [model.base.left_open(model.design, table) for table in stack.tables]
    return _side_by_side(stack, [of_tables[c.table].get(c.response, np.zeros((c.size, 0))) for c in stack.channels])


def errors_of_laws(model: Model, stack: Stack) -> list[np.ndarray]:
    """One standard deviation of what the law of each effect of a model, of those that are not exact, is wrong by, SI
    (n,) each: its relative error times what the effect does beside the others; zero where there is no answer."""
    wrong = [effect for effect in model.effects if effect.law_error > 0]
    whole = readings(model, stack) if wrong else np.zeros(0)
    changes = (whole - readings(model.without(effect.name()), stack) for effect in wrong)
    return [effect.law_error * np.nan_to_num(change) for effect, change in zip(wrong, changes)]


def shapes_of_laws(stack: Stack, channel: Channel, errors: Sequence[np.ndarray]) -> np.ndarray:
    """What laws may be wrong by in the rows of a channel: shapes with a standard normal weight each (n_c, q).

    The change that an effect makes is wrong by a smooth function of the conditions:
        covariance_ij = error_i error_j exp(-d_ij^2 / 2)
    errors: of each law, one standard deviation, SI (n,)
    """
    shapes = smooth(stack.tables[channel.table], LAW_LENGTH)
    return np.hstack([error[channel.rows, None] * shapes for error in errors])


def _of_laws(stack: Stack, errors: Sequence[np.ndarray]) -> np.ndarray:
    if not errors:
        return np.zeros((stack.size, 0))
    none = np.zeros((0, 0))
    return _side_by_side(stack, [shapes_of_laws(stack, c, errors) if c.size else none for c in stack.channels])


def _side_by_side(stack: Stack, shapes: Sequence[np.ndarray]) -> np.ndarray:
    """Those of every channel in its own rows (n, most of one channel)."""
    columns = np.zeros((stack.size, max((own.shape[1] for own in shapes), default=0)))
    for channel, own in zip(stack.channels, shapes):
        columns[channel.rows, : own.shape[1]] = own
    return columns
