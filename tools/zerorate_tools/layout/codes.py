"""Every code that is kept in a word."""

from .words import Codes

GUARD = Codes(
    *("What the guard says of a frame", "guard"),
    said_in="explain FAULTS",
    said={
        "GOOD": "good frames",
        "REPEAT": "repeated frames",
        "RAIL": "frames at the rail",
        "ALL_ZERO": "frames of all zeros",
        "ALL_ONES": "frames of all ones",
        "TEMPERATURE_JUMP": "jumps of the temperature",
        "TIME_STOOD_STILL": "frames at a time that stood still",
        "TIME_LEAPT": "frames after missed samples",
    },
)
STILLNESS = Codes(
    *("What a window was", ""),
    said_in="explain STILLNESS",
    said={
        "UNKNOWN": "No full window has been seen yet.",
        "STILL": "The device rests.",
        "MOVING": "No rest to learn from: the gyroscope sees motion.",
        "TURNING": "No rest to learn from: gravity turns, so the device turns slowly.",
        "SHAKEN": "No rest to learn from: the accelerometer sees motion.",
        "SHIFTED": "No rest to learn from: the rate has shifted within it.",
        "SILENT": "No rest to learn from: the gyroscope has no noise, as if it were off.",
    },
)
SOURCE = Codes(
    *("Where a bias comes from", "bias"),
    said_in="explain SOURCES",
    said={
        "NONE": "no bias yet",
        "ANY_TEMPERATURE": "any temperature",
        "FIT": "the fit over temperature",
        "HERE": "this temperature",
        "IN_MOTION": "motion",
        "GRAVITY": "gravity",
    },
)
JOB = Codes("What the source in motion is doing", "", "IDLE TRAVERSE SOLVE")
MOTION_REASON = Codes(
    *("What a window in motion taught", ""),
    said_in="explain_sources MOTION",
    said={
        "NO_WINDOW": "no window has been seen yet",
        "GROWING": "the first windows grow",
        "LEARNED": "the latest window taught a bias",
        "HARDLY_MOVES": "the latest window taught nothing: it hardly moves",
        "TURNED": "the latest window taught nothing: it turns and stays turned, "
        "or contradicts what is known",
        "TOO_FAST": "the latest window taught nothing: it turns too fast",
        "LOST": "the latest window taught nothing: the mean force is not 1 g in one direction",
        "MOTION_GAP": "the latest window taught nothing: samples were missing",
    },
)
GRAVITY_REASON = Codes(
    *("What a sub-unit against gravity was", ""),
    said_in="explain_sources LEVEL",
    said={
        "NO_SUB_UNIT": "no half-second has been seen yet",
        "COUNTING": "counting",
        "NOT_ONE_G": "nothing is counted: the force is not 1 g",
        "GRAVITY_GAP": "nothing is counted: samples were missing",
    },
)
MODEL = Codes(
    "What the reader of model.bin says",  # what a store says as well has the same number there
    "model_file",
    said_in="model_file REASONS",
    said={
        "LOADED": "loaded",
        "NO_MODEL": "this is no effect model",
        "DAMAGED": "the model is damaged: its checksum differs",
        "TRUNCATED": "the model is cut short",
        "OTHER_VERSION": "the model is of another version",
        "OTHER_CHIP": "the model was made for another chip",
        "UNREADABLE": "the file cannot be read",
        "OTHER_RANGE": "the model was made for another range",
        "OTHER_FILTER": "the model was made for another filter",
        "OTHER_SCALE": "the model was made for other scales",
        "TOO_LARGE": "the model has more than fits",
        "IMPOSSIBLE": "the model holds what cannot be",
    },
)
STORE = Codes(
    *("What a store says", "codes"),
    said_in="reasons REASONS",
    said={
        "LOADED": "loaded",
        "EMPTY": "nothing was ever stored",
        "DAMAGED": "neither slot is whole",
        "OTHER_BINDING": "stored for another chip, range, filter, effect model or other settings",
        "OTHER_VERSION": "stored by another version",
        "OTHER_SIZE": "stored with another size",
        "UNREADABLE": "the storage cannot be read",
        "OUT_OF_RANGE": "a word of what was stored cannot be",
    },
)
INPUT_KIND = Codes(
    *("Sources of effects: an acceleration, the temperature, a mean rate, ..., a channel", ""),
    KIND_ACCEL=0,
    KIND_TEMP=3,
    KIND_RATE=4,
    KIND_VIBRATION=7,
    KIND_TIME=8,
    KIND_ONE=9,
    KIND_INSTANT=10,
    KIND_CHANNEL=16,
    KIND_CHANNEL_NOW=24,
)
MEMORY = Codes(
    *("An effect slot's memory", ""),
    "MEMORY_LAG MEMORY_DIFFERENCE MEMORY_RATE MEMORY_BACKLASH MEMORY_PEAK",
    first=1,
)
INSTANT = Codes("What of the sample itself a slot follows", "", "OF_RATE OF_ANOTHER", first=1)
MARKS = Codes(
    *("Values that stand for none", ""),
    FREE=-1048576,  # temperature of a free estimator
    NO_VALUE=-0x3FFFFFFF,  # of an input that nothing was heard of, of a slot without a knot
    UNKNOWN_Q8=0x1FFFFFFF,  # one sigma of a bias that is not known
)
LIMITS = Codes(
    *("How many of each an effect model has at most", ""),
    MOST_SLOTS=8,
    MOST_INPUTS=12,
    MOST_CHANNELS=8,
    MOST_PLAYS=6,
    MOST_TABLES=2,
    MOST_RINGS=2,
    TABLE_POINTS=9,
)
