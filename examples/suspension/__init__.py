"""A controller and a vehicle of one's own with the real actuator."""
