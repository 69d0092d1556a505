"""A damper whose force constant is not the same over the stroke. Run: python -m examples.damper.story [folder]

The bench integrates the damper in time and knows neither the model nor the library. Its tolerances are drawn, its
instruments have gains and offsets, its noise is correlated with heavy tails, one scan drifts. No effect of the library
describes what it hides. The model says so, and the user writes the effect in ``my_effect.py``.
"""

from pathlib import Path

from benchmarks.virtual_benches.damper_bench import DamperBench
from examples.story import Story, folder_of_results, hidden, show, tell

STORY = Story(
    title="A damper whose force constant falls towards the ends of the stroke",
    bench=hidden(DamperBench, seed=10004, outside="force constant over position"),
    wrong="stribeck_friction",
    own=Path(__file__).parent / "my_effect.py",
)

if __name__ == "__main__":
    show(tell(STORY), folder_of_results("damper"))
