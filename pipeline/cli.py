"""The command ``airgap``: one table of commands; what a command needs is loaded when it is asked for."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from types import ModuleType

from processes import use_one_thread, without_collecting
from study.errors import exit_on_wrong_study

EXIT_NOT_READ = 141  # as a shell says it of programs that the broken pipe ends


@dataclass(frozen=True)
class Command:
    """Module and function that add the arguments of a command, and what it answers."""

    module: str
    adds: str
    help: str


COMMANDS = {
    "run": Command("pipeline.run_command", "add_run", "run the stages of a study"),
    "check": Command("pipeline.check_command", "add_check", "is a study file usable?"),
    "solve": Command("pipeline.solve_command", "add_solve", "solve the field of one operating point"),
    "turn": Command("pipeline.turn_command", "add_turn", "turn a machine of any kind at one current"),
    "machine": Command("pipeline.machine_command", "add_machine",
                       "map, losses and data sheet of a machine of any kind"),
    "inspect": Command("pipeline.inspect_fields", "add_inspect", "look into the solved fields of a study"),
    "take-over": Command("pipeline.take_over_command", "add_take_over",
                         "make a study of a design that was found over all stages at once"),
    "export-fmu": Command("pipeline.export_fmu_command", "add_export_fmu",
                          "write the actuator of a study for other simulation tools (FMI 2, co-simulation)"),
    "hil": Command("pipeline.hil_command", "add_hil",
                   "the actuator of a study on a bench against its vehicle, paced by the clock"),
    "graph": Command("pipeline.graph_command", "add_graph", "draw the stages of a study and what flows between them"),
    "campaign-from": Command("pipeline.campaign_command", "add_campaign_from",
                             "write the bench campaign of a design, to be measured"),
    "compare": Command("pipeline.workbench_commands", "add_compare", "where does the model fail against a campaign?"),
    "diagnose": Command("pipeline.workbench_commands", "add_diagnose",
                        "which effect is missing, how sure, what to measure next?"),
    "add": Command("pipeline.workbench_commands", "add_add",
                   "add an effect to the model: accepted if the data speak for it and predict no worse"),
    "ledger": Command("pipeline.workbench_commands", "add_ledger",
                      "diagnose and add by itself until nothing more is named; the ledger"),
    "validate": Command("pipeline.workbench_commands", "add_validate",
                        "apply a model file to data that it was not learned from, without fitting the device again"),
    "effects": Command("pipeline.workbench_commands", "add_effects",
                       "what the library knows, one line each; a name shows its equation"),
    "new-effect": Command("pipeline.workbench_commands", "add_new_effect",
                          "a skeleton of one's own effect, from the residual of a campaign"),
    "analyse": Command("pipeline.analyse_command", "add_analyse",
                       "records of the bench: impedance, damping, efficiency, sound, identification"),
    "shunt-laws": Command("pipeline.shunt_laws_command", "add_shunt_laws",
                          "which static law does the damping of a shunted machine follow?"),
    "import": Command("pipeline.workbench_commands", "add_import", "write campaign.toml for plain data files"),
}  # fmt: skip


def main(arguments: list[str] | None = None) -> None:
    """Entry of the console script.

    Exit codes: 0 done, 1 a stage could not go on or the field did not converge, 2 wrong input, 130 Ctrl-C, 141 whoever
    read the output stopped before its end.
    """
    use_one_thread()
    given = sys.argv[1:] if arguments is None else arguments
    options = _parser(given).parse_args(given)
    with exit_on_wrong_study(), _read_to_the_end():
        options.run(options)


@contextmanager
def _read_to_the_end() -> Iterator[None]:
    """Whoever reads the output may stop before its end, as ``head`` does; that is no error of the command."""
    try:
        yield
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # the interpreter writes the rest at its exit
        raise SystemExit(EXIT_NOT_READ) from None


def _parser(given: list[str]) -> argparse.ArgumentParser:
    """The parser of all commands; only the one that is asked for has its arguments."""
    parser = argparse.ArgumentParser(
        prog="airgap", description="Design electric machines, test the design, meet the bench."
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for name, command in COMMANDS.items():
        own = commands.add_parser(name, help=command.help)
        if given[:1] == [name]:
            getattr(_loaded(command.module), command.adds)(own)
    return parser


def _loaded(module: str) -> ModuleType:
    """A module with all that it imports; one that is there already leaves what the process has made since alone."""
    if module not in sys.modules:
        with without_collecting():
            import_module(module)
    return sys.modules[module]


if __name__ == "__main__":
    main()
