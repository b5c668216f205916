"""A model in words: what `zerorate model show` prints, its matrix as other programs take it."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from .binary import encoded
from .model import RATES, Model, Slot, is_channel
from .term import Term

#: Flight controllers that have no such parameter, and what they do with a gyroscope's readings.
_WITHOUT = (
    "Betaflight, iNav: no setting takes it. They subtract gyroZero (iNav: gyro_zero_x, _y, _z) "
    "and rotate by align_* and no more.",
    "ArduPilot: no parameter takes it. It subtracts INS_GYROFFS_X, _Y, _Z and rotates by "
    "AHRS_ORIENTATION and no more.",
)


def rate_matrix(model: Model) -> np.ndarray | None:
    """(3, 3) C of `corrected = C measured`, what the rate slots do; None without such slots."""
    found = np.zeros((3, 3))
    for slot in model.slots:
        if slot.term.source in RATES and _is_plain(slot.term):
            found[:, RATES.index(slot.term.source)] += slot.coefficient_dps
    return np.eye(3) - found if found.any() else None


def _is_plain(term: Term) -> bool:
    return term == replace(Term(term.source, term.lo, term.hi), centre=term.centre)


def matrix_in_words(model: Model) -> list[str]:
    """Lines to copy: the matrix itself, and what takes it in other programs; none without one."""
    matrix = rate_matrix(model)
    if matrix is None:
        return []
    sensitivity = np.diag(matrix)
    # FusionModelInertial: misalignment (sensitivity * (measured - offset))
    misalignment = matrix / sensitivity
    # kalibr's scale-misalignment model: measured = M C_gyro_i true + bias, M lower triangular
    lower, rotation = _lower_and_rotation(np.linalg.inv(matrix))
    return [
        "corrected rate = matrix x (measured rate - bias), no unit:",
        *_rows(matrix),
        "x-io Fusion: FusionModelInertial, offset is the bias:",
        "  misalignment:",
        *_rows(misalignment, "    "),
        f"  sensitivity: {_written(sensitivity)}",
        "kalibr, imu.yaml, model scale-misalignment:",
        *_yaml("gyroscopes", {"M": lower, "C_gyro_i": rotation}),
        # OpenVINS inverts Tw and transposes R_IMUtoGYRO; its model "kalibr" has Tw lower triangular
        "OpenVINS (ROS 1 and 2), kalibr_imu_chain.yaml, model kalibr:",
        *_yaml("imu0", {"Tw": lower, "R_IMUtoGYRO": rotation}),
        *_WITHOUT,
    ]


def _lower_and_rotation(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lower triangular with a positive diagonal, and a rotation, whose product is the matrix."""
    from scipy.linalg import rq  # which recording and flashing do without

    upper, turn = rq(matrix[::-1, ::-1])
    lower, rotation = upper[::-1, ::-1], turn[::-1, ::-1]
    signs = np.sign(np.diag(lower))
    return lower * signs, rotation * signs[:, None]


def _yaml(heading: str, matrices: dict[str, np.ndarray]) -> list[str]:
    parts = [[f"    {name}:", *_rows(m, "    - ", yaml=True)] for name, m in matrices.items()]
    return [f"  {heading}:", *(line for part in parts for line in part)]


def _rows(matrix: np.ndarray, before: str = "  ", yaml: bool = False) -> list[str]:
    return [before + (f"[{_written(r, ', ')}]" if yaml else _written(r)) for r in matrix]


def _written(values: np.ndarray, between: str = "  ") -> str:
    return between.join(f"{v + 0.0:.6f}" for v in values)


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
    found = _fields("scales: ", vars(one.scales), vars(other.scales))
    found += _fields("binding: ", vars(one.binding), vars(other.binding))
    found += _fields("", *({n: getattr(m, n) for n in ("tick_us", "inputs")} for m in (one, other)))
    for i in range(max(len(one.slots), len(other.slots))):
        where = f"slot {i + 1}: "
        if i >= len(one.slots):
            found.append(f"{where}only in the second: {basis_in_words(other.slots[i])}")
        elif i >= len(other.slots):
            found.append(f"{where}only in the first: {basis_in_words(one.slots[i])}")
        else:
            found += _fields(where, _flat(one.slots[i]), _flat(other.slots[i]))
    return found


def _flat(slot: Slot) -> dict[str, object]:
    return {n: of for n, of in {**vars(slot), **vars(slot.term)}.items() if n != "term"}


def _fields(where: str, one: dict[str, object], other: dict[str, object]) -> list[str]:
    return [
        f"{where}{name}: {one[name]} and {other[name]}"
        for name in one
        if one[name] != other[name] and name != "more"
    ]
