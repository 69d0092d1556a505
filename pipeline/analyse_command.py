"""``airgap analyse TOOL RECORD ...``: records of the bench made into a page, a table and what the workbench takes."""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path

from bench.analysis import Analysis, Settings
from bench.errors import RecordError
from bench.record import Record, read_record
from bench.tools import LEVER, TOOLS, Tool
from disk import write_atomically
from figures.report import Code, Section, write_report
from pipeline.own_effects import exit_on_wrong_campaign
from units import same_quantity, split_unit, to_si
from workbench.data.draft import campaign_like
from workbench.report.as_json import plain


def add_analyse(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``airgap analyse``."""
    parser.description = "Analyse records of the bench; headings say quantity and unit (force_N, stroke [mm])."
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = "\n".join(
        f"{name:15} {tool.help}\n{'':15} channels: time, {tool.channels}\n{'':15} values: {_listed(tool)}"
        for name, tool in TOOLS.items()
    )  # fmt: skip
    parser.add_argument("tool", choices=TOOLS, metavar="TOOL", help=", ".join(TOOLS))
    parser.add_argument("records", nargs="+", metavar="RECORD", help="CSV, text or Parquet files; only read")
    parser.add_argument("--value", action="append", default=[], metavar="NAME_UNIT=NUMBER",
                        help="a quantity that is stated, such as shunt_mohm=135; repeatable")  # fmt: skip
    parser.add_argument("--column", action="append", default=[], metavar="QUANTITY=HEADING",
                        help="what a column holds whose heading is another word; repeatable")  # fmt: skip
    parser.add_argument(
        "--like", metavar="DIR", help="campaign of the same device: writes one from the results, ready for diagnose"
    )
    parser.add_argument("--out", metavar="DIR", help="where results go; default results/<tool>/")
    parser.set_defaults(run=analyse)


def analyse(options: argparse.Namespace) -> None:
    """See the module's text."""
    with exit_on_wrong_campaign():
        tool, columns = TOOLS[options.tool], _pairs(options.column, "--column")
        stated = _stated(tool, options.value)
        constants = {name: value for name, value in stated.items() if name in map(_quantity, tool.constants)}
        lever = stated.get(LEVER, 1.0)
        records = [_seen_at_output(read_record(Path(path), columns, constants), lever) for path in options.records]
        found = tool.run(records, Settings(stated))
        out = Path(options.out) if options.out else Path("results") / options.tool
        write_results(out, options.tool, found)
        if options.like:
            _write_campaign(out, options.tool, found, Path(options.like))
    print_results(found, out)


def _listed(tool: Tool) -> str:
    return ", ".join((*tool.constants, *tool.settings, LEVER))


def _quantity(name: str) -> str:
    return split_unit(name)[0]


def _stated(tool: Tool, pairs: list[str]) -> dict[str, float]:
    """Quantities in SI, each of a name and a unit that the tool knows."""
    stated = {}
    for name, text in _pairs(pairs, "--value").items():
        quantity, unit = split_unit(name)
        known = tool.values.get(quantity)
        if known is None or not (unit == known or same_quantity(unit, known)):
            raise RecordError(f"--value {name}: expected one of {_listed(tool)}; correct the name or its unit.")
        try:
            quantity, value = to_si(name, float(text))
        except ValueError:
            raise RecordError(f"--value {name}={text}: expected a number, found {text!r}; correct it.") from None
        stated[quantity] = value
    return stated


def _pairs(texts: list[str], option: str) -> dict[str, str]:
    for text in texts:
        if "=" not in text:
            raise RecordError(f"{option} {text}: expected NAME=..., found no equals sign; correct it.")
    return dict(text.split("=", 1) for text in texts)


def _seen_at_output(record: Record, lever: float) -> Record:
    """A lever of the bench that is not that of the device turns forces up and strokes down by the same factor."""
    turned = {"force": lever, "stroke": 1 / lever, "velocity": 1 / lever}
    channels = {name: values * turned.get(name, 1.0) for name, values in record.channels.items()}
    return replace(record, channels=channels)


def write_results(out: Path, tool: str, found: Analysis) -> None:
    """Page, table and numbers; each is whole or not there."""
    out.mkdir(parents=True, exist_ok=True)
    sections = found.sections
    if found.campaign is not None:
        name = f"{tool}-campaign.csv"
        frame = found.campaign.frame
        write_atomically(out / name, lambda part: frame.to_csv(part, index=False))
        sections = (*sections, _feeds(found.campaign.entry(name), name))
    text = json.dumps(plain({**found.numbers, "remarks": found.remarks}), indent=2, allow_nan=False)
    write_atomically(out / f"{tool}.json", lambda part: part.write_text(text + "\n", encoding="utf-8"))
    write_atomically(out / f"{tool}.csv", lambda part: found.table.to_csv(part, index=False))
    write_atomically(out / f"{tool}.html", lambda part: write_report(part, sections, title=found.title))


def _feeds(entry: str, file: str) -> Section:
    words = (
        f"{file} is a table of a campaign. Beside a campaign.toml with the device these lines let airgap diagnose "
        "read it; --like with a campaign of the same device writes the whole. The uncertainty is that of the records "
        "alone: sensors have gains and offsets of their own."
    )
    return Section("For the workbench", (words, Code(entry)))


def _write_campaign(out: Path, tool: str, found: Analysis, like: Path) -> None:
    if found.campaign is None:
        raise RecordError(f"--like: no model of the workbench answers what {tool} finds; leave --like out.")
    frame, name = found.campaign.frame, f"{tool}.csv"
    folder = out / "campaign"
    text = campaign_like(like, out.name) + "\n" + found.campaign.entry(name)
    folder.mkdir(exist_ok=True)
    write_atomically(folder / name, lambda part: frame.to_csv(part, index=False))
    write_atomically(folder / "campaign.toml", lambda part: part.write_text(text, encoding="utf-8"))
    print(f"campaign in {folder}: airgap diagnose {folder}")


def print_results(found: Analysis, out: Path) -> None:
    """The table, what must not be overlooked, and where the rest lies."""
    print(found.table.to_string(index=False, max_rows=20, float_format=lambda value: f"{value:.4g}"))
    for remark in found.remarks:
        print(f"! {remark}")
    print(f"results in {out}")
