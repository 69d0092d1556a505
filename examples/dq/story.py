"""A servo motor whose magnets give way to opposing current. Run: python -m examples.dq.story [folder]

The bench differentiates the flux linkages of the three phases over the angle; the model is the dq machine with constant
parameters. No effect of the library describes what the bench hides: the user writes it in ``my_effect.py``.
"""

import sys
from pathlib import Path

from benchmarks.virtual_benches.dq_bench import DqBench
from benchmarks.virtual_benches.hiding import hide
from examples.story import Story, show, tell

SEED = 10003


def bench(folder: Path) -> Path:
    """The campaign as the laboratory hands it over."""
    campaign, _ = hide(DqBench(), "outside", SEED, wanted=("magnets give way to negative i_d",))
    return campaign.write(folder)


STORY = Story(
    title="A servo motor whose magnets give way to opposing current",
    bench=bench,
    wrong="voltage_offset",
    own=Path(__file__).parent / "my_effect.py",
)

if __name__ == "__main__":
    show(tell(STORY), Path(sys.argv[1] if len(sys.argv) > 1 else "results/examples/dq"))
