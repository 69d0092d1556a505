"""What is wrong with a record, or with what is asked of one."""


class RecordError(ValueError):
    """One sentence: what was expected, what was found, where, what to do."""
