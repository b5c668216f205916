"""The device's reader of model.bin: whole, of a known version, made for this chip, or refused.

Little-endian:
    0 "ZRM"  3 version (2 with play operators, else 1)  4 size of all u16  6 slots  7 inputs
    8 tables  9 channels  10 play operators  11 0
    12 binding: chip id, gyro range, accel range, filter, each 255 where it was not known
    16 tick in us u32
    20 five doubles: gyro LSB/dps, accel LSB/g, temp LSB/degC, temp offset degC, odr Hz
    60 inputs: kind, shift, offset, i32 each
    then slots: 30 i32 each, words 0..29 of model.py, but indices of inputs and tables
    then tables: 9 i32 each, Q24
    then play operators: 13 i32 each, words 0..12 of model.py, but the index of the input
    then texts, each a length byte and UTF-8: sensor, channels, what each slot and operator corrects
    then CRC-32 of all before it
"""

from struct import unpack_from

from .crc32 import checksum

try:
    from micropython import const
except ImportError:

    def const(value):
        return value


SLOTS = 8
CHANNELS = 8
PLAYS = 6

LOADED = const(0)
UNREADABLE = const(1)
NO_MODEL = const(2)
TRUNCATED = const(3)
DAMAGED = const(4)
OTHER_VERSION = const(5)
OTHER_CHIP = const(6)
OTHER_RANGE = const(7)
OTHER_FILTER = const(8)
OTHER_SCALE = const(9)
TOO_LARGE = const(10)
IMPOSSIBLE = const(11)
REASONS = (
    "loaded",
    "the file cannot be read",
    "this is no effect model",
    "the model is cut short",
    "the model is damaged: its checksum differs",
    "the model is of another version",
    "the model was made for another chip",
    "the model was made for another range",
    "the model was made for another filter",
    "the model was made for other scales",
    "the model has more than fits",
    "the model holds what cannot be",
)

_VERSION = const(1)
_VERSION_WITH_PLAYS = const(2)
_BODY = const(60)
_INPUT = const(32)
_SLOT = const(112)
_TABLE = const(432)
_RING = const(450)
_SLOT_WORDS = const(40)
_MOST_INPUTS = const(12)
_MOST_TABLES = const(2)
_MOST_RINGS = const(2)
_ANY = const(255)
_PLAYS = const(19)
_PLAY = const(902)
_PLAY_WORDS = const(15)
_NONE = const(-0x3FFFFFFF)
_LIMIT = const(0x4000000)
_INSTANT = const(10)
_OF_RATE = const(1)
_OF_ACCELERATION = const(2)
_EXTRA = const(16)


def judge(data):
    """Say whether data is a whole model of this version."""
    if len(data) < 4 or bytes(data[:3]) != b"ZRM":
        return NO_MODEL
    if not _VERSION <= data[3] <= _VERSION_WITH_PLAYS:
        return OTHER_VERSION
    if len(data) < _BODY + 4 or len(data) < data[4] | data[5] << 8:
        return TRUNCATED
    crc = bytearray(4)
    checksum(data, len(data) - 4, crc)
    if bytes(data[-4:]) != bytes(crc) or len(data) != data[4] | data[5] << 8:
        return DAMAGED
    if data[6] > SLOTS or data[7] > _MOST_INPUTS or data[8] > _MOST_TABLES or data[9] > CHANNELS:
        return TOO_LARGE
    if data[10] > PLAYS:
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
    e[1] = data[7]
    tick_us = unpack_from("<I", data, 16)[0]
    if texts_at(data) + 4 > len(data) or not 10000 <= tick_us < 1 << 29:
        return IMPOSSIBLE
    e[2] = tick_us
    e[6] = int(2e6 * (data[6] + data[10]) / (sensor.odr_hz * tick_us)) + 1
    at = _BODY
    for i in range(data[7]):
        for j in range(3):
            if not put(e, _INPUT + 6 * i + j, data, at):
                return IMPOSSIBLE
            at += 4
        kind, shift = e[_INPUT + 6 * i], e[_INPUT + 6 * i + 1]
        if not 0 <= kind < _EXTRA + CHANNELS or not (-8 if kind >= _EXTRA else 0) <= shift <= 15:
            return IMPOSSIBLE
    for i in range(data[6]):
        a = _SLOT + _SLOT_WORDS * i
        for j in range(30):
            if not put(e, a + j, data, at):
                return IMPOSSIBLE
            at += 4
        if not link(e, a, data[8]):
            return IMPOSSIBLE
    for i in range(9 * data[8]):
        if not put(e, _TABLE + i, data, at):
            return IMPOSSIBLE
        at += 4
    return fill_plays(e, data, at)


