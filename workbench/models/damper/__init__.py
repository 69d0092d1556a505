"""The lumped electromagnetic damper on the bench."""
