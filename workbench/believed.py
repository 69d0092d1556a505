"""All that is believed before the data and all that is wanted of a diagnosis: the only hand-set numbers that a verdict
rests on. How often each effect is met is said by the effect itself (``base_rate``)."""

UNKNOWN_RATE = 0.12  # share of campaigns that show something which no effect of the library is
TAILS = 4.0  # degrees of freedom of Student's t of an effect's size [prior standard deviations]: far off is a surprise
MOST = 4  # effects that may be hidden at once
SURE = 0.95  # probability from which a name is printed, and from which something is said to be missing
LIKELY = 0.5  # probability from which "something remains" is said, and share of unknown laws that must be noticed
FALSE_ALARMS = 0.02  # wanted share of empty campaigns in which something is said to be missing
PLAIN = 10.0  # nats that something is expected to gain, from which it would be seen plainly (odds of 20 000 to 1)
LARGEST_GROUP = 4  # names that may stand for one effect; with more the data tell nothing
SPARE = 5.0  # readings beside tolerances and one size, below which some effect of the library suits any residual
DISAGREE = 1e-3  # probability of sealed rows by chance, below which the model does not hold there
