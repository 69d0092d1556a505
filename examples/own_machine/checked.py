"""The rotor of assisted.py on a mesh of NGSolve's own: ``python -m examples.own_machine.checked`` (two minutes, needs
``sh benchmarks/set_up``)."""

from pathlib import Path

from benchmarks.own_meshes import compared
from study.machine_file import read_machine

FILE = Path(__file__).with_name("assisted.toml")

if __name__ == "__main__":
    for row in compared("one's own", read_machine(FILE)):
        print(row)
