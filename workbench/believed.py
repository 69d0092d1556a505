"""What is believed before the data and what is wanted of a diagnosis of effects. How often each effect is met is said
by the effect itself (``base_rate``); sizes and shapes of unknown functions stand in ``likelihood.unknown``, how noise
is measured in ``likelihood.noise``, and what is asked before a convention is blamed in ``explain.mistakes``."""

# Rates with which stated probabilities of something unknown came true on campaigns made for tuning: with four times as
# much, one in thirty had it of those with a stated 5 to 80 %. What is unknown and large needs no belief to be seen.
UNKNOWN_RATE = 0.03  # share of campaigns that show an unknown function of the conditions in a table
LAW_RATE = 0.0025  # the same for each law of the device that no effect of the library is
TAILS = 4.0  # degrees of freedom of Student's t of an effect's size [prior standard deviations]: far off is a surprise
MOST = 4  # effects hidden at once beside what every other bench shows; names for one: more the data cannot tell
LIKELY = 0.5  # more likely than not: that something remains, that nothing is missing, that an unknown law is noticed
FALSE_ALARMS = 0.03  # wanted share of campaigns in which something false is said, by simulated campaigns of the bench
NAMED = 0.95  # probability from which something, or a name, is said to be missing; a name's more where simulations ask
PLAIN = 10.0  # nats that something is expected to gain, from which it would be seen plainly (odds of 20 000 to 1)
SPARE = 5.0  # readings beside tolerances and one size, below which some effect of the library suits any residual
DISAGREE = 1e-3  # probability of sealed rows by chance, below which the model does not hold there
