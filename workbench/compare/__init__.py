"""Where a model fails against a campaign."""
