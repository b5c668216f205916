"""An emulated chip in a simulated hand: `zerorate record fake:` needs no hardware, and no time."""

from collections.abc import Callable

import numpy as np
from zerorate_fakes import FakeClock, FakeI2C, Physical

from ..recordings import Recording
from ..recordings.recording import ACCEL, GYRO, TIME
from ..simulate import simulate
from .fake_chip import fake_chip


def in_hand(address: int = 0x68, part: str | None = None) -> tuple[FakeI2C, FakeClock, float]:
    """The bus of a chip that feels what the bundled scenario says, the clock of both, and for how
    many seconds it does.

    Raises ValueError for an unknown part.
    """
    recording, _ = simulate("in-hand")
    scales = recording.scales
    assert scales.accel_lsb_per_g is not None, "a hand is felt"
    felt = Physical(
        _over_time(recording, GYRO, scales.gyro_lsb_per_dps),
        _over_time(recording, ACCEL, scales.accel_lsb_per_g),
        noise=0,
    )
    clock = FakeClock()
    chip = fake_chip(felt, part)
    clock.devices.append(chip)
    seconds = float(recording.columns[TIME][-1]) * 1e-6
    return FakeI2C({address: chip}, clock=clock), clock, seconds


def _over_time(
    recording: Recording, names: tuple[str, ...], lsb: float
) -> Callable[[float], list[float]]:
    values = np.column_stack([recording.columns[name] for name in names]) / lsb
    last, hz = len(values) - 1, recording.scales.odr_hz

    def felt(seconds: float) -> list[float]:
        # between two rows, too: a faster chip that felt one of them for long would be a frozen one
        row, share = divmod(min(seconds * hz, last), 1)
        before, after = values[int(row)], values[min(int(row) + 1, last)]
        return (before + share * (after - before)).tolist()

    return felt
