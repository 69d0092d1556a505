"""Planetary gearbox scaling laws, and the match of gearbox and motor."""
