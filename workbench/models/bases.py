"""Which model answers for the device of a campaign: every module below ``workbench/models`` that has a ``BASE``
is asked."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Mapping
from dataclasses import replace

from workbench import models
from workbench.data.table import Campaign
from workbench.errors import WorkbenchError
from workbench.models.model import BaseModel, Model


def base_models() -> dict[str, BaseModel]:
    """Base models by name."""
    modules = (importlib.import_module(m.name) for m in pkgutil.walk_packages(models.__path__, models.__name__ + "."))
    found = [module.BASE for module in modules if hasattr(module, "BASE")]
    return {base.name: base for base in sorted(found, key=lambda base: base.name)}


def nominal_model(campaign: Campaign) -> Model:
    """The model of the device as declared, without effects.

    Raises:
        WorkbenchError: no base model knows this device.
    """
    return model_of_device(campaign.device, campaign.folder)


def redesigned(model: Model, before: Campaign, after: Campaign) -> Model:
    """The model of the device of one campaign for that of another, itself where they declare the same.

    Raises:
        WorkbenchError: there is no such device.
    """
    same = before.device == after.device
    return model if same else replace(model, design=model.base.design(_inputs(after.device)))


def model_of_device(device: Mapping[str, object], where: str) -> Model:
    """The model of a ``[device]`` table, without effects. where: the file or folder that the table is from

    Raises:
        WorkbenchError: no base model knows this device.
    """
    bases, named = base_models(), device.get("model")
    found = [b for b in bases.values() if b.name == named or (named is None and b.accepts(device))]
    if not found:
        raise WorkbenchError(
            f"{where}: no model knows the [device] table; give model = one of {', '.join(bases)} in it, with its keys."
        )
    return Model(found[0], found[0].design(_inputs(device)))


def _inputs(device: Mapping[str, object]) -> dict[str, object]:
    """The ``[device]`` table without the name of a model."""
    return {key: value for key, value in device.items() if key != "model"}
