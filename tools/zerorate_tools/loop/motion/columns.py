"""What each error does to a recording in motion: it turns the frame that the rates carry along.

The rates are integrated to R(t), body to a frame that stands still. An error turns that frame by
theta(t). An attitude that is given shows theta itself. Without one gravity shows it: without errors
`R a` is gravity plus the hand's acceleration, and an error turns all of it.
"""

from dataclasses import dataclass

import numpy as np
from scipy.signal import welch
from scipy.spatial.transform import Rotation

from ...simulate.attitude import IDENTITY, integrate, into_body, multiply, rotation
from .moving import Moving

#: Names of the columns: the matrix by rows, then what each recording has of its own.
MATRIX = 9
OWN = {"bias": 3, "drift": 3, "accel_bias": 3, "accel_shape": 5}
OWN |= {"mounting": 3, "delay": 1, "velocity": 3, "lever": 3}
_AT = np.cumsum([0, *OWN.values()])
BIAS, DRIFT, ACCEL_BIAS, ACCEL_SHAPE, MOUNTING = (slice(a, b) for a, b in zip(_AT[:5], _AT[1:6]))
#: Columns of rates: the matrix, a bias and its drift; of what is neither a rate nor a delay.
_RATES = MATRIX + OWN["bias"] + OWN["drift"]
_NOT_RATES = sum(OWN.values()) - OWN["bias"] - OWN["drift"] - OWN["delay"]
_SHAPED = OWN["accel_bias"] + OWN["accel_shape"]
#: Standard deviations before a recording is seen: rad/s, rad/s a segment, g, share, s, m/s, m. A
#: part's zero-rate output and accelerometer by their data sheets, markers that are set by eye, a
#: chip's filters, a walk along an axis of the body, an arm's length.
OWN_SIGMA = {
    **{"bias": np.radians(20.0), "drift": np.radians(0.001), "accel_bias": 0.05},
    **{"accel_shape": 0.02, "mounting": 0.3, "delay": 0.01, "velocity": 1.5, "lever": 0.3},
}
#: Rows reach up to this frequency: above it a hand shakes as it turns, which looks like an error.
MOST_HZ = 0.5
_COLUMNS_HZ = 10.0
#: Columns are made in parts of this many, so that hours of samples need no more memory.
_CHUNK = 512
_G_MPS2 = 9.80665
#: The longest window; what moves for less shows nothing.
LONGEST_S = 40.0


@dataclass(frozen=True)
class Columns:
    """A recording at about ten samples a second, in one frame that stands still.

    at: (m,) index of each one's first sample; seen: (m, 3) specific force, g; loud: (m, 3) of it,
    what is louder than rows; theta: (m, 3, r) what a unit of each rate error has turned that frame
    by; own: (m, 3, s) the attitude, and g that a unit of each error adds without gravity; off:
    (m, 4) turn from the frame of the attitude that is given to that frame; step_s: seconds between
    them; mounted: whether the attitude is of a body that is fixed to the sensor.
    """

    at: np.ndarray
    seen: np.ndarray
    loud: np.ndarray
    theta: np.ndarray
    own: np.ndarray
    off: np.ndarray | None
    step_s: float
    mounted: bool

    def of(self, steps: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(k, 3) specific force of steps (k,), or what the attitude given says that the frame has
        turned by in rad, and (k, 3, p + 3) what a unit of each error adds to it; the last three by
        a steady turn of the frame."""
        theta, own = self.theta[steps], self.own[steps]
        turned = theta - theta[len(theta) // 2]
        turned[..., -1] = theta[..., -1]  # a delay turns at once
        at_s = ((steps - steps[0]) * self.step_s)[:, None, None]
        if self.off is not None:
            other = np.zeros((len(steps), 3, _NOT_RATES))
            if self.mounted:
                other[..., _SHAPED : _SHAPED + 3] = own[len(own) // 2, :, :3] - own[..., :3]
            return _apart(self.off[steps]), _in_columns(-turned, other, -at_s * np.eye(3))
        seen, attitude = self.seen[steps], own[..., :3]
        gravity = seen.mean(axis=0)
        force = gravity + self.loud[steps]
        by_rate = _across(force, turned)
        by_turn = at_s * _across(gravity[None], np.eye(3)[None])
        felt = np.einsum("mai,ma->mi", attitude, force)
        shape = attitude @ np.tensordot(felt, _SHAPES, (1, 2)).transpose(0, 2, 1)
        shape = np.concatenate([shape, np.zeros((len(steps), 3, OWN["mounting"]))], axis=2)
        own = np.concatenate([attitude, shape, own[..., 3:]], axis=2)
        return seen, _in_columns(by_rate, own, by_turn)


def _across(force: np.ndarray, turned: np.ndarray) -> np.ndarray:
    """(k, 3, r) products of (k, 3) with each column of (k, 3, r), without np.cross's axes."""
    (x, y, z), (u, v, w) = force.T[..., None], turned.transpose(1, 0, 2)
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=1)


