"""The device's reader of model.bin: whole, of a known version, made for this chip, or refused.

Little-endian:
    0 "ZRM"  3 version (2 with play operators, else 1)  4 size of all u16  6 slots  7 inputs
    8 tables  9 channels  10 play operators  11 0
    12 binding: chip id, gyro range, accel range, filter, each 255 where it was not known
    16 tick in us u32
    20 five doubles: gyro LSB/dps, accel LSB/g, temp LSB/degC, temp offset degC, odr Hz
    60 inputs: kind, shift, offset, i32 each
    then slots: 30 i32 each, those before SLOT_OWN (docs/layout.md), indices instead of words
    then tables: 9 i32 each, Q24
    then play operators: 13 i32 each, those before PLAY_STARTED, an index as the input
    then texts, each a length byte and UTF-8: sensor, channels, what each slot and operator corrects
    then CRC-32 of all before it
"""

from struct import unpack_from

from ..ratio import Ratio
from ..storage.crc32 import checksum

# layout: names that a board's own compiler reads
const = int
# layout: The effect model and its running state
_INPUT_COUNT = const(8)
_TICK_US = const(9)
_SLOTS_A_SAMPLE = const(13)
_INSTANT_SLOTS = const(16)
_PLAY_COUNT = const(26)
_CURVE_LSB = const(35)
_INPUTS = const(39)
_SLOTS = const(119)
_TABLES = const(439)
_RINGS = const(457)
_PLAYS = const(909)
# layout: An input of the effect model
_INPUT_KIND = const(0)
_INPUT_SHIFT = const(1)
_INPUT_SUM = const(3)
_INPUT_VALUE_Q8 = const(5)
_INPUT_WORDS = const(6)
# layout: An effect slot
_SLOT_SOURCE = const(0)
_SLOT_LOWEST_Q8 = const(1)
_SLOT_HIGHEST_Q8 = const(2)
_SLOT_CENTRE_Q8 = const(3)
_SLOT_SHIFT = const(4)
_SLOT_POWER = const(5)
_SLOT_MEMORY = const(7)
_SLOT_LAG = const(8)
_SLOT_HALF_WIDTH = const(10)
_SLOT_KNOT = const(11)
_SLOT_SECOND = const(12)
_SLOT_DECAY = const(17)
_SLOT_TABLE = const(19)
_SLOT_TABLE_SCALE = const(21)
_SLOT_COEFFICIENT_SHIFT = const(23)
_SLOT_COEFFICIENT = const(24)
_SLOT_RING = const(27)
_SLOT_DELAY = const(28)
_SLOT_RING_STEP = const(29)
_SLOT_OWN = const(30)
_SLOT_INSTANT = const(33)
_SLOT_WORDS = const(40)
# layout: A play operator
_PLAY_SOURCE = const(0)
_PLAY_RADIUS = const(5)
_PLAY_SHIFT = const(6)
_PLAY_COEFFICIENT = const(7)
_PLAY_OF_SQUARE = const(10)
_PLAY_STARTED = const(13)
_PLAY_WORDS = const(15)
# layout: A delay's ring
_RING_WORDS = const(66)
# layout: What the reader of model.bin says
LOADED = const(0)
NO_MODEL = const(1)
DAMAGED = const(2)
TRUNCATED = const(3)
OTHER_VERSION = const(4)
OTHER_CHIP = const(5)
UNREADABLE = const(6)
OTHER_RANGE = const(7)
OTHER_FILTER = const(8)
OTHER_SCALE = const(9)
TOO_LARGE = const(10)
IMPOSSIBLE = const(11)
# layout: What the reader of model.bin says, in words
REASONS = (
    "loaded",
    "this is no effect model",
    "the model is damaged: its checksum differs",
    "the model is cut short",
    "the model is of another version",
    "the model was made for another chip",
    "the file cannot be read",
    "the model was made for another range",
    "the model was made for another filter",
    "the model was made for other scales",
    "the model has more than fits",
    "the model holds what cannot be",
)
# layout: Sources of effects: an acceleration, the temperature, a mean rate, ..., a channel
_KIND_TEMP = const(3)
_KIND_INSTANT = const(10)
_KIND_CHANNEL = const(16)
_KIND_CHANNEL_NOW = const(24)
# layout: What of the sample itself a slot follows
_OF_RATE = const(1)
_OF_ANOTHER = const(2)
# layout: Values that stand for none
_NO_VALUE = const(-0x3FFFFFFF)
# layout: How many of each an effect model has at most
_MOST_SLOTS = const(8)
_MOST_INPUTS = const(12)
_MOST_CHANNELS = const(8)
_MOST_PLAYS = const(6)
_MOST_TABLES = const(2)
_MOST_RINGS = const(2)
_TABLE_POINTS = const(9)
# layout: end
_MODEL_VERSION = const(1)
_VERSION_WITH_PLAYS = const(2)
_BODY = const(60)
_ANY = const(255)
_MOST_COEFFICIENT = const(0x4000000)


