"""A motor with a bearing that is tight on one side. Run: python -m examples.machine.story [folder]

The bench solves the field of the very machine on another mesh. What it hides is in no effect of the library: friction
that changes once a revolution. The first run takes minutes for field solutions, which are kept in results/cache.
"""

import sys
from pathlib import Path

from benchmarks.virtual_benches.hiding import hide
from benchmarks.virtual_benches.machine_bench import MachineBench
from examples.story import Story, show, tell

SEED = 10012
CACHE = Path("results/cache")


def bench(folder: Path) -> Path:
    """The campaign as the laboratory hands it over."""
    hidden = ("friction that changes once a revolution",)
    campaign, _ = hide(MachineBench(CACHE), "outside", SEED, wanted=hidden)
    return campaign.write(folder)


STORY = Story(
    title="A motor with a bearing that is tight on one side",
    bench=bench,
    wrong="bearing_friction",
    own=Path(__file__).parent / "my_effect.py",
)

if __name__ == "__main__":
    show(tell(STORY), Path(sys.argv[1] if len(sys.argv) > 1 else "results/examples/machine"))
