"""What differs where a record is of another binding: chip, range, filter, which setting, model."""

from array import array

from ..machine_code import unload
from ..settings import DEFAULTS, has_meaning, settings
from .store import unpack

# layout: names that a board's own compiler reads
const = int
# layout: The corrector's settings
_STEP_LSB = const(29)
# layout: end
_AT_BINDING = const(12)
_HEADER = const(20)
_OF_CHIP = ("chip", "gyroscope range", "accelerometer range", "filter")
_OF_SENSOR = ("odr_hz", "gyro_lsb_per_dps", "accel_lsb_per_g", "temp_lsb_per_degc")


def differing(store, corrector):
    """Return in words why the newest record of store, a LearnedStore's, is of another binding."""
    try:
        record = newest(store)
    except OSError as error:
        return "what is stored cannot be read again: %s" % error
    for i in range(4):
        if record[_AT_BINDING + i] != store.binding[i]:
            found = (_OF_CHIP[i], record[_AT_BINDING + i], store.binding[i])
            return "stored for another %s: code 0x%02x, not 0x%02x" % found
    own = corrector.settings
    stored = array("i", range(len(own)))
    unpack(record, -_HEADER - store.size, stored, 4 * len(own))
    words = [i for i in range(len(own)) if own[i] != stored[i]]
    if not words or words == [_STEP_LSB]:  # which a model widens
        return "stored with another effect model" + (" or another step_degc" if words else "")
    names = moved_by(corrector.sensor, words)
    return "stored with another " + (" and another ".join(names) or "rule of learning")


def newest(store):
    """Return the record of the newest whole slot, of whatever binding. Raises OSError."""
    record = bytearray(store.slot_bytes)
    store._find(record)
    store._judge(store._newest, record)
    return record


def moved_by(sensor, words):
    """Return the fewest settings found, by name, that words of the kernels' settings come from.

    Each setting in turn is changed, and what it moves is looked at.
    """
    moves = {}
    first = _made(sensor, {})
    for name in _OF_SENSOR + tuple(DEFAULTS):
        if not has_meaning(name, False, False):
            continue
        made = _changed(sensor, name)
        moves[name] = [i for i in words if made[i] != first[i]], _count(made, first)
    names = []
    while words:
        # what explains most of them, and of two the one that moves less besides
        name = max(moves, key=lambda name: (len(moves[name][0]), -moves[name][1]))
        explained = moves[name][0]
        if not explained:
            break
        names.append(name)
        words = [i for i in words if i not in explained]
        for name in moves:
            moves[name] = [i for i in moves[name][0] if i in words], moves[name][1]
    unload("zerorate", "settings")
    return names


def _count(made, first):
    return sum([made[i] != first[i] for i in range(len(first))])


def _changed(sensor, name):
    """The settings with one input doubled, or halved where it is large."""
    if name in DEFAULTS:
        return _made(sensor, {name: _other(DEFAULTS[name])})
    kept = getattr(sensor, name)
    setattr(sensor, name, _other(kept))
    made = _made(sensor, {})
    setattr(sensor, name, kept)
    return made


def _other(value):
    return value * 2 if value < 0.5 or 1 <= value < 100 else value / 2


def _made(sensor, given):
    return settings(sensor, None, 3, 5, False, False, None, given)[0]
