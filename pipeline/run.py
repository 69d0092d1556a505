"""One process runs the graph of a study: what is current stays, what failed is said, every end has its report.

outcome = run(graph, study, Results(folder), pool, to="match")
"""

from __future__ import annotations

import platform
import subprocess
import sys
import time
import traceback
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import cache, partial
from typing import Any

from figures.files import File
from figures.report import Section
from pipeline.checkpoint import Checkpoint
from pipeline.closure import code_digest, packages_of
from pipeline.codec import digest
from pipeline.graph import Export, Function, Graph, Source, Stage, Step, View, parameters, takes_workers
from pipeline.modules import PROJECT
from pipeline.pools import PooledWorkers, TaskError, first_of
from pipeline.results import Results, ResultsError
from processes import LostWorker, Pool, ThisProcess
from study.errors import StudyError


class Missing(LookupError):
    """A value that is not there, because the stage that makes it did not end well; the message says which."""


@dataclass(frozen=True)
class Failure:
    """A stage that could not go on: its name, the reason in one sentence, and the key or input that would help."""

    stage: str
    reason: str


PageOf = Callable[[Any, list[Section], list[Failure]], File]  # what was read, sections, failures


@dataclass
class Run:
    """One run of a graph for one study.

    study: what the sources read: a ``Study``, or a ``MachineFile``; failures: of this run, in order
    pool: where tasks run; drawing: where files that people read are made, beside the stages that come next
    """

    graph: Graph
    study: Any
    results: Results
    pool: Pool
    drawing: Pool = field(default_factory=ThisProcess)
    failures: list[Failure] = field(default_factory=list)
    _done: set[str] = field(default_factory=set)  # stages that are current, by this run
    _drawn: list[_Drawn] = field(default_factory=list)  # in order, until they are kept
    _values: dict[type, Any] = field(default_factory=dict)
    _digests: dict[type, str] = field(default_factory=dict)

    # ---- values of the graph ----------------------------------------------------------------------------------------

    def value(self, kind: type) -> Any:
        """The value of a type; Missing where its stage failed or nothing makes it."""
        if kind not in self._values:
            self._values[kind] = self._made(kind)
        found = self._values[kind]
        if found is None:
            raise Missing(f"{kind.__name__}, which this study has not")
        return found

    def _made(self, kind: type) -> Any:
        node = self.graph.maker(kind)
        if isinstance(node, Source):
            return node.function(self.study)
        if isinstance(node, View):
            return node.function(**self.arguments(node.function))
        if isinstance(node, Stage):
            return self._loaded(node)
        raise Missing(f"{kind.__name__}, which this study has not")

    def _loaded(self, stage: Stage) -> Any:
        self._must_be_done(stage)
        return self.results.load(stage.name)

    def _must_be_done(self, stage: Stage) -> None:
        """A result of an earlier run that this one has not looked at may be stale."""
        if stage.name not in self._done:
            raise Missing(f"the result of {stage.name}, which is not there")

    def digest(self, kind: type) -> str:
        """Hash of the value of a type: of its files for an artefact, of itself otherwise."""
        if kind not in self._digests:
            self._digests[kind] = self._digested(kind)
        return self._digests[kind]

    def _digested(self, kind: type) -> str:
        node = self.graph.maker(kind)
        if not isinstance(node, Stage):
            return digest(self.value(kind))
        self._must_be_done(node)
        record = self.results.record(node.name) or {"outputs": {}}
        return digest({name: one["sha256"] for name, one in record["outputs"].items()})

    def arguments(self, function: Function) -> dict[str, Any]:
        """What a function of the graph is called with, without workers; Missing where something is not there."""
        found = {}
        for one in parameters(function):
            try:
                found[one.name] = self.value(one.kind)
            except Missing:
                if not one.optional:
                    raise
                found[one.name] = None
        return found

    def inputs(self, *functions: Function) -> dict[str, str]:
        """Hash of everything that functions depend on, by its name: values, code, packages."""
        found = {}
        for one in (parameter for function in functions for parameter in parameters(function)):
            try:
                found[one.kind.__name__] = self.digest(one.kind)
            except Missing:
                if not one.optional:
                    raise
                found[one.kind.__name__] = "absent"
        versions = {f"package {name}": version for name, version in packages_of(*functions).items()}
        return {**found, "code": code_digest(digest, *functions), **versions}

    # ---- one result -------------------------------------------------------------------------------------------------

    def step(self, step: Step) -> None:
        """Make the artefact of a stage, or begin with the files of an export, where something that it reads changed."""
        inputs = self.inputs(step.function)
        if isinstance(step, Export):
            if self._is_stale(step.name, inputs):
                task = step.function, self.arguments(step.function), self.results
                started = self.drawing.submit(draw, task)
                self._drawn.append(_Drawn(step, inputs, task, started))
            return
        made = self._current(step.name, inputs, lambda: self._make(step))
        self._done.add(step.name)
        self._say(step, made)

    def _say(self, stage: Stage, made: bool) -> None:
        """What a stage has to say at once when it ran, and that it did not."""
        if not made:
            print(f"{stage.name}: unchanged, not run again", flush=True)
        elif stage.remarks is not None:
            for remark in stage.remarks(**self.arguments(stage.remarks)):
                print(f"{stage.name}: {remark}", flush=True)

    def _current(self, name: str, inputs: dict[str, str], make: Callable[[], list[str]]) -> bool:
        """Call ``make`` where the result of this name is not what these inputs give; True when it was called."""
        if not self._is_stale(name, inputs):
            return False
        started = time.perf_counter()
        outputs = make()
        self._keep(name, inputs, outputs, time.perf_counter() - started)
        return True

    def _is_stale(self, name: str, inputs: dict[str, str]) -> bool:
        """Whether the result of this name is not what these inputs give: that is said, and it looks current no more."""
        record = self.results.record(name)
        reasons = ["not there"] if record is None else _changes(record["inputs"], inputs)
        if reasons:
            print(f"{name}: {first_of(reasons)}", flush=True)
            self.results.forget(name)
        return bool(reasons)

    def _keep(self, name: str, inputs: dict[str, str], outputs: list[str], seconds: float) -> None:
        seconds = round(seconds, 3)
        self.results.keep(name, outputs, {"result": name, **_circumstances(), "wall_time_s": seconds, "inputs": inputs})
        print(f"{name}: done in {seconds:.1f} s", flush=True)

    def _keep_drawn(self, one: _Drawn) -> None:
        """Files that are finished, or will be; drawn here where whoever did it is lost."""
        try:
            outputs, seconds = self.drawing.result(one.started)
        except LostWorker:
            self.drawing.recover()
            outputs, seconds = draw(one.task)
        self._keep(one.export.name, one.inputs, outputs, seconds)

    def _make(self, stage: Stage) -> list[str]:
        kept: list[Checkpoint] = []
        arguments, workers = self.arguments(stage.function), takes_workers(stage.function)
        if workers is not None:
            inputs = digest(self.inputs(stage.function))

            def checkpoint_of(what: str) -> Checkpoint:
                kept.append(Checkpoint(self.results.checkpoint_file(stage.name, what), inputs))
                return kept[-1]

            arguments[workers] = PooledWorkers(stage.name, self.pool, checkpoint_of)
        outputs = self.results.save(stage.name, stage.function(**arguments))
        for one in kept:
            one.remove()
        return outputs

    # ---- the whole --------------------------------------------------------------------------------------------------

    def all(self, stages: tuple[Stage, ...]) -> None:
        """Every stage in order; one that cannot go on is noted, and those that need it are left out."""
        for step in self.graph.steps(stages):
            self._try(step, partial(self.step, step))
            self._keep_all([one for one in self._drawn if one.started.done()])
        self._keep_all(self._drawn)

    def _keep_all(self, drawn: Sequence[_Drawn]) -> None:
        for one in tuple(drawn):
            self._drawn.remove(one)
            self._try(one.export, partial(self._keep_drawn, one))

    def _try(self, step: Step, go: Callable[[], None]) -> None:
        try:
            go()
        except Missing as missing:
            print(f"{step.name}: left out, it needs {missing}", flush=True)
            if isinstance(step, Stage):  # the files of a stage that failed go without saying
                self._note(step, f"left out: it needs {missing}.")
        except (ResultsError, StudyError):
            raise
        except Exception as error:  # noqa: BLE001 - whatever stops a stage must not lose the report
            self._note(step, self._said(error))
            print(f"{step.name}: {self.failures[-1].reason}", file=sys.stderr, flush=True)

    def _said(self, error: Exception) -> str:
        """The sentence of a room that refuses what the study asks for; the traceback first for anything else."""
        told = error.__cause__ if isinstance(error, TaskError) and error.__cause__ is not None else error
        if isinstance(told, self.graph.refusals):
            return str(told)
        if isinstance(error, TaskError) and told is error:
            return str(error)
        traceback.print_exception(told)
        return f"a fault of the program: {type(told).__name__}: {told}"

    def _note(self, step: Step, reason: str) -> None:
        self.failures.append(Failure(step.name, reason))

    def sections(self) -> Iterator[Section]:
        """The sections of the report for which there is something to say."""
        for section in self.graph.sections:
            with suppress(Missing):
                found = section(**self.arguments(section))
                yield from found if isinstance(found, tuple) else [found] if found is not None else []

    def report_inputs(self) -> dict[str, str]:
        """What the report depends on: values of its sections, pictures, failures, code."""
        found: dict[str, str] = {}
        for section in self.graph.sections:
            with suppress(Missing):
                found |= self.inputs(section)
        for stage in self.graph.stages:
            record = self.results.record(f"{stage.name}.files")
            found[f"{stage.name}.files"] = digest(record["outputs"]) if record else "absent"
        return {**found, "failures": digest(tuple(self.failures)), "code": code_digest(digest, *self.graph.sections)}

    def write_report(self, page_of: PageOf) -> None:
        """The report, where anything in it changed."""

        def make() -> list[str]:
            page = page_of(self.study, list(self.sections()), self.failures)
            self.results.write(page.name, page.write)
            return [page.name]

        if not self._current("report", self.report_inputs(), make):
            print("report: unchanged, not written again", flush=True)


