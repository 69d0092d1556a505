"""Writes blind campaigns as files: ``python -m benchmarks.blind_campaigns FOLDER --tune 120``.

    FOLDER/damper/single-10003/campaign.toml, *.csv     what a laboratory hands over
    FOLDER/damper/answers.json                          what was hidden, by the name of the campaign's folder
    FOLDER/hashes.json                                  SHA-256 of every campaign and of every answers.json

so that any version of the diagnosis can be tried on the same campaigns, and the answers can be sealed by their hash.
Tuning campaigns come from other seeds and hide other kinds of outside truths than scored ones.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import shutil
import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import pandas as pd

from benchmarks.foreign import Left, left_by_library
from benchmarks.inverse_crime import committed
from benchmarks.virtual_benches.case import GROUPS, VISIBLE, Answer, Bench
from benchmarks.virtual_benches.damper_bench import CATALOGUE as DAMPER
from benchmarks.virtual_benches.dq_bench import CATALOGUE as DQ
from benchmarks.virtual_benches.hiding import bare, hide
from benchmarks.virtual_benches.mistakes import MISTAKES, Mistake, mistaken
from benchmarks.virtual_benches.ngsolve_bench import hide as hide_in_field
from effects.library import library
from pipeline.checkpoint import Checkpoint
from pipeline.pools import PooledWorkers
from processes import Pool, Processes
from workbench.data.campaign import read_campaign
from workbench.data.column_units import split_unit

TUNING_START, SCORED_START = 10000, 0  # first seeds
LUMPED = {"damper": DAMPER, "dq": DQ}
BENCHES = ("damper", "dq", "machine")
FEWEST_KINDS = 2  # of truths outside the library to choose from: the one that is hidden and a small one beside it
STRIDE = 7  # between the mistakes of neighbouring numbers, so that few campaigns see many kinds of them
SHARES = {"null": 0.25, "single": 0.30, "pair": 0.08, "several": 0.12, "outside": 0.17, "mistake": 0.08}
ANSWERS, HASHES, MADE = "answers.json", "hashes.json", "made.jsonl"


@dataclass(frozen=True)
class Wanted:
    """One campaign to be made. scored: from the scored seeds and kinds, not from those for tuning"""

    bench: str
    group: str
    number: int
    scored: bool

    @property
    def seed(self) -> int:
        """Of its random numbers; scored and tuning ones never meet."""
        return self.number + (SCORED_START if self.scored else TUNING_START)

    @property
    def name(self) -> str:
        """Of its folder."""
        return f"{self.group}-{self.seed}"


def wanted(bench: str, count: int, scored: bool, groups: Iterable[str] = GROUPS) -> list[Wanted]:
    """So many campaigns of a bench, shared among the groups as ``SHARES`` says."""
    groups = list(groups)
    whole = sum(SHARES[group] for group in groups)
    counts = {group: max(round(count * SHARES[group] / whole), 1) for group in groups}
    return [Wanted(bench, group, n, scored) for group in groups for n in range(counts[group])]


def write_campaign(task: Mapping[str, object]) -> dict:
    """One campaign into its folder; the answer as plain values. task: fields of ``Wanted``, ``folder`` and ``crime``"""
    asked = Wanted(**{key: task[key] for key in ("bench", "group", "number", "scored")})
    folder = Path(str(task["folder"])) / asked.bench / asked.name
    made, answer = _foreign(asked) if asked.group == "outside" and asked.bench in LUMPED else _made(asked)
    made = replace(made, id=asked.name, holdout="")
    if folder.exists():
        shutil.rmtree(folder)
    if asked.group == "mistake":
        answer = _with_mistake(made, answer, asked, folder)
    else:
        made.write(folder)
    return asdict(_committed(folder, answer) if task["crime"] else answer)


def _committed(folder: Path, answer: Answer) -> Answer:
    """The campaign with readings of the workbench's own model, sizes of its priors and its noise: ``inverse_crime``."""
    campaign = read_campaign(folder)
    crime, answer = committed(campaign, library(), tuple(answer.effects), answer)
    for table in crime.tables:
        frame = pd.read_csv(folder / table.file).dropna()
        for column in frame.columns:
            if (name := split_unit(column)[0]) in table.responses:
                frame[column] = table.responses[name].values
        frame.to_csv(folder / table.file, index=False)
    return answer


def _made(asked: Wanted) -> tuple[Bench, Answer]:
    if asked.bench == "machine":
        return hide_in_field(asked.group, asked.seed, "score" if asked.scored else "tune")
    return hide(LUMPED[asked.bench], asked.group, asked.seed, kinds=_kinds(asked))


def _kinds(asked: Wanted) -> list[str]:
    catalogue = LUMPED[asked.bench]
    return [name for name in catalogue.outside if (name in catalogue.tuning_kinds) != asked.scored]


