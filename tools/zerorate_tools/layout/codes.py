"""Every code that is kept in a word."""

from .words import Codes

GUARD = Codes(
    "What the guard says of a frame",
    "guard",
    "GOOD REPEAT RAIL ALL_ZERO ALL_ONES TEMPERATURE_JUMP TIME_STOOD_STILL TIME_LEAPT",
)
STILLNESS = Codes("What a window was", "", "UNKNOWN STILL MOVING TURNING SHAKEN SHIFTED")
SOURCE = Codes("Where a bias comes from", "bias", "NONE ANY_TEMPERATURE FIT HERE IN_MOTION GRAVITY")
JOB = Codes("What the source in motion is doing", "", "IDLE TRAVERSE SOLVE")
MOTION_REASON = Codes(
    "What a window in motion taught",
    "",
    "NO_WINDOW GROWING LEARNED HARDLY_MOVES TURNED TOO_FAST LOST MOTION_GAP",
)
GRAVITY_REASON = Codes(
    "What a sub-unit against gravity was", "", "NO_SUB_UNIT COUNTING NOT_ONE_G GRAVITY_GAP"
)
INPUT_KIND = Codes(
    "Sources of effects: an acceleration, the temperature, a mean rate, ..., a channel",
    "",
    KIND_ACCEL=0,
    KIND_TEMP=3,
    KIND_RATE=4,
    KIND_VIBRATION=7,
    KIND_TIME=8,
    KIND_ONE=9,
    KIND_INSTANT=10,
    KIND_CHANNEL=16,
)
MEMORY = Codes(
    "An effect slot's memory",
    "",
    "MEMORY_LAG MEMORY_DIFFERENCE MEMORY_RATE MEMORY_BACKLASH MEMORY_PEAK",
    first=1,
)
INSTANT = Codes("What of the sample itself a slot follows", "", "OF_RATE OF_ACCELERATION", first=1)
MARKS = Codes(
    "Values that stand for none",
    "",
    FREE=-1048576,  # temperature of a free estimator
    NO_VALUE=-0x3FFFFFFF,  # of an input that nothing was heard of, of a slot without a knot
    UNKNOWN_Q8=0x1FFFFFFF,  # one sigma of a bias that is not known
)
LIMITS = Codes(
    "How many of each an effect model has at most",
    "",
    MOST_SLOTS=8,
    MOST_INPUTS=12,
    MOST_CHANNELS=8,
    MOST_PLAYS=6,
    MOST_TABLES=2,
    MOST_RINGS=2,
    TABLE_POINTS=9,
)
