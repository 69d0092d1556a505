"""How warm the machine becomes: a network of heat, the films of air around it, what it may carry and for how long."""
