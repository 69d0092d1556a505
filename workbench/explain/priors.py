"""What is believed before the data: shares of the hypotheses. They add up to one."""

NOTHING = 0.50  # the model with its tolerances is complete
ONE_EFFECT = 0.35  # one effect of the library is missing; shared by all of them
TWO_EFFECTS = 0.05  # two of them; shared by all pairs
UNKNOWN = 0.05  # something smooth that no effect of the library is
EFFECT_AND_UNKNOWN = 0.05  # one effect, and something more; shared by all of them

# Degrees of freedom of Student's t that the z of an effect is drawn from: a size far off is a surprise, no more.
TAILS = 4.0
