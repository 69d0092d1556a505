"""A machine of any kind on the bench, answered by the magnetic field of its drawing."""
