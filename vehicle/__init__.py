"""The vehicle on its road: what the suspension actuator must do, and what ride and road holding become of it."""