def judge(data):
    """Say whether data is a whole model of this version."""
    if len(data) < 4 or bytes(data[:3]) != b"ZRM":
        return NO_MODEL
    if not _MODEL_VERSION <= data[3] <= _VERSION_WITH_PLAYS:
        return OTHER_VERSION
    if len(data) < _BODY + 4 or len(data) < data[4] | data[5] << 8:
        return TRUNCATED
    crc = bytearray(4)
    checksum(memoryview(data)[: len(data) - 4], crc)
    if bytes(data[-4:]) != bytes(crc) or len(data) != data[4] | data[5] << 8:
        return DAMAGED
    most = (_MOST_SLOTS, _MOST_INPUTS, _MOST_TABLES, _MOST_CHANNELS, _MOST_PLAYS)
    for i in range(5):
        if data[6 + i] > most[i]:
            return TOO_LARGE
    if (data[10] > 0) != (data[3] == _VERSION_WITH_PLAYS):
        return IMPOSSIBLE
    return LOADED


def compare(data, sensor, binding):
    """Say whether the model was made for this chip, range and filter, and for these scales."""
    if binding is not None:
        for i in range(4):
            if data[12 + i] != _ANY and i < len(binding) and data[12 + i] != binding[i]:
                return (OTHER_CHIP, OTHER_RANGE, OTHER_RANGE, OTHER_FILTER)[i]
    gyro, accel, temp, offset, _ = unpack_from("<5d", data, 20)
    if not alike(gyro, sensor.gyro_lsb_per_dps):
        return OTHER_RANGE
    if accel and not alike(accel, sensor.accel_lsb_per_g):
        return OTHER_RANGE
    if temp and not alike(temp, sensor.temp_lsb_per_degc):
        return OTHER_SCALE
    if temp and abs(offset - sensor.temp_offset_degc) > 0.01:
        return OTHER_SCALE
    return LOADED


def alike(one, other):
    """Say whether two scales are the same to single precision and then some."""
    return abs(one - other) <= 0.0001 * abs(one)


def fill(e, data, sensor):
    """Put the model's integers into e; IMPOSSIBLE where the kernels could not live with them."""
    e[_INPUT_COUNT] = data[7]
    tick_us = unpack_from("<I", data, 16)[0]
    if texts_at(data) + 4 > len(data) or not 10000 <= tick_us < 1 << 29:
        return IMPOSSIBLE
    e[_TICK_US] = tick_us
    # none of an empty model: the kernel would compute what is not there
    slots = data[6] + data[10]
    each = Ratio(2000000 * slots) / sensor.odr_hz / tick_us
    e[_SLOTS_A_SAMPLE] = each.floor() + 1 if slots else 0
    at = _BODY
    for i in range(data[7]):
        a = _INPUTS + _INPUT_WORDS * i
        if not put(e, a, _INPUT_SUM, data, at):
            return IMPOSSIBLE
        at += 4 * _INPUT_SUM
        kind, shift = e[a + _INPUT_KIND], e[a + _INPUT_SHIFT]
        if (
            not 0 <= kind < _KIND_CHANNEL_NOW + _MOST_CHANNELS
            or not (-8 if kind >= _KIND_CHANNEL else 0) <= shift <= 15
        ):
            return IMPOSSIBLE
    for i in range(data[6]):
        a = _SLOTS + _SLOT_WORDS * i
        if not put(e, a, _SLOT_OWN, data, at) or not link(e, a, data[8]):
            return IMPOSSIBLE
        at += 4 * _SLOT_OWN
    points = _TABLE_POINTS * data[8]
    if not put(e, _TABLES, points, data, at):
        return IMPOSSIBLE
    return fill_plays(e, data, at + 4 * points)