def _in_columns(by_rate: np.ndarray, own: np.ndarray, by_turn: np.ndarray) -> np.ndarray:
    """All columns in the order of OWN."""
    late = _SHAPED + OWN["mounting"]
    parts = [by_rate[..., :-1], own[..., :late], by_rate[..., -1:], own[..., late:], by_turn]
    return np.concatenate(parts, axis=2)


def _apart(off: np.ndarray) -> np.ndarray:
    """(k, 3) rad from the middle one of turns (k, 4), NaN where they are not known."""
    middle = off[len(off) // 2] * [1.0, -1.0, -1.0, -1.0]
    turned = multiply(off, middle)[:, [1, 2, 3, 0]]
    if not np.isfinite(turned).all():
        return np.full((len(off), 3), np.nan)
    return Rotation.from_quat(turned).as_rotvec()


def columns_of(moving: Moving, matrix: np.ndarray, own: np.ndarray) -> Columns:
    """What each error does to a recording, with the matrix and its own errors (24,) taken out.

    Titterton and Weston 2004, 12.3: an error of the rate e turns the frame by the integral of R e.
    """
    per = max(1, round(1.0 / (_COLUMNS_HZ * moving.dt_s)))
    chunk, whole = per * _CHUNK, len(moving.rate) // per * per
    attitude, turned, offs = IDENTITY, np.zeros((3, _RATES)), []
    of_each = (3,), (3, _RATES + OWN["delay"]), (3, 3 + OWN["velocity"] + OWN["lever"])
    seen, theta, added = (np.empty((whole // per, *shape)) for shape in of_each)
    back = rotation(-np.degrees(own[MOUNTING]))
    starts = list(range(0, whole - 1, chunk))  # one sample alone has no slope: it joins the last
    for first, end in zip(starts, [*starts[1:], whole]):
        span, part = slice(first, end), slice(first // per, end // per)
        attitudes, steps, late, *rest = _chunk_of(moving, span, per, attitude, matrix, own)
        attitude = attitudes[-1]
        if moving.given is not None:
            offs.append(_off(multiply(moving.given[span], back), attitudes, per))
        ends = np.cumsum(steps[0], axis=0) + turned
        middle = ends - steps[0] + steps[1]
        turned = ends[-1]
        theta[part] = np.concatenate([middle, late], axis=2)
        seen[part], added[part] = rest
    step_s = per * moving.dt_s
    off = _bridged(np.concatenate(offs), step_s) if offs else None
    at, loud = np.arange(len(seen)) * per, _loud(seen, step_s)
    return Columns(at, seen, loud, theta, added, off, step_s, moving.mounted)


def _loud(seen: np.ndarray, step_s: float) -> np.ndarray:
    """(m, 3) the pushes that show when they are turned: those louder than what rows hear.

    Even noise is as even in a frame that turns, so it says nothing of the turn. A push of power S
    among noise of power N in the rows says (1 - N / S) of what it would without.
    """
    hz, power = welch(seen, 1 / step_s, nperseg=min(round(LONGEST_S / step_s), len(seen)), axis=0)
    power = power.mean(axis=1)
    rows = power[2:][hz[2:] <= MOST_HZ].max(initial=0.0)
    gain = np.clip(1.0 - rows / np.maximum(power, 1e-300), 0.0, 1.0) * (hz > MOST_HZ)
    spectrum = np.fft.rfft(seen, axis=0)
    at = np.fft.rfftfreq(len(seen), step_s)
    return np.fft.irfft(spectrum * np.interp(at, hz, gain)[:, None], len(seen), axis=0)


def _chunk_of(
    moving: Moving, span: slice, per: int, attitude: np.ndarray, matrix: np.ndarray, own: np.ndarray
) -> tuple[np.ndarray, list[np.ndarray], np.ndarray, np.ndarray, np.ndarray]:
    """The attitudes of a chunk; of each step the turns until its end and their mean within it,
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
    moved = np.append(~moving.still[span], ~moving.still[span][-1:])[::per, None, None]
    ahead = moved * np.vstack([still[::per], still[-1:] + first[-1:]])  # at rest there is no speed
    velocity = np.diff(ahead, axis=0) / (per * dt_s * _G_MPS2)
    own = np.concatenate([sums[..., 6], velocity, lever], axis=2)
    return attitudes, steps, late[..., None], seen, own


def _off(given: np.ndarray, attitudes: np.ndarray, per: int) -> np.ndarray:
    """(m, 4) mean turn, over each step, from the frame of the attitude given to the integrated one;
    NaN where it was not seen."""
    off = multiply(attitudes, given * [1.0, -1.0, -1.0, -1.0])
    seen = np.isfinite(off).all(axis=1)
    off[~seen] = 0.0
    off *= np.where(off @ off[seen.argmax()] < 0, -1.0, 1.0)[:, None]
    total = off.reshape(-1, per, 4).sum(axis=1)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.divide(total, length, out=np.full_like(total, np.nan), where=length > 0)


def _bridged(off: np.ndarray, step_s: float) -> np.ndarray:
    """Turns (m, 4) across what was not seen for less than half a wave of the quickest row: there
    they go on evenly, as errors of rates do in the meantime."""
    seen = np.isfinite(off).all(axis=1)
    at, gone = np.flatnonzero(seen), np.flatnonzero(~seen)
    after = np.searchsorted(at, gone)
    inside = (after > 0) & (after < len(at))
    gone, first, last = gone[inside], at[after[inside] - 1], at[after[inside]]
    short = (last - first) * step_s < 0.5 / MOST_HZ
    gone, first, last = gone[short], first[short], last[short]
    sign = np.where((off[first] * off[last]).sum(axis=1) < 0, -1.0, 1.0)[:, None]
    share = ((gone - first) / (last - first))[:, None]
    mean = (1.0 - share) * off[first] + share * sign * off[last]
    out = off.copy()
    out[gone] = mean / np.linalg.norm(mean, axis=1, keepdims=True)
    return out


def _summed(still: np.ndarray, by: np.ndarray) -> np.ndarray:
    """(m, 3, 3, k) sums over each step of attitudes (n, 3, 3) times each of by (m, per, k)."""
    m, per, k = by.shape
    return (still.reshape(m, per, 9).transpose(0, 2, 1) @ by).reshape(m, 3, 3, k)


def _by_rate(sums: np.ndarray) -> np.ndarray:
    """(m, 3, 15) from (m, 3, 3, 5): of the rates, of one and of time, times each axis."""
    turned = sums[..., :3].reshape(-1, 3, MATRIX)
    return np.concatenate([turned, sums[..., 3], sums[..., 4]], axis=2)


def _shapes() -> np.ndarray:
    """(5, 3, 3) scales and cross-axis of an accelerometer, without its scale common to the axes:
    that is gravity's own size."""
    shapes = np.zeros((5, 3, 3))
    shapes[0], shapes[1] = np.diag([1.0, -1.0, 0.0]), np.diag([1.0, 1.0, -2.0]) / np.sqrt(3)
    for k, (i, j) in enumerate(((0, 1), (0, 2), (1, 2)), start=2):
        shapes[k, i, j] = shapes[k, j, i] = 1.0
    return shapes


_SHAPES = _shapes()
