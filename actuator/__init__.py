"""The real actuator between body and wheel: drive, gears, linkage, inertia, friction, a mount with play."""
