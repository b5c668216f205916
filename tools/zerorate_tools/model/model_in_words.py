"""A model in words: what `zerorate model show` prints, and how two differ."""

from collections.abc import Iterator

from .binary import encoded
from .model import Model, Slot, is_channel
from .rate_matrix import matrix_in_words
from .term import Term

UNITS = {"temp": "degC", "vib": "g^2", "time": "s", "one": ""}


def unit_of(source: str) -> str:
    """The unit of a source's numbers; an extra channel has its column's own."""
    if source.startswith("acc_"):
        return "g"
    return UNITS.get(source, "" if is_channel(source) else "dps")


def in_words(model: Model) -> str:
    """The whole model, a slot a paragraph."""
    scales, size = model.scales, len(encoded(model))
    lines = [
        f"{slots_in_words(model)}, {size} bytes, one tick in {model.tick_s:g} s",
        f"for {scales.sensor} at {scales.odr_hz:g} Hz, {scales.gyro_lsb_per_dps:g} LSB/dps; "
        + _binding(model),
    ]
    if model.channels:
        lines.append("the application gives: " + ", ".join(model.channels))
    for number, slot in enumerate(model.slots, 1):
        lines += ["", f"{number}. {slot.effect or 'effect'}: {basis_in_words(slot)}"]
        lines += [f"   {line}" for line in _numbers(slot)]
    matrix = matrix_in_words(model)
    return "\n".join([*lines, *([""] if matrix else []), *matrix])


def slots_in_words(model: Model) -> str:
    """How many effect slots it has: `1 effect slot`."""
    count = len(model.slots)
    return f"{count} effect slot" + ("" if count == 1 else "s")


def _binding(model: Model) -> str:
    named = {
        "chip id": None if model.binding.chip_id is None else f"{model.binding.chip_id:#04x}",
        "gyro range code": model.binding.gyro_range,
        "accel range code": model.binding.accel_range,
        "filter code": model.binding.filter,
    }
    return ", ".join(f"{k} {'any' if v is None else v}" for k, v in named.items())


def basis_in_words(slot: Slot) -> str:
    """What the coefficients are multiplied by, from the source outwards."""
    return ", ".join(_steps(slot))


def _steps(slot: Slot) -> Iterator[str]:
    t = slot.term
    unit = unit_of(t.source)
    yield "1" if t.source == "one" else f"{t.source} less {t.centre:g} {unit}".rstrip()
    if t.delay_s:
        yield f"{t.delay_s:g} s ago"
    if t.power_first and t.power > 1:
        yield f"to the power of {t.power}"
    yield from _memory(t, unit)
    if t.knot is not None:
        yield f"what is above {t.knot:g} {unit}".rstrip()
    if slot.term.table:
        yield "through a table"
    elif not t.power_first and t.power > 1:
        yield f"to the power of {t.power}"
    if t.second:
        yield f"times ({t.second} less {t.second_centre:g} {unit_of(t.second)})".replace(" )", ")")
    if t.decay_s:
        yield f"fading from power-on with {t.decay_s:g} s"


def _memory(t: Term, unit: str) -> Iterator[str]:
    ways = {
        "lag": f"lagged by {t.lag_s:g} s",
        "difference": f"less itself lagged by {t.lag_s:g} s",
        "rate": f"its rate a second over {t.lag_s:g} s",
        "backlash": f"backlash of {t.width:g} {unit}".rstrip(),
        "play": f"where a play operator of width {t.width:g} {unit}".rstrip() + " stands",
        "peak": "the highest so far less itself",
    }
    for way in (t.lag_mode, t.memory):
        if way != "none":
            yield ways[way]


def _numbers(slot: Slot) -> Iterator[str]:
    t = slot.term
    yield "dps per unit, x y z: " + "  ".join(f"{c:.6g}" for c in slot.coefficient_dps)
    if t.source != "one":
        yield f"held outside {t.lo:g}..{t.hi:g} {unit_of(t.source)}".rstrip()
    if t.second:
        yield f"held outside {t.second_lo:g}..{t.second_hi:g} {unit_of(t.second)}".rstrip()
    if slot.term.table:
        yield "table: " + " ".join(f"{v:g}" for v in slot.term.table)


def differences(one: Model, other: Model) -> list[str]:
    """What differs between two models, a line each; none where their model.bin are the same."""
    found = _fields("scales", vars(one.scales), vars(other.scales))
    found += _fields("binding", vars(one.binding), vars(other.binding))
    found += _fields("", {"tick_us": one.tick_us}, {"tick_us": other.tick_us})
    found += _fields("", {"inputs": one.inputs}, {"inputs": other.inputs})
    for i in range(max(len(one.slots), len(other.slots))):
        where = f"slot {i + 1}"
        if i >= len(one.slots):
            found.append(f"{where}: only in the second: {basis_in_words(other.slots[i])}")
        elif i >= len(other.slots):
            found.append(f"{where}: only in the first: {basis_in_words(one.slots[i])}")
        else:
            found += _fields(where, _flat(one.slots[i]), _flat(other.slots[i]))
    return found


def _flat(slot: Slot) -> dict[str, object]:
    values = {**vars(slot), **vars(slot.term)}
    values.pop("term")
    return values


def _fields(where: str, one: dict[str, object], other: dict[str, object]) -> list[str]:
    return [
        f"{where}{': ' if where else ''}{name}: {one[name]} and {other[name]}"
        for name in one
        if one[name] != other[name] and name != "more"
    ]
