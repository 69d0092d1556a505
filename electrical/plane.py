"""Values over torque and speed as a data set, which is stored in a compact file, and back."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, ClassVar, Protocol, TypeVar

from labelled import xr

AXES = ("torque_level", "speed_level")


class PlaneRecord(Protocol):
    """Any dataclass."""

    __dataclass_fields__: ClassVar[dict[str, Any]]


Record = TypeVar("Record", bound=PlaneRecord)


def plane_dataset(record: PlaneRecord) -> xr.Dataset:
    """A dataclass whose fields are arrays (torques, speeds), in its own units, such as ``OperatingMap``."""
    return xr.Dataset({one.name: (AXES, getattr(record, one.name)) for one in fields(record)})


def plane_record(kind: type[Record], data: xr.Dataset) -> Record:
    """The dataclass of which ``plane_dataset`` made the data."""
    names = [one.name for one in fields(kind)]
    return kind(**{name: data[name].transpose(*AXES).values for name in names})