Drawing = tuple[Function, dict[str, Any], Results]  # what makes files, what it is called with, where they go


@dataclass(frozen=True, eq=False)
class _Drawn:
    """Files that are being made. inputs: what they depend on, see ``Run.inputs``"""

    export: Export
    inputs: dict[str, str]
    task: Drawing
    started: Future[tuple[list[str], float]]


def draw(task: Drawing) -> tuple[list[str], float]:
    """Make the files that people read of a stage; their names, and the seconds that it took."""
    started, written = time.perf_counter(), []
    function, arguments, results = task
    for file in function(**arguments):
        results.write(file.name, file.write)
        written.append(file.name)
    return written, time.perf_counter() - started


def _changes(old: dict[str, str], new: dict[str, str]) -> list[str]:
    return [f"{name} changed" for name in {**old, **new} if old.get(name) != new.get(name)]


def _circumstances() -> dict[str, Any]:
    return {
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "platform": f"{platform.system()} {platform.machine()}",
        "commit": git_commit(),
    }


@cache
def git_commit() -> str | None:
    """The commit of the project, with "+" when tracked files differ from it; None without git.

    Asked once: what this process runs is what it has loaded, whatever is committed meanwhile.
    """
    try:
        commit = _git("rev-parse", "HEAD")
        return commit + ("+" if _git("status", "--porcelain", "--untracked-files=no") else "")
    except (OSError, subprocess.CalledProcessError):
        return None


def _git(*arguments: str) -> str:
    done = subprocess.run(("git", *arguments), cwd=PROJECT, capture_output=True, text=True, check=True)
    return done.stdout.strip()
