"""Reading and checking study files: TOML with drawing units at the border, SI dataclasses inside."""
