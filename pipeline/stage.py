"""A stage: from declared inputs to files in the results folder, run only when an input changed.

    stage = Stage("sweep", folder, study.subset("machine", "sweep"), code=("geometry",), outputs=("sweep.nc",))
    stage.run(work)          # work(run) calls run.write("sweep.nc", writer) and run.note(newton=...)

Beside each output stands ``<output>.provenance.json``. Whether a stage is current is seen from that file
and from hashes alone: import what is slow inside ``work``, not at the top of the script.
"""

from __future__ import annotations

import hashlib
import json
import os
import platform
import subprocess
import sys
import time
import tomllib
import traceback
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import datetime, timezone
from pathlib import Path
from typing import Callable

from pipeline.checkpoint import Checkpoint, digest
from study.errors import exit_on_wrong_study

PROJECT = Path(__file__).resolve().parent.parent
PYPROJECT = PROJECT / "pyproject.toml"
EXIT_FAILED = 1
EXIT_INTERRUPTED = 130  # what a shell reports after Ctrl-C


class StageError(RuntimeError):
    """A stage that cannot go on; the message says what is missing or what failed, and what to do."""


def results_folder(study_id: str) -> Path:
    """The folder of a study's results, in the project."""
    return PROJECT / "results" / study_id


@contextmanager
def command():
    """Around the body of a script: sentences instead of tracebacks, and an exit code for each kind of end.

    2: the study is wrong; 1: a stage failed (with the traceback of an error in the program); 130: stopped by Ctrl-C.
    """
    with exit_on_wrong_study():
        try:
            yield
        except StageError as error:
            if error.__cause__ is not None:
                traceback.print_exception(error.__cause__)
            print(error, file=sys.stderr)
            raise SystemExit(EXIT_FAILED) from None
        except KeyboardInterrupt as error:
            print(str(error) or "stopped", file=sys.stderr)
            raise SystemExit(EXIT_INTERRUPTED) from None


@dataclass(frozen=True)
class Stage:
    """What a stage reads and writes.

    name: as in ``make <name>``
    folder: folder of the outputs
    values: plain data that the result depends on, such as ``study.subset("machine", "sweep")``
    files: input files, such as the outputs of earlier stages; their contents count
    code: packages and modules of the project that the result depends on, such as "geometry" or "pipeline.sweep"
    outputs: names of the files that the stage writes into its folder
    """

    name: str
    folder: Path
    values: dict
    files: tuple[Path, ...] = ()
    code: tuple[str, ...] = ()
    outputs: tuple[str, ...] = ()

    def inputs(self) -> dict[str, str]:
        """Hash of each input by its name; StageError for a file that does not exist."""
        values = {f"value {name}": digest(value) for name, value in self.values.items()}
        files = {f"file {_short(path)}": self._file_hash(Path(path)) for path in self.files}
        code = {f"code {name}": code_hash(name) for name in self.code}
        return {**values, **files, **code}

    def changes(self) -> list[str]:
        """Why the stage has to run: names of changed inputs and of absent outputs; empty when it is current."""
        inputs = self.inputs()
        return list(dict.fromkeys(reason for name in self.outputs for reason in self._reasons(name, inputs)))

    def run(self, work: Callable[["Run"], None]) -> bool:
        """Call ``work`` when an input changed or an output is absent; True when it was called."""
        reasons = self.changes()
        if not reasons:
            print(f"{self.name}: unchanged, not run again", flush=True)
            return False
        print(f"{self.name}: {_listed(reasons)}", flush=True)
        for name in self.outputs:  # from here on an interrupted run must not look current
            self._provenance_file(name).unlink(missing_ok=True)
        run = Run(self, self.inputs())
        work(run)
        run.finish()
        return True

    def _reasons(self, output: str, inputs: dict[str, str]) -> list[str]:
        path = self.folder / output
        recorded = _json_or_none(self._provenance_file(output))
        if recorded is None or not path.is_file() or path.stat().st_size != recorded["bytes"]:
            return [f"{output} is not there"]
        old = recorded["inputs"]
        return [f"{name} changed" for name in {**old, **inputs} if old.get(name) != inputs.get(name)]

    def _provenance_file(self, output: str) -> Path:
        return self.folder / f"{output}.provenance.json"

    def _file_hash(self, path: Path) -> str:
        if not path.is_file():
            raise StageError(f"{self.name} needs {_short(path)}, which does not exist; run the stage that writes it, "
                             "or `make pipeline`.")
        return hashlib.sha256(path.read_bytes()).hexdigest()


