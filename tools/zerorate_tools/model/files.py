"""A model in its two files, model.json and model.bin, and whether a device takes it."""

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, fields
from os import PathLike
from pathlib import Path
from typing import Any

from zerorate import Sensor
from zerorate.effects.model_file import LOADED, REASONS
from zerorate.model import EffectModel

from ..bounds import bytes_of
from ..errors import BadModel
from ..recordings import Scales
from ..recordings.atomic import written_together
from ..recordings.drafts import settle
from .binary import ANY, codes_of, decoded, encoded
from .model import Binding, CannotDeploy, Input, Model, Slot
from .model_in_words import differences
from .term import Term

FORMAT = "zerorate-model"
_VERSION = 1


def to_json(model: Model) -> str:
    """The text of model.json, from which `from_json` makes the very same model."""
    scales = Scales(**{**vars(model.scales), "more": {}})
    values = {
        "format": FORMAT,
        "version": _VERSION,
        "scales": scales.to_json(),
        "binding": asdict(model.binding),
        "tick_us": model.tick_us,
        "inputs": [asdict(i) for i in model.inputs],
        "slots": [
            {"effect": s.effect, **s.term.to_dict(), "coefficient_dps": list(s.coefficient_dps)}
            for s in model.slots
        ],
    }
    return json.dumps(values, indent=2, allow_nan=False) + "\n"


def from_json(text: str | bytes, path: str | PathLike[str] = "model.json") -> Model:
    """The model that the text describes. Raises BadModel, which names `path` and the entry."""
    try:
        values = json.loads(text)
        json.dumps(values, ensure_ascii=False).encode()  # half a character in an escape is no text
    except (ValueError, RecursionError) as error:
        problem = f"is no JSON ({ascii(str(error))[1:-1]})"
        raise BadModel(path, problem, do="correct the text there") from error
    if not isinstance(values, dict) or values.get("format") != FORMAT:
        raise BadModel(path, "is no effect model", do="name a model.bin or model.json")
    if values.get("version") != _VERSION:
        problem = f"is of version {values.get('version')!r}; this tool reads {_VERSION}"
        raise BadModel(path, problem, do="write it again with this zerorate")
    entry = "scales"
    try:
        scales = _scales(values["scales"])
        entry = "binding"
        binding = Binding(**{k: _code(v) for k, v in values["binding"].items()})
        entry = "tick_us"
        tick_us = _whole(values["tick_us"])
        if not 10_000 <= tick_us < 1 << 29:
            raise ValueError(f"{tick_us} us; 10000 to {(1 << 29) - 1} are possible")
        entry = "inputs"
        inputs = tuple(_input(v) for v in values["inputs"])
        slots = []
        for number, slot in enumerate(values["slots"], 1):
            entry = f"slot {number}"
            slots.append(_slot(slot))
    except (TypeError, AttributeError) as error:  # a number where a list is, or the like
        raise BadModel(path, f"{entry} is not as `zerorate close` writes it") from error
    except (KeyError, ValueError, OverflowError) as error:
        what = f"lacks {error}" if isinstance(error, KeyError) else str(error)
        raise BadModel(path, f"{entry}: {what}", do="correct it") from error
    return Model(tuple(slots), scales, binding, tick_us, inputs)


def _scales(values: Mapping[str, Any]) -> Scales:
    names = [f.name for f in fields(Scales) if f.name not in ("sensor", "more")]
    numbers = {n: _number(values[n], n) for n in names if values.get(n) is not None}
    if min(v for n, v in numbers.items() if n != "temp_offset_degc") <= 0:
        raise ValueError("a scale is not above 0")
    return Scales(sensor=_string(values["sensor"], "sensor"), **numbers)  # type: ignore[arg-type]


def _input(values: Mapping[str, Any]) -> Input:
    shift, offset = _whole(values["shift"]), _whole(values["offset"])
    if not -8 <= shift <= 15 or abs(offset) >= 1 << 29:
        raise ValueError(f"shift {shift} or offset {offset} is out of range")
    return Input(_string(values["name"], "name"), values["of_the_sample"] is True, shift, offset)


_NUMBERS = ("centre", "delay_s", "lag_s", "width", "decay_s", "second_centre")
_LIMITS = ("lo", "hi", "second_lo", "second_hi")


