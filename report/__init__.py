"""What people read of each stage: its section of the report, tables and figures, in drawing units."""
