"""Every code that is kept in a word."""

from .words import Codes

GUARD = Codes(
    "What the guard says of a frame",
    "guard",
    GOOD=0,
    REPEAT=1,
    RAIL=2,
    ALL_ZERO=3,
    ALL_ONES=4,
    TEMPERATURE_JUMP=5,
    TIME_STOOD_STILL=6,
    TIME_LEAPT=7,
)
STILLNESS = Codes(
    "What a window was",
    "",
    UNKNOWN=0,
    STILL=1,
    MOVING=2,
    TURNING=3,
    SHAKEN=4,
    SHIFTED=5,
)
SOURCE = Codes(
    "Where a bias comes from",
    "bias",
    NONE=0,
    ANY_TEMPERATURE=1,
    FIT=2,
    HERE=3,
    IN_MOTION=4,
    GRAVITY=5,
)
JOB = Codes("What the source in motion is doing", "", IDLE=0, TRAVERSE=1, SOLVE=2)
MOTION_REASON = Codes(
    "What a window in motion taught",
    "",
    NO_WINDOW=0,
    GROWING=1,
    LEARNED=2,
    HARDLY_MOVES=3,
    TURNED=4,
    TOO_FAST=5,
    LOST=6,
    MOTION_GAP=7,
)
GRAVITY_REASON = Codes(
    "What a sub-unit against gravity was",
    "",
    NO_SUB_UNIT=0,
    COUNTING=1,
    NOT_ONE_G=2,
    GRAVITY_GAP=3,
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
    MEMORY_LAG=1,
    MEMORY_DIFFERENCE=2,
    MEMORY_RATE=3,
    MEMORY_BACKLASH=4,
    MEMORY_PEAK=5,
)
INSTANT = Codes("What of the sample itself a slot follows", "", OF_RATE=1, OF_ACCELERATION=2)
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
