"""The declared graph: which function makes what from what, read off their signatures.

A *source* makes an input from the study, a *view* derives one value from others, a *stage* makes an artefact that is
kept in the results folder. What a function reads is the types of its parameters, what it writes is the type it returns;
each type has one maker. ``X | None`` reads what may be absent; ``Workers`` is whoever runs tasks.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from graphlib import CycleError, TopologicalSorter
from types import NoneType, UnionType
from typing import Any, Union, get_args, get_origin, get_type_hints

from tasks import Workers

Function = Callable[..., Any]  # of a source, view, stage, export or section; what it takes is read off its signature


class GraphError(TypeError):
    """Functions that do not make a graph: a type with two makers, with none, or a circle."""


@dataclass(frozen=True)
class Parameter:
    """One parameter of a function of the graph: the type it reads, and whether that may be absent."""

    name: str
    kind: type
    optional: bool


@cache
def parameters(function: Function) -> tuple[Parameter, ...]:
    """What a function reads, without its workers."""
    hints = get_type_hints(function)
    names = [name for name in inspect.signature(function).parameters if hints.get(name) is not Workers]
    return tuple(Parameter(name, *_kind(hints, function, name)) for name in names)


@cache
def takes_workers(function: Function) -> str | None:
    """The name of the parameter that takes whoever runs tasks, None where there is none."""
    hints = get_type_hints(function)
    return next((name for name in inspect.signature(function).parameters if hints.get(name) is Workers), None)


@cache
def product(function: Function) -> type:
    """What a function makes."""
    return _kind(get_type_hints(function), function, "return")[0]


def _kind(hints: dict[str, Any], function: Function, name: str) -> tuple[type, bool]:
    if name not in hints:
        raise GraphError(f"{function.__module__}.{function.__qualname__} does not say what {name} is; annotate it")
    hint = hints[name]
    if get_origin(hint) in (Union, UnionType):
        inner = [one for one in get_args(hint) if one is not NoneType]
        if len(inner) == 1:
            return inner[0], True
    if not isinstance(hint, type):
        raise GraphError(f"{function.__qualname__}: {name} is {hint}, but what flows in the graph are classes")
    return hint, False


@dataclass(frozen=True)
class Source:
    """Makes an input from the study. ``function``: (study) -> input."""

    function: Function


@dataclass(frozen=True)
class View:
    """Derives a value from others in no time; not kept."""

    function: Function


@dataclass(frozen=True)
class Stage:
    """Makes an artefact that is kept.

    name: as in ``make <name>``; function: typed values -> artefact; says: what it does, in a few words
    files: typed values -> ``figures.files.File``s, None where people have nothing to read of it
    on_request: runs only when it is named
    remarks: typed values, this artefact among them -> sentences that the run says at once, None where it has none
    """

    name: str
    function: Function
    says: str
    files: Function | None = None
    on_request: bool = False
    remarks: Function | None = None


@dataclass(frozen=True)
class Export:
    """The files that people read of a stage: a step of its own, which may read what later stages make.

    name: of the stage with ``.files``; function: typed values -> ``figures.files.File``s
    """

    name: str
    function: Function


Node = Source | View | Stage
Step = Stage | Export


@dataclass(frozen=True)
class Graph:
    """Sources, views and stages of one kind of study.

    sections: of its report in reading order, typed values -> ``figures.report.Section``, several, or None
    refusals: what the rooms raise when the study asks for something that cannot be
    """

    nodes: tuple[Node, ...]
    sections: tuple[Function, ...] = ()
    refusals: tuple[type[Exception], ...] = ()

    def __post_init__(self) -> None:
        _makers(self), _ordered(self)  # raise where the functions make no graph

    def maker(self, kind: type) -> Node | None:
        """The node that makes a type."""
        return _makers(self).get(kind)

    @property
    def stages(self) -> tuple[Stage, ...]:
        """Every stage after those it reads from, otherwise as declared."""
        return _ordered(self)

    @property
    def usual(self) -> tuple[Stage, ...]:
        """The stages that run when none is named."""
        return tuple(stage for stage in self.stages if not stage.on_request)

    def stage(self, name: str) -> Stage:
        """The stage of a name; KeyError for an unknown one."""
        return {stage.name: stage for stage in self.stages}[name]

    def before(self, stage: Stage) -> tuple[Stage, ...]:
        """The stages that one needs, and the one itself, in order."""
        needed = {stage.name} | {one.name for one in _stages_behind(self, stage)}
        return tuple(one for one in self.stages if one.name in needed)

    def steps(self, stages: tuple[Stage, ...]) -> tuple[Step, ...]:
        """These stages in order, each export as soon as everything that it reads is made."""
        found: list[Step] = []
        waiting = [(stage, Export(f"{stage.name}.files", stage.files)) for stage in stages if stage.files is not None]
        for stage in stages:
            found.append(stage)
            ready = [pair for pair in waiting if {*self.parents(pair[1].function), pair[0]} <= set(found)]
            found += [export for _, export in ready]
            waiting = [pair for pair in waiting if pair not in ready]
        return tuple(found)

    def parents(self, function: Function) -> tuple[Stage, ...]:
        """The stages whose artefacts a function reads, directly or through views.

        Not those that run on request only and whose artefact may be absent: nobody asks for them by asking for this.
        """
        return tuple(dict.fromkeys(_parents(self, function)))


@cache
def _makers(graph: Graph) -> dict[type, Node]:
    found: dict[type, Node] = {}
    for node in graph.nodes:
        kind = product(node.function)
        if kind in found:
            raise GraphError(f"{kind.__name__} is made by {_name(found[kind])} and by {_name(node)}; give it one maker")
        found[kind] = node
    return found


@cache
def _ordered(graph: Graph) -> tuple[Stage, ...]:
    stages = {node.name: node for node in graph.nodes if isinstance(node, Stage)}
    sorter = TopologicalSorter({name: [p.name for p in graph.parents(s.function)] for name, s in stages.items()})
    try:
        sorter.prepare()
    except CycleError as error:
        raise GraphError(f"{' -> '.join(error.args[1])} go round in a circle") from None
    return tuple(stages[name] for name in _in_order(sorter, list(stages)))


def _in_order(sorter: TopologicalSorter[str], declared: list[str]) -> Iterator[str]:
    """Of the stages that are ready always the one declared first."""
    ready: list[str] = []
    while sorter.is_active():
        ready = sorted([*ready, *sorter.get_ready()], key=declared.index)
        first = ready.pop(0)
        yield first
        sorter.done(first)


def _parents(graph: Graph, function: Function) -> Iterator[Stage]:
    for parameter in parameters(function):
        node = graph.maker(parameter.kind)
        if node is None and not parameter.optional:
            raise GraphError(f"{function.__qualname__} reads {parameter.kind.__name__}, which nothing makes")
        if isinstance(node, Stage):
            if not (parameter.optional and node.on_request):
                yield node
        elif isinstance(node, View):
            yield from _parents(graph, node.function)


def _stages_behind(graph: Graph, stage: Stage) -> Iterable[Stage]:
    for parent in graph.parents(stage.function):
        yield parent
        yield from _stages_behind(graph, parent)


def _name(node: Node) -> str:
    return node.name if isinstance(node, Stage) else node.function.__qualname__


def drawing(graph: Graph) -> str:
    """The graph as a Mermaid flowchart: an arrow carries the artefacts that a stage reads."""
    lines = ["flowchart TD", *(f"    {stage.name}[{stage.name}<br/>{stage.says}]" for stage in graph.stages)]
    for stage in graph.stages:
        lines += [f"    {one.name} -- {product(one.function).__name__} --> {stage.name}"
                  for one in graph.parents(stage.function)]  # fmt: skip
    return "\n".join(lines)
