"""Noise, declared errors and the fit of a model to a campaign."""
