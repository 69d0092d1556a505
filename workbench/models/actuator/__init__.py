"""A permanent-magnet machine behind gears and a linkage, as it is measured at its output."""
