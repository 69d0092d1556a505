"""Pictures and pages of results: functions from data to a matplotlib Figure; nothing here reads a study or solves."""
