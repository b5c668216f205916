"""Where a fake chip's samples come from: raw words as recorded, or what the chip would feel."""

TYPE_CHECKING = False

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence
    from typing import Any

    Three = Sequence[float]
    Source = Iterable[Sequence[int]] | Sequence[int] | bytes | bytearray | memoryview

_WORDS = "seven integers of 16 bits: ax ay az temp gx gy gz, raw LSB"
# density of the MPU-6050's noise by its data sheet (PS-MPU-6000A-00 rev 3.4, section 6)
_GYRO_NOISE_DPS = 0.005
_ACCEL_NOISE_G = 0.0004


def _three(name, value):
    """The value of three axes, or a function of time."""
    if not callable(value) and (isinstance(value, (int, float)) or len(value) != 3):
        raise ValueError(f"{name} is {value}; give three values, one an axis")
    return value


class Physical:
    """What the chip feels: rates in dps, acceleration in g, its temperature in degC.

    Each is constant, or a function of the seconds since the first sample. The chip makes words of
    it as its registers say: range, saturation, and noise of the filter's bandwidth. noise: 1 is
    what the data sheet says, 0 is none; seed: of the noise. Raises ValueError.
    """

    def __init__(
        self,
        gyro_dps: "Three | Callable[[float], Three]" = (0, 0, 0),
        accel_g: "Three | Callable[[float], Three]" = (0, 0, 1),
        temp_degc: "float | Callable[[float], float]" = 25,
        noise: float = 1,
        seed: int = 1,
    ) -> None:
        self.gyro_dps = _three("gyro_dps", gyro_dps)
        self.accel_g = _three("accel_g", accel_g)
        self.temp_degc = temp_degc
        self.noise = noise
        self._random = seed & 0x7FFFFFFF or 1
        self._seconds = 0.0

    def words(self, period_us: int, bandwidth_hz: float, scales: "Sequence[float]") -> "list[int]":
        """The next sample, raw LSB: scales are LSB a g, LSB a degC, degC at 0, LSB a dps."""
        lsb_per_g, lsb_per_degc, offset_degc, lsb_per_dps = scales
        now = self._seconds
        self._seconds += period_us / 1000000
        root_hz = bandwidth_hz**0.5 * self.noise
        accel, gyro = self.accel_g, self.gyro_dps
        if callable(accel):
            accel = _three("accel_g", accel(now))
        if callable(gyro):
            gyro = _three("gyro_dps", gyro(now))
        degc = self.temp_degc(now) if callable(self.temp_degc) else self.temp_degc
        words = []
        for value in accel:
            words.append((value + self._normal() * _ACCEL_NOISE_G * root_hz) * lsb_per_g)
        words.append((degc - offset_degc) * lsb_per_degc)
        for value in gyro:
            words.append((value + self._normal() * _GYRO_NOISE_DPS * root_hz) * lsb_per_dps)
        return [round(word) for word in words]

    def _normal(self) -> float:
        """Nearly normal, of variance one: four uniform numbers of a 31-bit generator."""
        total = 0.0
        for _ in range(4):
            self._random = self._random * 48271 % 0x7FFFFFFF
            total += self._random / 0x7FFFFFFF - 0.5
        return total * 1.7320508


def samples_of(source: "Source | None") -> "Iterator[Sequence[int]]":
    """Iterator of 7 ints (ax ay az temp gx gy gz, raw LSB) over source.

    source is None (zeros for ever), bytes or bytearray of 14-byte big-endian frames as the chip's
    data registers hold them, a flat array of 7 ints a sample, or any iterable of samples. Raises
    ValueError for a source of another shape, of an iterable's sample when its turn comes.
    """
    if source is None:
        return _zeros()
    if isinstance(source, (bytes, bytearray, memoryview)):
        _require_whole(len(source), 14, "bytes")
        return _frames(source)
    if _is_flat(source):
        _require_whole(len(source), 7, "integers")  # type: ignore[arg-type]
        return _checked(_flat(source))  # type: ignore[arg-type]
    try:
        rows = iter(source)
    except TypeError:
        raise ValueError(f"the source is {source!r}, not samples, each of {_WORDS}") from None
    return _checked(rows)  # type: ignore[arg-type]


def _is_flat(source: "Any") -> bool:
    try:
        first = source[0]
    except (TypeError, IndexError):
        return False
    try:
        len(first)
    except TypeError:
        return True
    return False


def _require_whole(length: int, size: int, what: str) -> None:
    if length % size:
        text = "a source of {} {} is no whole number of samples of {}"
        raise ValueError(text.format(length, what, size))


def _checked(rows: "Iterable[Sequence[int]]") -> "Iterator[Sequence[int]]":
    number = 0
    for row in rows:
        try:
            words = [int(word) for word in row]  # of numpy, too, whose own would overflow
            right = len(words) == 7 and -32768 <= min(words) and max(words) <= 32767
            right = right and words == list(row)
        except (TypeError, ValueError):
            right = False
        if not right:
            text = "sample {} of the source is {}, not {}; for dps and g use Physical"
            raise ValueError(text.format(number, row, _WORDS))
        number += 1
        yield words


def _zeros() -> "Iterator[Sequence[int]]":
    while True:
        yield (0, 0, 0, 0, 0, 0, 0)


def _frames(block: "bytes | bytearray | memoryview") -> "Iterator[Sequence[int]]":
    for start in range(0, len(block), 14):
        sample = []
        for i in range(start, start + 14, 2):
            word = block[i] << 8 | block[i + 1]
            sample.append(word - ((word & 0x8000) << 1))
        yield sample


def _flat(block: "Sequence[int]") -> "Iterator[Sequence[int]]":
    for start in range(0, len(block), 7):
        yield block[start : start + 7]
