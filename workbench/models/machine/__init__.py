"""The machine as built on the bench, by field solutions."""
