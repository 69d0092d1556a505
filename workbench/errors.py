"""What is wrong with a campaign, a model file or an effect file."""


class WorkbenchError(ValueError):
    """One sentence: what was expected, what was found, where, what to do."""
