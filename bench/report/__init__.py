"""What people read of the records: one page a tool."""
