"""Would a device take this model? Asked of the firmware's own reader."""

from os import PathLike
from pathlib import Path

from zerorate import Sensor
from zerorate.effects.model_file import LOADED, REASONS
from zerorate.model import EffectModel

from ..errors import BadModel
from ..recordings import Scales
from .binary import encoded
from .files import read_model
from .model import Binding, Model
from .model_in_words import differences

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
