"""The tables of ``docs/campaign.md`` that come from the code, between two marks each.

python -m workbench.data.manual        # writes them anew
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

from disk import write_atomically
from units import QUANTITIES
from workbench.data.device_keys import DEVICE_KEYS
from workbench.data.kinds import KINDS
from workbench.data.schema import (
    CampaignFile,
    CampaignSection,
    ColumnEntry,
    Section,
    SystematicEntry,
    TableEntry,
    ToleranceEntry,
    keys_of,
)  # fmt: skip

MANUAL: Final = Path(__file__).resolve().parents[2] / "docs" / "campaign.md"


def blocks() -> dict[str, str]:
    """The generated parts by the name of their marks."""
    sections = {
        "sections": CampaignFile, "campaign": CampaignSection, "table": TableEntry, "column": ColumnEntry,
        "tolerance": ToleranceEntry, "systematic": SystematicEntry,
    }  # fmt: skip
    found = {name: _keys(section) for name, section in sections.items()}
    found["kinds"] = _kinds()
    found |= {f"device {model}": _device(model) for model in DEVICE_KEYS}
    found["units"] = ", ".join(f"`{unit}`" for row in QUANTITIES for unit in row) + ", `1`"
    return found


def _keys(section: type[Section]) -> str:
    lines = ["| key | needed | meaning |", "| --- | --- | --- |"]
    needed = {field.alias or name: field.is_required() for name, field in section.model_fields.items()}
    for key, meaning in keys_of(section).items():
        lines.append(f"| `{key}` | {'yes' if needed[key] else ''} | {meaning or 'for people, not looked at'} |")
    return "\n".join(lines)


def _kinds() -> str:
    lines = ["| kind | responses | natural conditions | what was done |", "| --- | --- | --- | --- |"]
    for name, kind in KINDS.items():
        columns = [", ".join(f"`{pattern}`" for pattern in patterns) for patterns in (kind.responses, kind.axes)]
        lines.append(f"| `{name}` | {columns[0] or 'those with `u_random`'} | {columns[1] or 'any'} | {kind.says} |")
    return "\n".join(lines)


def _device(model: str) -> str:
    lines = ["| key | needed | meaning |", "| --- | --- | --- |"]
    lines += [f"| `{key.key}` | {'yes' if key.needed else ''} | {key.meaning} |" for key in DEVICE_KEYS[model]]
    return "\n".join(lines)


def filled(text: str) -> str:
    """The manual with its generated parts as the code has them now."""
    for name, content in blocks().items():
        start, end = f"<!-- {name} -->\n", f"\n<!-- /{name} -->"
        before, found, rest = text.partition(start)
        if not found or end not in rest:
            raise ValueError(f"{MANUAL}: the marks of {name!r} are missing")
        text = before + start + content + rest[rest.index(end) :]
    return text


def main() -> None:
    """Writes the generated parts into the manual."""
    text = filled(MANUAL.read_text(encoding="utf-8"))
    write_atomically(MANUAL, lambda part: part.write_text(text, encoding="utf-8"))


if __name__ == "__main__":
    main()
