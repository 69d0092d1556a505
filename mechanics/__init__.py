"""Whether rotor, shaft and bearings bear what speed, torque and magnetic pull ask of them."""
