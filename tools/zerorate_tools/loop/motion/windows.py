"""Windows of a recording in motion, each a measurement of the rate error by gravity.

The rates are integrated over a window to R(t), body to the window's first frame. Without errors
`R a` is gravity plus the hand's acceleration. An error turns all of it by theta(t), linear in the
errors. Cosines and sines under a Hann taper turn each window into rows. The taper and its slope
end at zero, so a slow row sees only the hand's position, which is bounded: there is little noise.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from os import PathLike

import numpy as np
from scipy.signal import welch

from ...recordings import open_recording
from ...recordings.recording import ACCEL, GYRO, TIME
from ...simulate.attitude import IDENTITY, integrate, into_body
from ..read.saturation import saturated
from ..read.still import runs, still_ticks
from ..read.ticks import TICK_S, Ticks, read_ticks

#: Names of the columns: the matrix by rows, then what each recording has of its own.
MATRIX = 9
OWN = {"bias": 3, "drift": 3, "accel_bias": 3, "accel_shape": 5}
OWN |= {"delay": 1, "velocity": 3, "lever": 3}
_AT = np.cumsum([0, *OWN.values()])
BIAS, DRIFT, ACCEL_BIAS, ACCEL_SHAPE = (slice(a, b) for a, b in zip(_AT[:4], _AT[1:5]))
#: Standard deviations before a recording is seen: rad/s, rad/s a segment, g, share, s, m/s, m. A
#: part's zero-rate output and accelerometer by their data sheets, a chip's filters, a walk along an
#: axis of the body, an arm's length.
OWN_SIGMA = {
    **{"bias": np.radians(20.0), "drift": np.radians(0.001), "accel_bias": 0.05},
    **{"accel_shape": 0.02, "delay": 0.01, "velocity": 1.5, "lever": 0.3},
}
#: A device is in motion where its rates spread by this in a window.
LEAST_DPS = 5.0
#: Rows reach up to this frequency: above it a hand shakes as it turns, which looks like an error.
_MOST_HZ = 0.5
_COLUMNS_HZ = 10.0
#: Shares, of the mean square, of rates about other axes than the main one and of gravity beside its
#: mean direction, below which a device turns about one axis in one pose: a tenth of it, rms.
_PLANAR = 0.01
#: Columns are made in parts of this many, so that hours of samples need no more memory.
_CHUNK = 512
_G_MPS2 = 9.80665
_RAIL = 32767
#: The longest window; what moves for less shows nothing.
LONGEST_S = 40.0
#: Of a recording whose rates spread by less no window moves.
_WORTH_READING_DPS = 1.0
#: Times the usual between two samples from which on it is a gap, which no window spans.
_GAP = 5
#: Rests this long are a reading of the bias, with what it wanders meanwhile.
_REST_TICKS, REST_SIGMA = 10, np.radians(0.005)


@dataclass(frozen=True)
class Moving:
    """A recording as motion needs it.

    rate: (n, 3) rad/s less `offset` (3,), which is near the bias; accel: (n, 3) g; at_s: (n,) from
    the recording's middle; usable: (n,) bool, no rail; rests: (k, 4) s and rad/s less the offset.
    """

    name: str
    rate: np.ndarray
    accel: np.ndarray
    at_s: np.ndarray
    usable: np.ndarray
    offset: np.ndarray
    rests: np.ndarray

    @cached_property
    def dt_s(self) -> float:
        """Seconds between samples, gaps left out; a mean, as stamps are whole microseconds and a
        sample that is lost now and then is time all the same."""
        apart_s = np.diff(self.at_s)
        return float(apart_s[apart_s <= _GAP * np.median(apart_s)].mean())

    @property
    def planar(self) -> bool:
        """Whether it turns about one axis in one pose, as a robot on a floor. An acceleration that
        goes with such turns, as speed times rate does, is then no different from axes that are off.
        """
        n = max(1, round(1.0 / self.dt_s))
        accel, rate = (x[: len(x) // n * n].reshape(-1, n, 3) for x in (self.accel, self.rate))
        moves = np.degrees(np.sqrt((rate**2).sum(axis=2).mean(axis=1))) > LEAST_DPS
        poses = accel[moves].mean(axis=1)
        # an accelerometer that reads nothing has no pose
        poses = poses / np.maximum(np.linalg.norm(poses, axis=1, keepdims=True), 1e-9)
        return _beside_main(poses) < _PLANAR and _beside_main(rate[moves].reshape(-1, 3)) < _PLANAR

    def spans(self, seconds: float) -> list[slice]:
        """Windows of so many seconds, each a quarter on, that move, without gap or rail."""
        n = round(seconds / self.dt_s)
        spans = [slice(a, a + n) for a in range(0, len(self.rate) - n + 1, n // 4)] if n > 8 else []
        return [s for s in spans if self._moves(s, n)]

    def _moves(self, s: slice, n: int) -> bool:
        whole = abs(self.at_s[s][-1] - self.at_s[s][0] - (n - 1) * self.dt_s) < _GAP * self.dt_s
        spread = np.degrees(np.sqrt(self.rate[s].var(axis=0).sum()))
        return whole and spread > LEAST_DPS and bool(self.usable[s].all())


def _beside_main(vectors: np.ndarray) -> float:
    """Share of the mean square of vectors (n, 3) that lies across their main direction."""
    squares = np.linalg.eigvalsh(vectors.T @ vectors)
    return float(1.0 - squares[-1] / max(squares.sum(), 1e-300))


def moving_of(path: str | PathLike[str], ticks: Ticks | None = None) -> Moving | None:
    """A recording read for its motion; None where it has no accelerometer or never turns.

    Raises BadRecording.
    """
    opened = open_recording(path, keep_gaps=True)
    if opened.scales.accel_lsb_per_g is None or not set(ACCEL) <= set(opened.column_names):
        return None
    t_us, gyro, accel = _samples(opened)
    to_rad = np.radians(1.0) / opened.scales.gyro_lsb_per_dps
    rate = gyro * to_rad
    if len(t_us) < 16 or np.degrees(rate.std(axis=0).max()) < _WORTH_READING_DPS:
        return None
    rests = _rests(ticks or read_ticks(path, TICK_S))
    offset = np.median(rests[:, 1:] if len(rests) else rate, axis=0)
    at_s = (t_us - 0.5 * (t_us[0] + t_us[-1])) * 1e-6
    usable = (np.abs(np.hstack([gyro, accel])) < _RAIL).all(axis=1) & ~saturated(gyro)
    rests[:, 0] += (t_us[0] - 0.5 * (t_us[0] + t_us[-1])) * 1e-6
    rests[:, 1:] -= offset
    g = accel / opened.scales.accel_lsb_per_g
    return Moving(opened.name, rate - offset, g, at_s, usable, offset, rests)


def _rests(ticks: Ticks) -> np.ndarray:
    """(k, 4) s from the recording's start and mean rate in rad/s of its rests, ten ticks each."""
    still = runs(still_ticks(ticks))
    parts = [
        (a, min(a + _REST_TICKS, end))
        for first, end in still
        for a in range(first, end, _REST_TICKS)
    ]
    rows = [
        [0.5 * (a + b) * ticks.tick_s, *np.radians(ticks.rate[a:b].mean(axis=0))]
        for a, b in parts
        if b - a >= _REST_TICKS // 2
    ]
    return np.array(rows).reshape(-1, 4)


