"""What must not be overlooked in a result, as data; ``report`` words it for the kind of output."""

from __future__ import annotations

from dataclasses import dataclass

from drivetrain.output import Output


class Finding:
    """Something worth a sentence; the concrete ones carry the numbers in SI."""

    def words(self, output: Output) -> str:
        """The sentence, without a full stop, in the words and drawing units of an output."""
        raise NotImplementedError


@dataclass(frozen=True)
class Sentence(Finding):
    """What another room says in words of its own, without anything of the output in it."""

    text: str

    def words(self, output: Output) -> str:
        return self.text
