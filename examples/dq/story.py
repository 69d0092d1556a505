"""A servo motor whose magnets give way to opposing current. Run: python -m examples.dq.story [folder]

The bench differentiates the flux linkages of the three phases over the angle; the model is the dq machine with constant
parameters. No effect of the library describes what the bench hides: the user writes it in ``my_effect.py``.
"""

from pathlib import Path

from benchmarks.virtual_benches.dq_bench import DqBench
from examples.story import Story, folder_of_results, hidden, show, tell

STORY = Story(
    title="A servo motor whose magnets give way to opposing current",
    bench=hidden(DqBench, seed=10003, outside="magnets give way to negative i_d"),
    wrong="torque_offset",
    own=Path(__file__).parent / "my_effect.py",
)

if __name__ == "__main__":
    show(tell(STORY), folder_of_results("dq"))