def fill_plays(e, data, at):
    """Put the play operators at `at` into e; IMPOSSIBLE as `fill`."""
    e[_PLAY_COUNT] = data[10]
    for a in range(_PLAYS, _PLAYS + _PLAY_WORDS * data[10], _PLAY_WORDS):
        if not put(e, a, _PLAY_STARTED, data, at):
            return IMPOSSIBLE
        at += 4 * _PLAY_STARTED
        source, shift = a + _PLAY_SOURCE, e[a + _PLAY_SHIFT]
        if not 0 <= e[source] < e[_INPUT_COUNT] or of_the_sample(kind_of(e, source)):
            return IMPOSSIBLE
        if not source_is_bounded(e, source):
            return IMPOSSIBLE
        if not 0 <= e[a + _PLAY_RADIUS] <= 1 << 25 or not 15 <= shift <= 30:
            return IMPOSSIBLE
        for i in (_PLAY_COEFFICIENT, _PLAY_OF_SQUARE):
            if not coefficients_are_bounded(e, a + i):
                return IMPOSSIBLE
        e[source] = word_of(e[source], _INPUTS + _INPUT_VALUE_Q8, _INPUT_WORDS)
    return LOADED


def put(e, to, words, data, at):
    """Put the integers at `at` into e from `to` on; False where one is too large for kernels."""
    for i in range(words):
        value = unpack_from("<i", data, at + 4 * i)[0]
        if value != _NO_VALUE and not -(1 << 29) < value < 1 << 29:
            return False
        e[to + i] = value
    return True


def link(e, a, tables):
    """Turn the slot's indices into words of e and check its numbers; False where they are wrong."""
    if (
        not 0 <= e[a + _SLOT_SOURCE] < e[_INPUT_COUNT]
        or not -1 <= e[a + _SLOT_SECOND] < e[_INPUT_COUNT]
        or not -1 <= e[a + _SLOT_TABLE] < tables
        or not -1 <= e[a + _SLOT_RING] < _MOST_RINGS
        or not 0 <= e[a + _SLOT_DELAY] <= 63 * e[a + _SLOT_RING_STEP]
    ):
        return False
    kind = kind_of(e, a + _SLOT_SOURCE)
    instant = of_the_sample(kind)
    if e[a + _SLOT_SECOND] >= 0 and instant != _OF_RATE:
        instant = of_the_sample(kind_of(e, a + _SLOT_SECOND)) or instant
    if instant and (e[a + _SLOT_MEMORY] or e[a + _SLOT_DECAY] or e[a + _SLOT_RING] >= 0):
        return False
    if not bounded(e, a):
        return False
    e[a + _SLOT_SOURCE] = word_of(e[a + _SLOT_SOURCE], _INPUTS + _INPUT_VALUE_Q8, _INPUT_WORDS)
    e[a + _SLOT_SECOND] = word_of(e[a + _SLOT_SECOND], _INPUTS + _INPUT_VALUE_Q8, _INPUT_WORDS)
    e[a + _SLOT_TABLE] = word_of(e[a + _SLOT_TABLE], _TABLES, _TABLE_POINTS)
    e[a + _SLOT_RING] = word_of(e[a + _SLOT_RING], _RINGS, _RING_WORDS)
    for i in range(3):
        e[a + _SLOT_OWN + i] = e[a + _SLOT_COEFFICIENT + i]
    e[a + _SLOT_INSTANT] = instant
    if instant:
        e[_INSTANT_SLOTS] += 1
    others = (_SLOT_MEMORY, _SLOT_SECOND, _SLOT_DECAY, _SLOT_RING, _SLOT_TABLE)
    if kind == _KIND_TEMP and e[a + _SLOT_POWER] == 1 and not any(e[a + i] for i in others):
        if e[a + _SLOT_KNOT] == _NO_VALUE and all(e[a + _SLOT_OWN : a + _SLOT_OWN + 3]):
            e[_CURVE_LSB] = (e[a + _SLOT_HIGHEST_Q8] - e[a + _SLOT_LOWEST_Q8]) >> 8
    return True


