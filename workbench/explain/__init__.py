"""Which effect is missing, how sure, what to measure next."""
