"""The synchronous machine in its rotor frame on the bench."""