def _foreign(asked: Wanted) -> tuple[Bench, Answer]:
    """With a truth that no effect of the installed library describes; of a kind that one does, another is taken."""
    kinds = _kinds(asked)
    while True:
        made, answer = hide(LUMPED[asked.bench], asked.group, asked.seed, kinds=kinds)
        left = _left(answer, asked, kinds)
        if left.chi2 >= VISIBLE or len(kinds) == FEWEST_KINDS:
            break
        kinds.remove(answer.outside)
    seen = min(left.chi2, answer.visibility[answer.outside])
    detail = f"the nearest effect of the library is {left.best}"
    return made, replace(answer, visibility={answer.outside: seen}, detail=detail)


def _left(answer: Answer, asked: Wanted, kinds: list[str]) -> Left:
    """What the best effect of the library leaves of a truth."""
    with tempfile.TemporaryDirectory() as name:
        benches = bare(LUMPED[asked.bench], asked.group, asked.seed, kinds=kinds)
        without, changed = (read_campaign(b.write(Path(name) / f"{k}")) for k, b in enumerate(benches))
        return left_by_library(without, changed, library(), answer.about)


def _with_mistake(made: Bench, answer: Answer, asked: Wanted, folder: Path) -> Answer:
    """A right campaign with one mistake of a laboratory in its files; the mistakes take turns."""
    of_bench = [mistake for mistake in MISTAKES[asked.bench] if _can_be_made(mistake, made)]
    mistake = of_bench[asked.number * STRIDE % len(of_bench)]
    with tempfile.TemporaryDirectory() as name:
        mistaken(mistake, made.write(Path(name) / "right"), folder)
    return replace(answer, mistake=mistake.names, detail=mistake.words)


def _can_be_made(mistake: Mistake, made: Bench) -> bool:
    """Mistakes with the angles of one machine's slots and poles are for that machine."""
    return made.device.get("slots", 12) == 12 or not any(
        word in mistake.words for word in ("slot", "pole", "electrical")
    )


def write_campaigns(folder: Path, asked: Iterable[Wanted], pool: Pool, crime: bool = False) -> None:
    """All campaigns with their answers and hashes; those that are there are kept. crime: see ``inverse_crime``"""
    asked = list(asked)
    for bench in dict.fromkeys(one.bench for one in asked):
        _write_bench(folder, bench, [one for one in asked if one.bench == bench], pool, crime)
    (folder / HASHES).write_text(json.dumps(hashes(folder), indent=1), encoding="utf-8")


def _write_bench(folder: Path, bench: str, asked: list[Wanted], pool: Pool, crime: bool) -> None:
    tasks = {one.name: {**asdict(one), "folder": str(folder), "crime": crime} for one in asked}
    done = Checkpoint(folder / bench / MADE, fingerprint(bench))
    made = PooledWorkers(f"{bench} campaigns", pool, lambda what: done).map("campaigns", write_campaign, tasks)
    (folder / bench / ANSWERS).write_text(json.dumps(made, indent=1, sort_keys=True), encoding="utf-8")


def fingerprint(bench: str) -> str:
    """SHA-256 of everything that makes a campaign of a bench, and of the library that says what is outside of it."""
    here = Path(__file__).parent
    folders = (here / "virtual_benches", here.parent / "effects")
    kinds = (".py", ".npz") if bench == "machine" else (".py",)
    files = sorted(path for folder in folders for path in folder.rglob("*") if path.suffix in kinds)
    files += [Path(__file__), here / "foreign.py"]
    return hashlib.sha256(b"".join(path.read_bytes() for path in files)).hexdigest()


def hashes(folder: Path) -> dict[str, str]:
    """SHA-256 of every campaign (its files in order of their names) and of the answers of every bench."""
    found = {}
    for toml in sorted(folder.glob("*/*/campaign.toml")):
        files = sorted(toml.parent.iterdir())
        content = b"".join(file.name.encode() + b"\0" + file.read_bytes() for file in files)
        found[str(toml.parent.relative_to(folder))] = hashlib.sha256(content).hexdigest()
    for answers in sorted(folder.glob(f"*/{ANSWERS}")):
        found[str(answers.relative_to(folder))] = hashlib.sha256(answers.read_bytes()).hexdigest()
    return found


def main(arguments: list[str] | None = None) -> None:
    """Writes the campaigns that are asked for on the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--tune", type=int, metavar="N", help="so many campaigns of a bench for tuning")
    parser.add_argument("--score", type=int, metavar="N", help="so many campaigns of a bench for the score")
    parser.add_argument("--bench", action="append", choices=BENCHES, help="only this bench")
    parser.add_argument("--group", action="append", choices=GROUPS, help="only this group")
    parser.add_argument(
        "--crime", action="store_true", help="readings by the workbench's own model: how much better that looks"
    )
    parser.add_argument("--jobs", type=int, help="processes; as many as there are cores where it is not given")
    chosen = parser.parse_args(arguments)
    if (chosen.tune is None) == (chosen.score is None):
        parser.error("say either --tune N or --score N")
    count, scored = (chosen.tune or chosen.score), chosen.score is not None
    benches = chosen.bench or BENCHES
    asked = [one for bench in benches for one in wanted(bench, count, scored, chosen.group or GROUPS)]
    write_campaigns(chosen.folder, asked, Processes(chosen.jobs), chosen.crime)
    print(f"{len(asked)} campaigns in {chosen.folder}")


if __name__ == "__main__":
    main()
