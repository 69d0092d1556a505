"""What is wrong with a gearbox, said in one sentence."""


class GearError(ValueError):
    """A gear, mesh, load or search that cannot be; the message says what was found and what to change."""


class TooWeakError(GearError):
    """Teeth fit, but none are strong enough."""
