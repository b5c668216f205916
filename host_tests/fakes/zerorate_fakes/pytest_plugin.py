"""Fixtures and marks for a test suite of your own; pytest finds them once zerorate is installed.

imu_chip, imu_bus, smbus and busio_i2c are one chip on one bus, seen from four sides.
@pytest.mark.imu(part=..., source=..., **physical) says which chip and what it feels;
@pytest.mark.bus_fault(kind, times=..., skip=...) breaks the bus from the first transfer on.
"""

import sys
import types
from typing import Any

import pytest

from . import FakeI2C, FakeMPU6050, Physical
from .circuitpython import CircuitPythonI2C
from .smbus import SMBus

_CHIP_WORDS = ("part", "who_am_i", "source")
_FELT = ("gyro_dps", "accel_g", "temp_degc", "noise", "seed")


def pytest_configure(config: pytest.Config) -> None:
    """Make the marks known."""
    config.addinivalue_line(
        "markers",
        "imu(part='MPU-6050', source=None, who_am_i=None, gyro_dps=(0, 0, 0), accel_g=(0, 0, 1), "
        "temp_degc=25, noise=1, seed=1): the chip that imu_chip gives, and what it feels",
    )
    config.addinivalue_line(
        "markers",
        "bus_fault(kind, times=1, skip=0, at_byte=7): the fault of imu_bus, see FakeI2C.fault",
    )


@pytest.fixture
def imu_chip(request: pytest.FixtureRequest) -> FakeMPU6050:
    """A chip just powered that lies still; `mark.imu` says otherwise."""
    mark = request.node.get_closest_marker("imu")
    return chip_as_marked(*mark.args, **mark.kwargs) if mark else chip_as_marked()


def chip_as_marked(*unnamed: Any, **words: Any) -> FakeMPU6050:
    """The chip of a mark with these words. Raises ValueError."""
    if unnamed:
        raise ValueError(f"the mark imu takes names, as imu(gyro_dps=(1, 2, 3)), not {unnamed}")
    unknown = [name for name in words if name not in _CHIP_WORDS + _FELT]
    if unknown:
        known = ", ".join(_CHIP_WORDS + _FELT)
        raise ValueError(f"the mark imu takes {known}, not {', '.join(unknown)}")
    felt = {name: words[name] for name in _FELT if name in words}
    if "source" in words and felt:
        raise ValueError(f"the mark imu takes source or {', '.join(felt)}, not both")
    chip = {name: words[name] for name in _CHIP_WORDS if name in words}
    return FakeMPU6050(**{"source": Physical(**felt), **chip})


@pytest.fixture
def imu_bus(imu_chip: FakeMPU6050, request: pytest.FixtureRequest) -> FakeI2C:
    """machine.I2C with imu_chip at 0x68."""
    bus = FakeI2C(imu_chip)
    mark = request.node.get_closest_marker("bus_fault")
    if mark:
        bus.fault(*mark.args, **mark.kwargs)
    return bus


@pytest.fixture
def smbus(imu_bus: FakeI2C, monkeypatch: pytest.MonkeyPatch) -> SMBus:
    """smbus2.SMBus on imu_bus, which every SMBus that a program opens is on, too.

    `from smbus2 import SMBus` may come before or after: the class itself is patched.
    """
    opened = SMBus(imu_bus)
    module = types.ModuleType("smbus")
    module.SMBus = lambda *bus, **options: opened  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "smbus", module)
    try:
        import smbus2
    except ImportError:
        monkeypatch.setitem(sys.modules, "smbus2", module)
    else:
        _forward(smbus2.SMBus, opened, monkeypatch)
    return opened


def _forward(real: type, opened: SMBus, monkeypatch: pytest.MonkeyPatch) -> None:
    """Make every object of the real class do what the fake does, until the test ends."""

    def begin(self: Any, *bus: Any, **options: Any) -> None:
        self.fd, self.funcs = None, opened.funcs

    monkeypatch.setattr(real, "__init__", begin)
    pec = property(lambda self: opened.pec, lambda self, enable: opened.enable_pec(enable))
    monkeypatch.setattr(real, "pec", pec)
    for name in dir(SMBus):
        if not name.startswith("_"):
            monkeypatch.setattr(real, name, _forwarded(opened, name))


def _forwarded(opened: SMBus, name: str) -> Any:
    return lambda self, *words, **options: getattr(opened, name)(*words, **options)


@pytest.fixture
def busio_i2c(imu_bus: FakeI2C) -> CircuitPythonI2C:
    """CircuitPython's busio.I2C on imu_bus."""
    return CircuitPythonI2C(imu_bus)