@dataclass
class Run:
    """One run of a stage, handed to its work: takes the results and what is to be remembered about them."""

    stage: Stage
    inputs: dict[str, str]
    notes: dict = field(default_factory=dict)
    started: float = field(default_factory=time.perf_counter)
    written: set[str] = field(default_factory=set)
    _checkpoint: Checkpoint | None = None

    def write(self, output: str, writer: Callable[[Path], object]) -> None:
        """Write one declared output: ``writer`` gets the path of a temporary file, which then takes its place."""
        if output not in self.stage.outputs:
            raise StageError(f"{self.stage.name} writes {output}, which is not among its outputs; declare it there.")
        write_atomically(self.stage.folder / output, writer)
        self.written.add(output)

    def write_text(self, output: str, text: str) -> None:
        """Write one declared output from its text."""
        self.write(output, lambda path: path.write_text(text, encoding="utf-8"))

    def note(self, **entries) -> None:
        """Entries for the provenance: tolerances, the Newton record, counts, whatever explains the result."""
        self.notes.update(entries)

    def checkpoint(self) -> Checkpoint:
        """The store of this stage's finished points; removed when the stage is done."""
        if self._checkpoint is None:
            path = self.stage.folder / f"{self.stage.name}.checkpoint.jsonl"
            self._checkpoint = Checkpoint(path, digest(self.inputs))
        return self._checkpoint

    def finish(self) -> None:
        """Write the provenance beside each output and drop the checkpoint."""
        absent = [name for name in self.stage.outputs if name not in self.written]
        if absent:
            raise StageError(f"{self.stage.name} ended without writing {', '.join(absent)}.")
        record = self._record()
        for name in self.stage.outputs:
            self._write_provenance(name, record)
        if self._checkpoint is not None:
            self._checkpoint.remove()
        print(f"{self.stage.name}: done in {record['wall_time_s']:.1f} s", flush=True)

    def _write_provenance(self, output: str, record: dict) -> None:
        size = (self.stage.folder / output).stat().st_size
        text = json.dumps({"output": output, "bytes": size, **record}, indent=2, default=_plain_number) + "\n"
        write_atomically(self.stage._provenance_file(output), lambda path: path.write_text(text, encoding="utf-8"))

    def _record(self) -> dict:
        return {
            "stage": self.stage.name,
            "created": datetime.now(timezone.utc).isoformat(timespec="seconds"),
            "wall_time_s": round(time.perf_counter() - self.started, 3),
            "inputs": self.inputs,
            "values": self.stage.values,
            "python": platform.python_version(),
            "platform": f"{platform.system()} {platform.machine()}",
            "packages": package_versions(),
            "commit": git_commit(),
            **self.notes,
        }


def write_atomically(path: Path, writer: Callable[[Path], object]) -> None:
    """Let ``writer`` fill a temporary file beside ``path``, then put it in place in one step.

    The temporary name keeps the ending, from which libraries take the format. Nothing is left behind on failure.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.stem}.part{path.suffix}")
    try:
        writer(temporary)
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def code_hash(name: str) -> str:
    """Hash of a module's source, or of all files of a package, data included; StageError for an unknown name."""
    place = PROJECT.joinpath(*name.split("."))
    files = [place.with_suffix(".py")] if not place.is_dir() else sorted(p for p in place.rglob("*") if _counts(p))
    if not files or not files[0].is_file():
        raise StageError(f"there is no package or module {name} in the project; correct the stage's list of code.")
    total = hashlib.sha256()
    for path in files:
        total.update(path.relative_to(PROJECT).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    return total.hexdigest()


def _counts(path: Path) -> bool:
    return path.is_file() and "__pycache__" not in path.parts and not path.name.startswith(".")


def package_versions() -> dict[str, str]:
    """Installed versions of the project's direct dependencies, those that workers load included."""
    from importlib.metadata import PackageNotFoundError, version

    versions = {}
    for requirement in tomllib.loads(PYPROJECT.read_text(encoding="utf-8"))["project"]["dependencies"]:
        name = requirement.partition("==")[0]
        try:
            versions[name] = version(name)
        except PackageNotFoundError:
            versions[name] = "not installed"
    return versions


def git_commit() -> str | None:
    """The commit of the project, with "+" when tracked files differ from it; None without git."""
    try:
        commit = _git("rev-parse", "HEAD")
        return commit + ("+" if _git("status", "--porcelain", "--untracked-files=no") else "")
    except (OSError, subprocess.CalledProcessError):
        return None


def _git(*arguments: str) -> str:
    done = subprocess.run(("git", *arguments), cwd=PROJECT, capture_output=True, text=True, check=True)
    return done.stdout.strip()


def _json_or_none(path: Path) -> dict | None:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def _plain_number(value):
    if hasattr(value, "tolist"):
        return value.tolist()
    return str(value)


def _listed(reasons: list[str], most: int = 3) -> str:
    rest = len(reasons) - most
    return ", ".join(reasons[:most]) + (f" and {rest} more" if rest > 0 else "")


def _short(path: Path) -> str:
    """The path within the project, or the bare name of a file elsewhere: the same on every machine."""
    path = Path(path).resolve()
    return path.relative_to(PROJECT).as_posix() if path.is_relative_to(PROJECT) else path.name