def of_the_sample(kind):
    """Whether a source is that of the sample itself: a rate, or another; 0: a tick's."""
    if kind < _KIND_INSTANT or _KIND_CHANNEL <= kind < _KIND_CHANNEL_NOW:
        return 0
    return _OF_RATE if kind < _KIND_INSTANT + 3 else _OF_ANOTHER


def kind_of(e, at):
    """Return the kind of the input whose index is at the word `at`."""
    return e[_INPUTS + _INPUT_WORDS * e[at] + _INPUT_KIND]


def word_of(index, first, words):
    """Return the word of that block of so many words, 0 for an index of -1."""
    return first + words * index if index >= 0 else 0


def bounded(e, a):
    """Say whether every number of the slot keeps the kernels within 31 bits."""
    if not source_is_bounded(e, a + _SLOT_SOURCE) or not source_is_bounded(e, a + _SLOT_SECOND):
        return False
    if not 1 <= e[a + _SLOT_RING_STEP] <= 256:
        return False
    for f in (_SLOT_LAG, _SLOT_DECAY):
        if not 0 <= e[a + f] <= 1 << 15 or not 0 <= e[a + f + 1] <= 13:
            return False
    if (
        not 1 <= e[a + _SLOT_POWER] <= 3
        or not 0 <= e[a + _SLOT_MEMORY] <= 5
        or not 15 <= e[a + _SLOT_COEFFICIENT_SHIFT] <= 30
    ):
        return False
    if e[a + _SLOT_TABLE] >= 0 and not 15 <= e[a + _SLOT_TABLE_SCALE + 1] <= 30:
        return False
    if not coefficients_are_bounded(e, a + _SLOT_COEFFICIENT):
        return False
    return abs(e[a + _SLOT_HALF_WIDTH]) <= 1 << 25 and (
        e[a + _SLOT_KNOT] == _NO_VALUE or abs(e[a + _SLOT_KNOT]) <= 1 << 25
    )


def source_is_bounded(e, f):
    """Whether a source, centred by the words of a slot or play operator at f, stays within Q24."""
    low, high, shift = e[f + _SLOT_LOWEST_Q8], e[f + _SLOT_HIGHEST_Q8], e[f + _SLOT_SHIFT]
    most = max(abs(low - e[f + _SLOT_CENTRE_Q8]), abs(high - e[f + _SLOT_CENTRE_Q8]))
    if not -8 <= shift <= 24 or low > high:
        return False
    return (most << shift if shift >= 0 else most >> -shift) <= 1 << 24


def coefficients_are_bounded(e, f):
    """Whether the three coefficients at f keep what is added within 31 bits."""
    return all(abs(e[i]) <= _MOST_COEFFICIENT for i in range(f, f + 3))


def texts_at(data):
    """Where the texts of a model begin."""
    return _BODY + 12 * data[7] + 120 * data[6] + 36 * data[8] + 52 * data[10]


def texts(data):
    """The texts of a whole model: sensor, channels, what is corrected; none if not UTF-8."""
    at = texts_at(data)
    found = []
    try:
        while at < len(data) - 4:
            end = at + 1 + data[at]
            found.append(bytes(data[at + 1 : end]).decode())
            at = end
    except ValueError:
        return ()
    return tuple(found)