def fill_plays(e, data, at):
    """Put the play operators at `at` into e; IMPOSSIBLE as `fill`."""
    e[_PLAYS] = data[10]
    for a in range(_PLAY, _PLAY + _PLAY_WORDS * data[10], _PLAY_WORDS):
        for j in range(13):
            if not put(e, a + j, data, at):
                return IMPOSSIBLE
            at += 4
        if not 0 <= e[a] < e[1] or of_the_sample(e, e[a]) or not source_is_bounded(e, a):
            return IMPOSSIBLE
        if not 0 <= e[a + 5] <= 1 << 25 or not 15 <= e[a + 6] <= 30:
            return IMPOSSIBLE
        for i in (7, 10):
            if not coefficients_are_bounded(e, a + i, e[a + 6]):
                return IMPOSSIBLE
        e[a] = _INPUT + 6 * e[a] + 5
    return LOADED


def put(e, to, data, at):
    """Put the integer at `at` into e[to]; False where it leaves what kernels can bear."""
    value = unpack_from("<i", data, at)[0]
    if value != _NONE and not -(1 << 29) < value < 1 << 29:
        return False
    e[to] = value
    return True


def link(e, a, tables):
    """Turn the slot's indices into words of e and check its numbers; False where they are wrong."""
    if not 0 <= e[a] < e[1] or not -1 <= e[a + 12] < e[1] or not -1 <= e[a + 19] < tables:
        return False
    if not -1 <= e[a + 27] < _MOST_RINGS or not 0 <= e[a + 28] <= 63 * e[a + 29]:
        return False
    instant = of_the_sample(e, e[a])
    if e[a + 12] >= 0 and instant != _OF_RATE:
        instant = of_the_sample(e, e[a + 12]) or instant
    if instant and (e[a + 7] or e[a + 17] or e[a + 27] >= 0):
        return False
    if not bounded(e, a):
        return False
    e[a] = _INPUT + 6 * e[a] + 5
    e[a + 12] = _INPUT + 6 * e[a + 12] + 5 if e[a + 12] >= 0 else 0
    e[a + 19] = _TABLE + 9 * e[a + 19] if e[a + 19] >= 0 else 0
    e[a + 27] = _RING + 66 * e[a + 27] if e[a + 27] >= 0 else 0
    for i in range(3):
        e[a + 30 + i] = e[a + 24 + i]
    e[a + 33] = instant
    if instant:
        e[9] += 1
    return True


def of_the_sample(e, i):
    """Whether input i is a rate (1) or an acceleration (2) of the sample itself, or neither (0)."""
    kind = e[_INPUT + 6 * i]
    if kind < _INSTANT or kind >= _EXTRA:
        return 0
    return _OF_RATE if kind < _INSTANT + 3 else _OF_ACCELERATION


def bounded(e, a):
    """Say whether every number of the slot keeps the kernels within 31 bits."""
    if not source_is_bounded(e, a) or not source_is_bounded(e, a + 12):
        return False
    if not 1 <= e[a + 29] <= 256:
        return False
    for f in (8, 17):
        if not 0 <= e[a + f] <= 1 << 15 or not 0 <= e[a + f + 1] <= 13:
            return False
    if not 1 <= e[a + 5] <= 3 or not 0 <= e[a + 7] <= 5 or not 15 <= e[a + 23] <= 30:
        return False
    if e[a + 19] >= 0 and not 15 <= e[a + 22] <= 30:
        return False
    if not coefficients_are_bounded(e, a + 24, e[a + 23]):
        return False
    return abs(e[a + 10]) <= 1 << 25 and (e[a + 11] == _NONE or abs(e[a + 11]) <= 1 << 25)


def source_is_bounded(e, f):
    """Whether a source, centred by the words at f, stays within Q24."""
    most = max(abs(e[f + 1] - e[f + 3]), abs(e[f + 2] - e[f + 3]))
    if not -8 <= e[f + 4] <= 24 or e[f + 1] > e[f + 2]:
        return False
    return (most << e[f + 4] if e[f + 4] >= 0 else most >> -e[f + 4]) <= 1 << 24


def coefficients_are_bounded(e, f, shift):
    """Whether the three coefficients at f keep what is added within 31 bits."""
    for i in range(f, f + 3):
        if abs(e[i]) >> max(0, shift - 24) > 1 << 28 or abs(e[i]) > _LIMIT:
            return False
    return True


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
