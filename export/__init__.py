"""What leaves the tool: the numbers of a data sheet and files that others build from."""
