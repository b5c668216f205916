"""Words of an effect model: its slots, play operators, delays and what refines it."""

from .words import Array

EFFECTS = Array(
    *("The effect model and its running state", "e", "`EffectModel.e`", "EFFECTS_WORDS"),
    (
        ("SENSED", 7, "LSB", "the frame, its rates less the effects: for sources beside rests"),
        ("SLOT_COUNT", 1, "", "slots in use, 0: no model"),
        ("INPUT_COUNT", 1, "", "inputs in use"),
        ("TICK_US", 1, "us", "a tick"),
        ("TICK_ELAPSED_US", 1, "us", "of the tick so far"),
        ("TICKS_DUE", 1, "ticks", "that slots are still to be computed for"),
        ("NEXT_SLOT", 1, "", "slot to compute next, plays behind the slots"),
        ("SLOTS_A_SAMPLE", 1, "", "slots and plays that a sample computes"),
        ("HALF_TICKS", 1, "", "middle of the tick, half ticks since power-on"),
        ("RUNNING", 1, "", "0 before the first sample, 1, 2 in the first tick, then 3"),
        ("INSTANT_SLOTS", 1, "", "slots that follow the sample itself"),
        ("SUM_Q14", 3, "LSB", "sum of the slots computed so far"),
        ("HELD_Q14", 3, "LSB", "sum of the tick before, held"),
        ("NOW_Q14", 3, "LSB", "the same with the sample's own slots"),
        ("PLAY_COUNT", 1, "", "play operators in use"),
        ("SLOW_Q8", 3, "LSB", "slow part of the acceleration"),
        ("SQUARES", 2, "LSB^2", "sum of the rest squared: low 15 bits, others"),
        ("SLOW_BEGUN", 1, "", "1 once the slow part has begun"),
        ("REFINE_ON", 1, "", "1: the coefficients go on learning"),
        ("BOUND_EIGHTHS", 1, "", "how far they may go, in eighths of the slot's largest"),
        ("CURVE_LSB", 1, "LSB", "of temperature, that a line on every axis holds; 0: none"),
        ("SENSED_CARRY_Q8", 3, "LSB", "what rounding the rates of SENSED left over"),
        ("INPUTS", 72, "", "12 blocks of an input"),
        ("CHANNELS", 8, "", "what the application last said of each"),
        ("SLOTS", 320, "", "8 blocks of a slot"),
        ("TABLES", 18, "Q24", "2 of 9 points"),
        ("RINGS", 132, "", "2 blocks of a delay"),
        ("REFINE_WORK", 1, "", "next piece of refinement, 0: none"),
        ("STATES", 1, "", "of the filter: offset, line, one a slot"),
        ("RATE_Q8", 3, "LSB", "of the still segment"),
        ("FIRST_TEMP", 1, "LSB", "of the first segment"),
        ("SEEN", 1, "segments", "since power-on"),
        ("SPARE_REFINE", 1, "", "unused"),
        ("REFINE_A", 2, "real", "scratch"),
        ("REFINE_B", 2, "real", "scratch"),
        ("INNOVATION", 2, "real", "variance of what the segment was expected to say"),
        ("MISS", 6, "real", "by how much each axis' rate missed it"),
        ("REGRESSORS", 20, "real", "what each state is multiplied by"),
        ("REFINE_GAIN", 20, "real", "covariance times regressors"),
        ("THETA", 60, "real", "the states of the three axes"),
        ("REFINE_P", 200, "real", "their covariance, by rows"),
        ("PLAYS", 90, "", "6 blocks of a play operator"),
    ),
)

INPUT = Array(
    *("An input of the effect model", "a", "`_INPUTS + i * _INPUT_WORDS`", "INPUT_WORDS"),
    (
        ("INPUT_KIND", 1, "code INPUT_KIND", "which source"),
        ("INPUT_SHIFT", 1, "bits", "by which its values are shifted right to fit 16 bits"),
        ("INPUT_OFFSET", 1, "", "taken from a channel first"),
        ("INPUT_SUM", 1, "", "over the tick"),
        ("INPUT_N", 1, "samples", "of the tick"),
        ("INPUT_VALUE_Q8", 1, "", "mean over the tick before"),
    ),
)

