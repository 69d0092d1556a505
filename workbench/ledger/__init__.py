"""Effects added one by one, and the model on disk."""
