"""What tolerances do to the designed machine, and how sure its headline numbers are."""
