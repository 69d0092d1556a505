"""What is wound into the slots, before length, current and voltage are known."""

from __future__ import annotations

from dataclasses import dataclass

from electrical.winding_connection import WindingConnection
from electrical.wire import Wire


@dataclass(frozen=True)
class WindingDesign:
    """turns: of one coil, N_t; strands: wires in hand, N_h; wire: each of them; connection: of the coils and phases."""

    turns: float
    strands: int
    wire: Wire
    connection: WindingConnection

    @property
    def copper_area(self) -> float:
        """Copper section of one coil side [m^2]."""
        return self.turns * self.strands * self.wire.area

    @property
    def insulated_area(self) -> float:
        """Section of the wires of one coil side with their enamel [m^2]."""
        return self.turns * self.strands * (self.wire.area + self.wire.enamel_area)

    @property
    def equivalent_turns(self) -> float:
        """Turns of a coil of the equivalent star, N; see ``electrical.winding_connection``."""
        return float(self.connection.equivalent_turns(self.turns))

    def is_like(self, other: WindingDesign) -> bool:
        """Of the same gauge and connection."""
        return (self.wire, self.connection) == (other.wire, other.connection)

    @property
    def wound(self) -> str:
        """Turns and wires in words."""
        turns, wires = ("turn" if self.turns == 1 else "turns"), ("wire" if self.strands == 1 else "wires")
        return f"{self.turns} {turns} of {self.strands} {wires} in hand"

    def __str__(self) -> str:
        return f"{self.wound}, {1e3 * self.wire.copper_diameter:g} mm, {self.connection}"
