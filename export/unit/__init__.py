"""What goes into an exported unit and runs there."""
