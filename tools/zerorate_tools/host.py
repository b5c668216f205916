"""The firmware for any IMU on a host: floats in the driver's own units, nothing else to install.

The kernels stay integers: readings are rounded to an LSB that the full scale gives, and the bias,
which they know to 1/256 of one, is taken off the reading as it came.
"""

import atexit
from array import array
from collections.abc import Sequence
from contextlib import suppress
from math import isfinite, pi
from os import PathLike, fspath, remove
from os.path import exists, getsize, isfile, realpath
from typing import IO

from zerorate import Corrector, Sensor
from zerorate.model import EffectModel
from zerorate.storage.learned_store import LearnedStore
from zerorate.storage.places import FileStorage

from .errors import InFile

_WORD = 32767
#: Of an LSB a degC; the words then hold -96 to 96 degC about 25.
_TEMP_LSB_PER_DEGC, _TEMP_OFFSET_DEGC = 340.0, 25.0
RATE_UNITS = {"dps": 1.0, "rad/s": 180 / pi}
ACCEL_UNITS = {"g": 1.0, "m/s2": 1 / 9.80665}
Three = Sequence[float]


class FloatCorrector:
    """Takes the bias off rates in dps or rad/s, learned from rests as on a board.

    odr_hz: how often samples come; full_scale_dps, full_scale_g: the sensor's ranges, which choose
    the LSB (see `said`); rate: "dps" or "rad/s"; accel: "g" or "m/s2"; model: a model.bin that
    `zerorate close` wrote, whose scales then choose the LSB; options: keywords of
    zerorate.Corrector. corrector is that one, to be saved and asked. Raises ValueError; BadModel.
    """

    def __init__(
        self,
        odr_hz: float,
        full_scale_dps: float = 2000.0,
        full_scale_g: float = 16.0,
        rate: str = "dps",
        accel: str = "g",
        model: str | PathLike[str] | None = None,
        **options: float,
    ) -> None:
        if rate not in RATE_UNITS or accel not in ACCEL_UNITS:
            units = f"rate is one of {list(RATE_UNITS)}, accel one of {list(ACCEL_UNITS)}"
            raise ValueError(f"{units}, not {rate} and {accel}")
        for name, most in (("full_scale_dps", full_scale_dps), ("full_scale_g", full_scale_g)):
            if not most > 0:
                raise ValueError(f"{name} must be above 0, not {most}")
        scales = [_WORD / full_scale_dps, _WORD / full_scale_g]
        temp = [_TEMP_LSB_PER_DEGC, _TEMP_OFFSET_DEGC]
        effects = None
        if model is not None:
            effects, scales, temp = _loaded(model, odr_hz, scales, temp)
        self.corrector = Corrector(Sensor(odr_hz, *scales, *temp), **options)
        if effects is not None:
            self.corrector.use_model(effects)
        self.refused = 0
        self._rate_lsb = scales[0] * RATE_UNITS[rate]
        self._accel_lsb = scales[1] * ACCEL_UNITS[accel]
        self._temp_lsb, self._temp_offset_degc = temp
        self._unit = rate
        self._dt_us = round(1e6 / odr_hz)
        self._sample = array("i", [0] * 7)

    @property
    def said(self) -> str:
        """The scale that was chosen, in words."""
        sensor = self.corrector.sensor
        return (
            f"1 LSB is {1 / self._rate_lsb:.3g} {self._unit} "
            f"({1 / sensor.gyro_lsb_per_dps:.3g} dps) and {1e3 / sensor.accel_lsb_per_g:.3g} mg"
        )

    def update(
        self, rate: Three, accel: Three, temp_degc: float = 25.0, dt_s: float | None = None
    ) -> tuple[float, float, float]:
        """Learn from a sample and return its rates without their bias, in their own unit.

        dt_s: since the sample before (default: as odr_hz says). A reading that is not finite comes
        back as it is and teaches nothing; `refused` counts these and what the guard refuses.
        """
        if not all(map(isfinite, (*rate, *accel, temp_degc, dt_s or 0.0))):
            self.refused += 1
            return rate[0], rate[1], rate[2]
        sample = self._sample
        for axis in range(3):
            sample[axis] = _word(accel[axis] * self._accel_lsb)
            sample[4 + axis] = _word(rate[axis] * self._rate_lsb)
        sample[3] = _word((temp_degc - self._temp_offset_degc) * self._temp_lsb)
        dt_us = self._dt_us if dt_s is None else round(dt_s * 1e6)
        if self.corrector.update(sample, dt_us):
            self.refused += 1
        x, y, z = (rate[axis] - self._bias(axis) for axis in range(3))
        return x, y, z

    def bias(self) -> tuple[float, float, float]:
        """What is subtracted now, in the unit of the rates."""
        return self._bias(0), self._bias(1), self._bias(2)

    def _bias(self, axis: int) -> float:
        return self.corrector.bias_lsb(axis) / self._rate_lsb


#: Files of stores by their real paths, open while this program runs: so no other has their locks.
_HELD: dict[str, IO[bytes] | None] = {}


def store_file(path: str | PathLike[str]) -> FileStorage:
    """The storage of a LearnedStore in a file, new or a store's own; InFile where it is another's.

    So it is where another program runs with it. A store is begun afresh where its two places are
    torn or rotten: it is known by the mark in either of them, by its size with both written, or by
    no bit that was ever written.
    """
    store = LearnedStore(None, b"", Corrector(Sensor(100.0, 131.0)))
    slot_bytes = store.state.slot_bytes
    data = b""
    if isfile(path):
        with open(path, "rb") as file:
            data = file.read(store.end + 1)
    marked = data[:3] == b"ZRS"[: len(data)] or data[slot_bytes : slot_bytes + 3] == b"ZRS"
    written = len(data) in (2 * slot_bytes, store.end)
    blank = len(data) <= store.end and not data.strip(b"\0\xff")
    if exists(path) and not (isfile(path) and (marked or written or blank)):
        raise InFile(path, "is no store of zerorate", do="name another file")
    if (place := realpath(path)) not in _HELD:
        _HELD[place] = _locked(path)
    return FileStorage(fspath(path))


def _locked(path: str | PathLike[str]) -> IO[bytes] | None:
    """The file, locked; None where it cannot be written, which is said when it is to be, and where
    there are no locks. It is gone at exit if nothing was written to it. Raises InFile."""
    try:
        import fcntl

        file = open(path, "ab")  # noqa: SIM115 (stays open)
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        problem, do = "another program keeps its state there", "end it, or name another file"
        raise InFile(path, problem, do=do) from error
    except (ImportError, OSError):
        return None
    atexit.register(_remove_if_empty, realpath(path))
    return file


def _remove_if_empty(path: str) -> None:
    with suppress(OSError):
        if getsize(path) == 0:
            remove(path)


def _loaded(
    path: str | PathLike[str], odr_hz: float, scales: list[float], temp: list[float]
) -> tuple[EffectModel, list[float], list[float]]:
    """The model in a file, and the scales of rate, acceleration and temperature that it has."""
    from .model.files import check_model  # its libraries are large

    own = check_model(path).scales
    scales = [own.gyro_lsb_per_dps, own.accel_lsb_per_g or scales[1]]
    if own.temp_lsb_per_degc:
        temp = [own.temp_lsb_per_degc, own.temp_offset_degc or 0.0]
    effects = EffectModel()
    effects.load_file(str(path), Sensor(odr_hz, *scales, *temp))
    return effects, scales, temp


def _word(value: float) -> int:
    return max(-_WORD - 1, min(_WORD, round(value)))
