"""Files that people read: what a stage writes beside its artefact, in drawing units."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

from figures.style import save_pdf, save_png


@dataclass(frozen=True)
class File:
    """A file of the results folder: its name there, and what fills it, given the path of a temporary file."""

    name: str
    write: Callable[[Path], object]


def table_file(name: str, frame: pd.DataFrame) -> File:
    """A table as CSV; columns end in their unit."""
    return File(name, lambda path: frame.to_csv(path, index=False))


def figure_file(name: str, figure: Figure) -> File:
    """A figure as PNG, ``figures/<name>.png``."""
    return File(picture_name(name), lambda path: save_png(figure, path))


def drawing_file(name: str, figure: Figure) -> File:
    """A figure as PDF, for the workshop."""
    return File(name, lambda path: save_pdf(figure, path))


def picture_name(name: str) -> str:
    """Where the figure of a name lies in the results folder."""
    return f"figures/{name}.png"


def text_file(name: str, text: str) -> File:
    """A text in UTF-8."""
    return File(name, lambda path: path.write_text(text, encoding="utf-8"))
