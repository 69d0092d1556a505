"""Planetary gearbox with real teeth: involute geometry, strength after ISO 6336, search, mass and efficiency."""
