"""Emulated chips for `fake:`, at rest in this machine's time or in a simulated hand in no time."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050, Physical
from zerorate_i2c import clock
from zerorate_i2c.parts import part_by_id, part_by_name

if TYPE_CHECKING:
    from ..recordings import Recording

_BIAS_DPS = (0.31, -0.19, 0.08)


def fake_chip(felt: Physical, part: str | None = None) -> FakeMPU6050:
    """The part of that name, MPU-6050 by default. Raises ValueError for an unknown one."""
    # parts of one id are the same chip
    row = part_by_id(part_by_name(part or "MPU-6050")[0])
    return FakeMPU6050(felt, part=row[1])


class FakeBus(FakeI2C):
    """The bus of a chip with a bias, whose time is this machine's. Raises ValueError."""

    def __init__(self, address: int = 0x68, part: str | None = None) -> None:
        self.chip = fake_chip(Physical(gyro_dps=_BIAS_DPS), part)
        super().__init__({address: self.chip})
        self._last_us = clock.ticks_us()

    def _begin(self, wire_bytes: int) -> str | None:
        now_us = clock.ticks_us()
        self.chip.advance_us(clock.ticks_diff(now_us, self._last_us))
        self._last_us = now_us
        return super()._begin(wire_bytes)

    def close(self) -> None:
        """Nothing to close: the chip goes on."""


def in_hand(address: int = 0x68, part: str | None = None) -> tuple[FakeI2C, FakeClock, float]:
    """The bus of a chip that feels what the bundled scenario says, the clock of both, and for how
    many seconds it does.

    Raises ValueError for an unknown part.
    """
    from ..recordings.recording import ACCEL, GYRO  # a service that emulates a chip has no NumPy
    from ..simulate import simulate

    recording, _ = simulate("in-hand")
    scales = recording.scales
    assert scales.accel_lsb_per_g is not None, "a hand is felt"
    felt = Physical(
        _over_time(recording, GYRO, scales.gyro_lsb_per_dps),
        _over_time(recording, ACCEL, scales.accel_lsb_per_g),
        noise=0,
    )
    time = FakeClock()
    chip = fake_chip(felt, part)
    time.devices.append(chip)
    return FakeI2C({address: chip}, clock=time), time, float(recording.columns["t_us"][-1]) * 1e-6


def _over_time(
    recording: Recording, names: tuple[str, ...], lsb: float
) -> Callable[[float], list[float]]:
    import numpy as np

    values = np.column_stack([recording.columns[name] for name in names]) / lsb
    last, hz = len(values) - 1, recording.scales.odr_hz

    def felt(seconds: float) -> list[float]:
        # between two rows, too: a faster chip that felt one of them for long would be a frozen one
        row, share = divmod(min(seconds * hz, last), 1)
        before, after = values[int(row)], values[min(int(row) + 1, last)]
        return (before + share * (after - before)).tolist()

    return felt
