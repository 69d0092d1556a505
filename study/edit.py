"""A study file with some keys set; every other line stays as it was written, comments and all."""

from __future__ import annotations

import re
from collections.abc import Mapping

Setting = str | int | float | bool


def with_settings(text: str, settings: Mapping[str, Mapping[str, Setting]], comment: str) -> str:
    """The text of a study file with these values.

    settings: {section: {key: value}}, in the unit of the key; comment: that stands behind every line that is written
    A key that stands there already is written anew in its place, another one below the head of its section, and a
    section that is missing at the end.
    """
    for section, keys in settings.items():
        for key, value in keys.items():
            text = _with_setting(text, section, f"{key} = {toml_value(value)}", comment)
    return text


def toml_value(value: Setting) -> str:
    """A value as TOML writes it, floats to 9 digits."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        return f'"{escaped}"'
    return f"{value:.9g}" if isinstance(value, float) else str(value)


def _with_setting(text: str, section: str, setting: str, comment: str) -> str:
    line, key = f"{setting}  # {comment}", setting.partition(" ")[0]
    head = re.search(rf"^\[{re.escape(section)}\].*$", text, flags=re.M)
    if head is None:
        return f"{text.rstrip()}\n\n[{section}]\n{line}\n"
    end = re.compile(r"^\[", flags=re.M).search(text, head.end())
    before, own, after = text[: head.end()], text[head.end() : end and end.start()], text[end.start() :] if end else ""
    stated = re.compile(rf"^{re.escape(key)}[ \t]*=.*$", flags=re.M)
    if stated.search(own):
        return before + stated.sub(lambda _: line, own, count=1) + after
    return f"{before}\n{line}{own}{after}"
