"""Pictures of results: functions from data to a matplotlib Figure, and exports; nothing here reads a study or solves."""
