"""A model in its two files."""

from os import PathLike
from pathlib import Path

from zerorate import Sensor
from zerorate.effects.model_file import LOADED, REASONS
from zerorate.model import EffectModel
from zerorate_i2c.parts import part_by_name
from zerorate_i2c.settings import ACCEL_LSB_PER_G, GYRO_LSB_PER_DPS

from ..errors import BadModel
from ..recordings import Scales
from ..recordings.atomic import written_together
from ..recordings.drafts import settle
from .binary import decoded, encoded
from .model import Binding, CannotDeploy, Model
from .model_in_words import differences
from .text import from_json, to_json

_MOST_BYTES = 1 << 20


def read_model(path: str | PathLike[str]) -> Model:
    """The model in a model.bin or model.json, told apart by what is in it. Raises BadModel.

    One from model.json is as its integers hold it, as if it had been read from its model.bin.
    """
    path = Path(path)
    settle(path.parent)
    try:
        if path.exists() and not path.is_file():  # a device has no end, a pipe may have no writer
            raise BadModel(path, "is no file", do="name a model.bin or model.json")
        with open(path, "rb") as file:
            data = file.read(_MOST_BYTES + 1)
    except OSError as error:
        problem = "no such file" if not path.exists() else f"cannot be read: {error.strerror}"
        raise BadModel(path, problem, do="name a model.bin or model.json") from error
    if len(data) > _MOST_BYTES:
        raise BadModel(path, "too large for an effect model", do="name a model.bin or model.json")
    if data[:1] != b"{" and data.lstrip()[:1] != b"{":
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


KEY = "binding"
NAMES = ("chip_id", "gyro_range", "accel_range", "filter")


def binding_of(scales: Scales) -> Binding:
    """The binding that a recording's scales hold (`zerorate record` writes it); else what follows
    from the sensor's name and scales for a part of the MPU-6050 family; else nothing.
    """
    recorded = scales.more.get(KEY)
    if isinstance(recorded, dict):
        codes = {name: recorded.get(name) for name in NAMES}
        if all(c is None or (type(c) is int and 0 <= c < 255) for c in codes.values()):
            return Binding(**codes)
    try:
        chip_id = part_by_name(scales.sensor)[0]
    except ValueError:
        return Binding()
    return Binding(
        chip_id,
        _code(scales.gyro_lsb_per_dps, GYRO_LSB_PER_DPS),
        _code(scales.accel_lsb_per_g, ACCEL_LSB_PER_G),
    )


def _code(lsb: float | None, known: tuple[float, ...]) -> int | None:
    """The index of the range with that scale, within a thousandth."""
    near = [i for i, one in enumerate(known) if lsb and abs(lsb - one) <= 1e-3 * one]
    return near[0] if near else None


_ANY = 255


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
    own = model.binding
    theirs = device or Binding()
    codes = bytes(
        mine if mine is not None and asked is None else (_ANY if asked is None else asked)
        for mine, asked in (
            (own.chip_id, theirs.chip_id),
            (own.gyro_range, theirs.gyro_range),
            (own.accel_range, theirs.accel_range),
            (own.filter, theirs.filter),
        )
    )
    reason = EffectModel().load(encoded(model), sensor_for(scales or model.scales), codes)
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
