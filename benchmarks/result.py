"""What every code reports about a case."""