def _samples(opened):
    """Times in us, rates and accelerations in LSB."""
    rows = [
        (b[TIME], np.column_stack([b[n] for n in GYRO]), np.column_stack([b[n] for n in ACCEL]))
        for b in opened.batches(rows=1 << 18)
    ]
    return tuple(np.concatenate(part) for part in zip(*rows))


@dataclass(frozen=True)
class Columns:
    """A recording at about ten samples a second, in one frame that stands still.

    at: (m,) index of each one's first sample; seen: (m, 3) specific force, g; loud: (m, 3) of it,
    what is louder than rows; theta: (m, 3, r) what a unit of each rate error has turned that frame
    by; own: (m, 3, s) the attitude, and g that a unit of each error adds without gravity; step_s:
    seconds between them.
    """

    at: np.ndarray
    seen: np.ndarray
    loud: np.ndarray
    theta: np.ndarray
    own: np.ndarray
    step_s: float

    def of(self, span: slice) -> tuple[np.ndarray, np.ndarray]:
        """(k, 3) specific force less its mean and (k, 3, p + 3) what a unit of each error adds to
        it; the last three by a steady turn of the frame."""
        seen, theta, own = self.seen[span], self.theta[span], self.own[span]
        gravity, attitude = seen.mean(axis=0), own[..., :3]
        force = gravity + self.loud[span]
        turned = theta - theta[len(theta) // 2]
        turned[..., -1] = theta[..., -1]  # a delay turns at once
        steady = np.eye(3) * (np.arange(len(seen)) * self.step_s)[:, None, None]
        by_rate = -np.cross(turned, force[..., None], axis=1)
        by_turn = -np.cross(steady, gravity[None, :, None], axis=1)
        felt = np.einsum("mai,ma->mi", attitude, force)
        shape = np.einsum("mai,kij,mj->mak", attitude, _SHAPES, felt, optimize=True)
        parts = [by_rate[..., :-1], attitude, shape, by_rate[..., -1:], own[..., 3:], by_turn]
        return seen, np.concatenate(parts, axis=2)


def columns_of(moving: Moving, matrix, own) -> Columns:
    """What each error does to a recording, with the matrix and its own errors (18,) taken out.

    Titterton and Weston 2004, 12.3: an error of the rate e turns the frame by the integral of R e.
    """
    per = max(1, round(1.0 / (_COLUMNS_HZ * moving.dt_s)))
    chunk, whole = per * _CHUNK, len(moving.rate) // per * per
    attitude, theta, parts = IDENTITY, np.zeros((3, MATRIX + 6)), []
    starts = list(range(0, whole - 1, chunk))  # one sample alone has no slope: it joins the last
    for first, end in zip(starts, [*starts[1:], whole]):
        span = slice(first, end)
        attitude, steps, late, seen, added = _chunk_of(moving, span, per, attitude, matrix, own)
        ends = np.cumsum(steps[0], axis=0) + theta
        middle = ends - steps[0] + steps[1]
        theta = ends[-1]
        parts.append((seen, np.concatenate([middle, late], axis=2), added))
    seen, theta, own = (np.concatenate(p) for p in zip(*parts))
    step_s = per * moving.dt_s
    return Columns(np.arange(len(seen)) * per, seen, _loud(seen, step_s), theta, own, step_s)


def _loud(seen: np.ndarray, step_s: float) -> np.ndarray:
    """(m, 3) the pushes that show when they are turned: those louder than what rows hear.

    Even noise is as even in a frame that turns, so it says nothing of the turn. A push of power S
    among noise of power N in the rows says (1 - N / S) of what it would without.
    """
    hz, power = welch(seen, 1 / step_s, nperseg=min(round(LONGEST_S / step_s), len(seen)), axis=0)
    power = power.mean(axis=1)
    rows = power[2:][hz[2:] <= _MOST_HZ].max(initial=0.0)
    gain = np.clip(1.0 - rows / np.maximum(power, 1e-300), 0.0, 1.0) * (hz > _MOST_HZ)
    spectrum = np.fft.rfft(seen, axis=0)
    at = np.fft.rfftfreq(len(seen), step_s)
    return np.fft.irfft(spectrum * np.interp(at, hz, gain)[:, None], len(seen), axis=0)


def _chunk_of(moving, span, per, attitude, matrix, own):
    """The attitude after a chunk; of each step the turns until its end and their mean within it,
    what a delay adds, the specific force, and columns of what is no rate."""
    dt_s, measured, accel = moving.dt_s, moving.rate[span], moving.accel[span]
    at_s = moving.at_s[span, None]
    rate = measured - measured @ matrix.T - own[BIAS] - at_s * own[DRIFT]
    shape = np.tensordot(own[ACCEL_SHAPE], _SHAPES, 1)
    accel = accel - own[ACCEL_BIAS] - accel @ shape
    attitudes = integrate(np.degrees(rate), dt_s, attitude)
    still = np.stack([into_body(np.vstack([attitude, attitudes]), e) for e in np.eye(3)], axis=1)
    meanwhile, still = 0.5 * (still[:-1] + still[1:]), still[1:]
    until_end, mean_within = np.ones(per), 1.0 - np.arange(per) / per
    one = np.ones_like(at_s)
    by = np.hstack([measured, one, at_s]).reshape(-1, per, 5)
    rated = [by * w[:, None] for w in (until_end, mean_within)]
    steps = [-dt_s * _by_rate(_summed(meanwhile, x)) for x in rated]
    sums = _summed(still, np.hstack([accel, rate, one]).reshape(-1, per, 7)) / per
    seen = np.einsum("maii->ma", sums[..., :3])
    late = np.einsum("maii->ma", sums[..., 3:6])
    first = np.diff(still, axis=0)
    first = np.concatenate([first[:1], first, first[-1:]])
    lever = (first[per::per] - first[:-per:per]) / (per * dt_s**2 * _G_MPS2)
    velocity = np.add.reduceat(first[1:], np.arange(0, len(still), per)) / (per * dt_s * _G_MPS2)
    own = np.concatenate([sums[..., 6], velocity, lever], axis=2)
    return attitudes[-1], steps, late[..., None], seen, own


def _summed(still: np.ndarray, by: np.ndarray) -> np.ndarray:
    """(m, 3, 3, k) sums over each step of attitudes (n, 3, 3) times each of by (m, per, k)."""
    m, per, k = by.shape
    return (still.reshape(m, per, 9).transpose(0, 2, 1) @ by).reshape(m, 3, 3, k)


def _by_rate(sums: np.ndarray) -> np.ndarray:
    """(m, 3, 15) from (m, 3, 3, 5): of the rates, of one and of time, times each axis."""
    turned = sums[..., :3].reshape(-1, 3, MATRIX)
    return np.concatenate([turned, sums[..., 3], sums[..., 4]], axis=2)


def _shapes():
    """(5, 3, 3) scales and cross-axis of an accelerometer, without its scale common to the axes:
    that is gravity's own size."""
    shapes = np.zeros((5, 3, 3))
    shapes[0], shapes[1] = np.diag([1.0, -1.0, 0.0]), np.diag([1.0, 1.0, -2.0]) / np.sqrt(3)
    for k, (i, j) in enumerate(((0, 1), (0, 2), (1, 2)), start=2):
        shapes[k, i, j] = shapes[k, j, i] = 1.0
    return shapes


_SHAPES = _shapes()


def tapers(n: int, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """(q, n) rows, each without what is constant, and (q,) the number of their frequency."""
    at = (np.arange(n) + 0.5) / n
    hann = np.sin(np.pi * at) ** 2
    waves = np.arange(1, int(_MOST_HZ * seconds) + 1)[:, None]
    cosines, sines = np.cos(2 * np.pi * waves * at), np.sin(2 * np.pi * waves * at)
    cosines[0] += 0.5  # the one that the taper does not make orthogonal to a constant
    rows = np.stack([cosines, sines], axis=1).reshape(-1, n) * hann
    return rows * np.sqrt(2.0 / (0.375 * n)), np.repeat(waves.ravel() - 1, 2)


def rows_of(moving: Moving, seconds: float, matrix, own) -> Iterator:
    """(q, 3) and (q, 3, p + 3) of each window, and (9, 9) mean square of its heading by entries."""
    spans = moving.spans(seconds)
    if not spans:
        return
    columns = columns_of(moving, matrix, own)
    long = int(seconds / columns.step_s)
    rows, _ = tapers(long, seconds)
    for span in spans:
        first = int(np.searchsorted(columns.at, span.start))
        seen, of = columns.of(slice(first, first + long))
        if len(seen) == long:
            up = seen.mean(axis=0) / np.linalg.norm(seen.mean(axis=0))
            theta = columns.theta[first : first + long, :, :MATRIX]
            heading = np.einsum("kir,i->kr", theta - theta[0], up)
            yield rows @ seen, np.tensordot(rows, of, 1), heading.T @ heading / long