def _slot(values: Mapping[str, Any]) -> Slot:
    term = {f.name: values[f.name] for f in fields(Term) if f.name in values}
    for name in term:
        optional = name in _LIMITS or name == "knot"
        if name in (*_NUMBERS, *_LIMITS, "knot") and not (optional and term[name] is None):
            term[name] = _number(term[name], name)
    if term.get("table"):
        term["table"] = tuple(_number(v, "table") for v in term["table"])
    _check_choices(term)
    coefficients = [_number(v, "coefficient_dps") for v in values["coefficient_dps"]]
    if len(coefficients) != 3:
        raise ValueError("coefficient_dps has three numbers")
    effect = _string(values.get("effect", ""), "effect")
    return Slot(Term.from_dict(term), (coefficients[0], coefficients[1], coefficients[2]), effect)


def _check_choices(term: Mapping[str, Any]) -> None:
    _string(term["source"], "source")
    if term.get("second") is not None:
        _string(term["second"], "second")
    for name, choices in (
        ("power", (1, 2, 3)),
        ("power_first", (False, True)),
        ("lag_mode", ("none", "lag", "difference", "rate")),
        ("memory", ("none", "backlash", "peak", "play")),
    ):
        if name in term and term[name] not in choices:
            raise ValueError(f"{name} is {term[name]!r}, none of {choices}")
    for name in ("delay_s", "lag_s", "width", "decay_s"):
        if term.get(name, 0.0) < 0:
            raise ValueError(f"{name} is negative")
    if term.get("lag_mode", "none") != "none" and not term.get("lag_s"):
        raise ValueError("a lag needs lag_s")


def _number(value: Any, name: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(f"{name} is {value!r}, no number")
    if not math.isfinite(value):
        raise ValueError(f"{name} is not finite")
    return float(value)


def _whole(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise ValueError(f"{value!r} is no whole number")
    return value


def _code(value: Any) -> int | None:
    if value is not None and not 0 <= _whole(value) < 255:
        raise ValueError(f"{value} is no byte below 255")
    return value


def _string(value: Any, name: str) -> str:
    if not isinstance(value, str):
        raise ValueError(f"{name} is {value!r}, no text")
    return value


def read_model(path: str | PathLike[str]) -> Model:
    """The model in a model.bin or model.json, told apart by what is in it. Raises BadModel.

    One from model.json is as its integers hold it, as if it had been read from its model.bin.
    """
    path = Path(path)
    settle(path.parent)
    data = bytes_of(path, "name a model.bin or model.json", BadModel)
    if not data.lstrip().startswith(b"{"):
        return decoded(data, path)
    model = from_json(data, path)
    try:
        return decoded(encoded(model), path)
    except CannotDeploy as error:
        raise BadModel(path, str(error), do="correct it") from error


def write_model(model: Model, folder: str | PathLike[str]) -> tuple[Path, Path]:
    """Write model.json and model.bin into the folder; return their paths. Raises ZerorateError."""
    data = encoded(model)
    with written_together(folder) as draft:
        (draft / "model.json").write_text(to_json(decoded(data)), encoding="utf-8")
        (draft / "model.bin").write_bytes(data)
    return Path(folder) / "model.json", Path(folder) / "model.bin"


def check_model(
    path: str | PathLike[str], *, device: Binding | None = None, scales: Scales | None = None
) -> Model:
    """The model in the file, if a device with that binding and those scales would load it.

    device: what is known of the device (None: nothing); scales: the device's, None for the
    model's own. Its twin beside it (model.json of model.bin), where there is one, must be the
    same. Raises BadModel, which names the reason.
    """
    path = Path(path)
    model = read_model(path)
    twin = path.with_suffix(".json" if path.suffix == ".bin" else ".bin")
    if twin != path and twin.is_file():
        differ = differences(model, read_model(twin))
        if differ:
            problem = f"is not the twin of {twin.name}: {differ[0]}"
            raise BadModel(path, problem, do="write both again")
    # of what a device does not say, it is taken to be as the model says
    known = zip(codes_of(device or Binding()), codes_of(model.binding))
    codes = bytes(mine if asked == ANY else asked for asked, mine in known)
    try:
        sensor = sensor_for(scales or model.scales)
    except ValueError as error:
        raise BadModel(path, f"no firmware has such scales: {error}", do=_ADVICE) from error
    reason = EffectModel().load(encoded(model), sensor, codes)
    if reason != LOADED:
        raise BadModel(path, f"refused by the firmware: {REASONS[reason]}", do=_ADVICE)
    return model


_ADVICE = "close the loop with recordings of this device and these settings"


def sensor_for(scales: Scales) -> Sensor:
    """The firmware's Sensor; absent channels have scale 0."""
    return Sensor(
        scales.odr_hz,
        scales.gyro_lsb_per_dps,
        scales.accel_lsb_per_g or 0.0,
        scales.temp_lsb_per_degc or 0.0,
        scales.temp_offset_degc or 0.0,
    )
