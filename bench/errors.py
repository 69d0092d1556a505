"""What is wrong with a record, or with what is asked of one."""

from workbench.errors import WorkbenchError


class RecordError(WorkbenchError):
    """One sentence: what was expected, what was found, where, what to do."""
