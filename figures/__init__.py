"""Pictures of results: every function takes data and returns a matplotlib Figure; nothing here reads a study or solves."""
