"""The rotor of assisted.py by NGSolve, on the same triangles and on a mesh of its own: ``python -m
examples.own_machine.checked`` (minutes, needs ``sh benchmarks/set_up``)."""

from benchmarks import other_kinds, own_meshes
from benchmarks.drawn_kinds import own

if __name__ == "__main__":
    print(other_kinds.compared(*own()))
    for row in own_meshes.compared(*own()):
        print(row)
