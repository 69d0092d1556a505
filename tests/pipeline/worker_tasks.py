"""What the workers of the tests do; importable by name, as worker processes need it."""

import os
import time
from dataclasses import dataclass
from pathlib import Path


def square(number):
    return number**2


def square_or_die(argument):
    """Square of the number; ends its process where the file says that it still has to."""
    number, deaths = argument
    if deaths is not None and (left := int(Path(deaths).read_text())) > 0:
        Path(deaths).write_text(str(left - 1))
        os._exit(1)
    time.sleep(0.05)
    return number**2


def square_of_positive(number):
    if number < 0:
        raise ValueError(f"{number} is negative")
    return number**2


def threads(_):
    return os.environ["OPENBLAS_NUM_THREADS"]


def slow_square(number):
    time.sleep(0.3)
    return number**2


@dataclass(frozen=True)
class Design:
    radius: float
    probes: tuple[float, ...]


def design(radius):
    return Design(radius, (radius, float("inf")))