SLOT = Array(
    *("An effect slot", "a", "`_SLOTS + i * _SLOT_WORDS`", "SLOT_WORDS"),
    (
        ("SLOT_SOURCE", 1, "word", "its input's value"),
        ("SLOT_LOWEST_Q8", 1, "", "the source is held above"),
        ("SLOT_HIGHEST_Q8", 1, "", "and below"),
        ("SLOT_CENTRE_Q8", 1, "", "taken from it"),
        ("SLOT_SHIFT", 1, "bits", "left, to Q24"),
        ("SLOT_POWER", 1, "", "1..3"),
        ("SLOT_POWER_FIRST", 1, "", "1: before the memory"),
        ("SLOT_MEMORY", 1, "code MEMORY", "lag, difference, rate, backlash, peak; 0: none"),
        ("SLOT_LAG", 2, "", "mantissa and shift of a tick's share of the way"),
        ("SLOT_HALF_WIDTH", 1, "Q24", "half the backlash"),
        ("SLOT_KNOT", 1, "Q24", "0 below it, or NO_VALUE"),
        ("SLOT_SECOND", 5, "", "second source: word (0: none), lowest, highest, centre, shift"),
        ("SLOT_DECAY", 2, "", "mantissa and shift of a tick's decay, 0: none"),
        ("SLOT_TABLE", 1, "word", "its table, 0: none"),
        ("SLOT_TABLE_FIRST", 1, "Q24", "the table's first point"),
        ("SLOT_TABLE_SCALE", 2, "", "mantissa and shift to its nine"),
        ("SLOT_COEFFICIENT_SHIFT", 1, "bits", "right, to LSB Q14"),
        ("SLOT_COEFFICIENT", 3, "", "mantissas, an axis each"),
        ("SLOT_RING", 1, "word", "its delay's ring, 0: none"),
        ("SLOT_DELAY", 1, "ticks", "of delay"),
        ("SLOT_RING_STEP", 1, "ticks", "from one kept to the next"),
        ("SLOT_OWN", 3, "", "the model's own coefficients"),
        ("SLOT_INSTANT", 1, "code INSTANT", "what of the sample itself it follows, 0: nothing"),
        ("SLOT_STARTED", 1, "", "1 once its memory has begun"),
        ("SLOT_STATE", 2, "Q24", "memory, and what is below a unit of it"),
        ("SLOT_DECAYED", 2, "Q24", "what is left of the decay, and below a unit"),
        ("SLOT_VALUE", 1, "Q24", "what the coefficients are multiplied by"),
    ),
)

PLAY = Array(
    *("A play operator", "a", "`_PLAYS + i * _PLAY_WORDS`", "PLAY_WORDS"),
    (
        ("PLAY_SOURCE", 5, "", "as a slot's source: word, lowest, highest, centre, shift"),
        ("PLAY_RADIUS", 1, "Q24", "how far behind its source it stays"),
        ("PLAY_SHIFT", 1, "bits", "of its coefficients right, to LSB Q14"),
        ("PLAY_COEFFICIENT", 3, "", "mantissas, an axis each, of where it stands"),
        ("PLAY_OF_SQUARE", 3, "", "mantissas, an axis each, of the square of that"),
        ("PLAY_STARTED", 1, "", "1 once it stands somewhere"),
        ("PLAY_STATE", 1, "Q24", "where it stands"),
    ),
)

RING = Array(
    *("A delay's ring", "ring", "`_RINGS + i * _RING_WORDS`", "RING_WORDS"),
    (
        ("RING_NEWEST", 1, "", "place of the newest value"),
        ("RING_AGE", 1, "ticks", "since it was kept"),
        ("RING_KEPT", 64, "Q24", "values"),
    ),
)
