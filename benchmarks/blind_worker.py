"""Diagnoses one campaign with the checkout that is on the path: ``python blind_worker.py FOLDER OUT.json``.

Run by ``blind_score`` in a process of its own, so that any version of the project can be asked. Writes what
``airgap diagnose`` writes to diagnosis.json.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.pop(0)  # the folder of this file, which holds modules of another version

SEED = 1  # of the diagnosis itself


def main(folder: str, out: str) -> None:
    from effects.library import library  # here: the workers that solve fields read this file too, and need none of it
    from workbench.data.campaign import read_campaign
    from workbench.errors import WorkbenchError
    from workbench.explain.diagnosis import diagnose
    from workbench.models.bases import nominal_model
    from workbench.report.as_json import diagnosis_json

    try:
        campaign = read_campaign(folder)
        found = diagnose(nominal_model(campaign), campaign, library(), SEED)
    except WorkbenchError as error:
        raise SystemExit(str(error)) from None
    Path(out).write_text(diagnosis_json(found), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
