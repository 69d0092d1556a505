"""The one exception of this package."""


class MaterialError(ValueError):
    """Material data that cannot be used; the message says what was expected, what was found and where.

    point: index (from 0) of the offending point of a curve, None when no single point is to blame.
    """

    def __init__(self, message: str, point: int | None = None) -> None:
        super().__init__(message)
        self.point = point
