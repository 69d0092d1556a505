"""What one part of the Prius data teaches, tried on the other part. Run: python -m examples.prius.splits

The measured motor of ``examples.prius.story``, split by temperature, torque and voltage: effects and inputs are learned
on one side, and the other side is predicted without anything of the motor being fitted again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from effects.library import package_effects
from examples.prius.story import CAMPAIGN
from workbench.data.campaign import read_campaign
from workbench.data.stack import rows_of
from workbench.data.table import Campaign, Table
from workbench.errors import WorkbenchError
from workbench.ledger.learned import Learned, learned_from
from workbench.ledger.step import try_effect
from workbench.ledger.validate import validate
from workbench.likelihood.bench import bench_of
from workbench.likelihood.regions import sealed_region
from workbench.models.bases import nominal_model
from workbench.report.validation import chi2, share

EFFECTS = ("friction_torque", "copper_drift", "quadrature_saturation", "remanence_drift")  # as the story finds them

Masks = Sequence[np.ndarray]  # rows to learn from, one mask a table


def part(campaign: Campaign, chosen: Masks) -> Campaign:
    """The campaign with the chosen rows only, all of which may be fitted; tables without rows are left out."""
    kept = [rows_of(table, mask) for table, mask in zip(campaign.tables, chosen) if mask.any()]
    tables = tuple(replace(table, held_out=np.zeros(table.rows, dtype=bool)) for table in kept)
    return replace(campaign, tables=tables, file_hashes={}, complaints=())


def learned_on(campaign: Campaign) -> Learned:
    """The effects of the story as these rows make them, with the inputs as fitted. A part of the rows may say little of
    an effect: then its parameter stays as uncertain as it was, and the band is as wide."""
    library, model = package_effects(), nominal_model(campaign)
    for name in EFFECTS:
        try:
            after = try_effect(model, campaign, library, name).after
        except WorkbenchError:  # tried at a size at which the motor pulls out: it cannot be fitted to these rows
            continue
        model = replace(model, effects=after.fit.predictor.model_at(after.null.x).effects[: len(after.model.effects)])
    return learned_from(bench_of(model, campaign, library))


def splits(campaign: Campaign) -> dict[str, Masks]:
    """Rows to learn from, by what is left out of them."""
    emf, cold, warm = campaign.tables
    every, none = (lambda table, value=value: np.full(table.rows, value) for value in (True, False))
    below = lambda name, bound: [_below(table, name, bound) for table in campaign.tables]  # noqa: E731
    sealed = sealed_region(campaign.tables)
    return {
        "35 degC learned, 75 degC predicted": [every(emf), every(cold), none(warm)],
        "75 degC learned, 35 degC predicted": [every(emf), none(cold), every(warm)],
        "torque below 95 Nm learned, above predicted": below("torque", 95.0),
        "voltage below 112 V learned, above predicted": below("v_ll", 112.0),
        f"{sealed.words} predicted": [~mask for mask in sealed.masks],
        "every third row predicted": [~table.held_out for table in campaign.tables],
    }


def _below(table: Table, name: str, bound: float) -> np.ndarray:
    return table.conditions[name] < bound if name in table.conditions else np.ones(table.rows, dtype=bool)


def show(say: Callable[[str], None] = print) -> None:
    """One line a split: effects, chi2/n and share in the 90 % band, corrected and as drawn."""
    campaign, library = read_campaign(CAMPAIGN), package_effects()
    say(f"{'':46} {'n':>3} {'chi2/n':>7} {'as drawn':>8} {'in band':>7} {'as drawn':>8}  effects")
    for name, chosen in splits(campaign).items():
        learned, rest = learned_on(part(campaign, chosen)), part(campaign, [~mask for mask in chosen])
        v = validate(learned, rest, library)
        n = sum(c.n for c in v.corrected)
        say(
            f"{name:46} {n:3d} {chi2(v.corrected):7.2f} {chi2(v.base):8.2f} {share(v.corrected):7.0%} "
            f"{share(v.base):8.0%}  {', '.join(v.effects)}"
        )


if __name__ == "__main__":
    show()
