"""An emulated chip in a simulated hand: `zerorate record fake:` needs no hardware, and no time."""

from collections.abc import Callable

import numpy as np
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050, Physical

from ..recordings import Recording
from ..recordings.recording import ACCEL, GYRO
from ..simulate import simulate


def in_hand() -> tuple[FakeI2C, FakeClock]:
    """The bus of a chip that feels what the bundled scenario says, and the clock of both."""
    recording, _ = simulate("in-hand")
    scales = recording.scales
    assert scales.accel_lsb_per_g is not None, "a hand is felt"
    felt = Physical(
        _over_time(recording, GYRO, scales.gyro_lsb_per_dps),
        _over_time(recording, ACCEL, scales.accel_lsb_per_g),
        noise=0,
    )
    clock = FakeClock()
    chip = FakeMPU6050(felt)
    clock.devices.append(chip)
    return FakeI2C(chip, clock=clock), clock


def _over_time(
    recording: Recording, names: tuple[str, ...], lsb: float
) -> Callable[[float], list[float]]:
    values = np.column_stack([recording.columns[name] for name in names]) / lsb
    last, hz = len(values) - 1, recording.scales.odr_hz
    return lambda seconds: values[min(int(seconds * hz + 0.5), last)].tolist()
