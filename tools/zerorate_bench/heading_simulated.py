"""Scale factors, cross-axis terms and turned axes in simulated motion: found, and honest."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from zlib import crc32

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation
from zerorate_tools.loop.motion.by_windows import by_windows
from zerorate_tools.loop.motion.moving import moving_of
from zerorate_tools.recordings import Recording, Scales
from zerorate_tools.recordings.writing import write_recording
from zerorate_tools.simulate import attitude as quaternions
from zerorate_tools.simulate.device import counts
from zerorate_tools.simulate.motion import FACES, Bout, Start, rest, stride, vibration

from .tables import outcomes, table

Array = NDArray[np.float64]
_G_MPS2 = 9.80665
_EDGE_S = 1.0


# A kind of motion takes a `Start` and returns a `Bout`, whose push is specific force in the body,
# gravity's part left out. It starts and ends at rest. Every stretch is drawn anew.
def hand(start: Start) -> Bout:
    """A phone in the hand: 20 to 80 dps about each axis, the hand sways by 2 to 15 cm."""
    rate = _smooth(start, 0.3, 0.8) * start.rng.uniform(20, 80, 3)
    return Bout(rate, _push(start, rate, _smooth(start, 0.4, 1.5) * start.rng.uniform(0.02, 0.15)))


def walking(start: Start) -> Bout:
    """In a pocket: strides, corners every few seconds, 1 to 1.6 m/s along the path. The leg swings
    about one pose and pushes along the path, so that a walker's speed stays that of a walker."""
    leg = stride(start, dps=start.rng.uniform(60, 140), hz=start.rng.uniform(0.8, 1.1))
    swung = quaternions.rotation(np.cumsum(leg.rate_dps, axis=0) * start.dt_s)
    before = np.vstack([quaternions.IDENTITY, swung[:-1]]) * [1.0, -1.0, -1.0, -1.0]
    vector = quaternions.multiply(before, swung)[:, 1:]
    swing = np.degrees(2.0 * vector) / start.dt_s
    yaw = _smooth(start, 1.5, 4.0)[:, 0] * 20.0
    speed = start.rng.uniform(1.0, 1.6) * _edges(start)
    rate = swing + _upright(start, swing, yaw)
    pushed = quaternions.into_body(
        swung, np.asarray(leg.push_g)
    )  # from the path's frame, which turns by the yaw alone
    return Bout(rate, pushed + _along(start, rate, yaw, speed))


def drone(start: Start) -> Bout:
    """It tilts to accelerate, yaws, and shakes at each sample by 0.1 to 0.4 g."""
    where = _smooth(start, 1.5, 3.0) * start.rng.uniform(0.5, 3.0)
    thrust = _accelerated(where, start.dt_s)
    level = np.cross([0.0, 0.0, 1.0], thrust)
    rate = np.degrees(np.gradient(level, start.dt_s, axis=0))
    rate += _smooth(start, 0.2, 0.6) * [25.0, 25.0, 10.0]
    rate += _upright(start, rate, _smooth(start, 1.0, 3.0)[:, 2] * start.rng.uniform(20, 80))
    shaken = np.asarray(vibration(start, g=start.rng.uniform(0.1, 0.4)).push_g)
    return Bout(rate, _push(start, rate, where) + shaken)


def robot(start: Start) -> Bout:
    """On a floor: turns about the vertical only, 0.3 to 1 m/s, a rough floor of 20 mg."""
    yaw = _smooth(start, 0.5, 2.0)[:, 0] * start.rng.uniform(20, 90)
    rate = yaw[:, None] * start.up
    speed = start.rng.uniform(0.3, 1.0) * _edges(start)
    shaken = np.asarray(vibration(start, g=0.02).push_g)
    return Bout(rate, shaken + _along(start, rate, yaw, speed))


def headset(start: Start) -> Bout:
    """Looks about: most about the vertical, then up and down, least to the side; leans by 10 cm."""
    sizes = start.rng.uniform(0.6, 1.4, 3) * [12.0, 25.0, 50.0]
    rate = _smooth(start, 0.3, 1.2) * sizes
    return Bout(rate, _push(start, rate, _smooth(start, 0.8, 2.5) * start.rng.uniform(0.03, 0.1)))


def coherent(start: Start) -> Bout:
    """A hand that pushes each time it turns: one period of 2 to 10 s for both."""
    w = 2 * np.pi * start.t_s / start.rng.uniform(2.0, 10.0)
    phase = start.rng.uniform(0, 2 * np.pi, (2, 3))
    rate = np.sin(w[:, None] + phase[0]) * start.rng.uniform(20, 80, 3) * _edges(start)[:, None]
    where = np.sin(w[:, None] + phase[1]) * start.rng.uniform(0.02, 0.2, 3)
    return Bout(rate, _push(start, rate, where))


KINDS: dict[str, Callable[[Start], Bout]] = {
    f.__name__: f for f in (hand, walking, drone, robot, headset)
}


def _smooth(start: Start, least_s: float, most_s: float) -> Array:
    """(n, 3) random, of rms one and of a time drawn in between; nothing at both ends."""
    n, width = len(start.t_s), start.rng.uniform(least_s, most_s) / start.dt_s
    waves = gaussian_filter1d(start.rng.standard_normal((n, 3)), width, axis=0)
    return waves / np.maximum(waves.std(axis=0), 1e-12) * _edges(start)[:, None]


def _edges(start: Start) -> Array:
    at = np.minimum(start.t_s, start.t_s[-1] - start.t_s) / _EDGE_S
    return np.sin(np.pi / 2 * np.clip(at, 0.0, 1.0)) ** 2


def _accelerated(where_m: Array, dt_s: float) -> Array:
    """(n, 3) g of a place (n, 3)."""
    return np.gradient(np.gradient(where_m, dt_s, axis=0), dt_s, axis=0) / _G_MPS2


def _upright(start: Start, rate_dps: Array, yaw_dps: Array) -> Array:
    """(n, 3) turns about the vertical of a body that turns otherwise, too."""
    attitude = quaternions.integrate(rate_dps, start.dt_s, quaternions.facing(start.up))
    return yaw_dps[:, None] * quaternions.into_body(attitude, np.array([0.0, 0.0, 1.0]))


def _push(start: Start, rate_dps: Array, where_m: Array) -> Array:
    """(n, 3) g in the body of a place (n, 3) in the world."""
    attitude = quaternions.integrate(rate_dps, start.dt_s, quaternions.facing(start.up))
    return quaternions.into_body(
        attitude, _accelerated(where_m * _edges(start)[:, None], start.dt_s)
    )


def _along(start: Start, rate_dps: Array, yaw_dps: Array, speed_mps: Array) -> Array:
    """(n, 3) g in the body of a path whose direction turns by yaw: corners press outwards."""
    heading = np.radians(np.cumsum(yaw_dps) * start.dt_s)
    ahead = np.stack([np.cos(heading), np.sin(heading), 0.0 * heading], axis=1)
    speeding = np.gradient(ahead * speed_mps[:, None], start.dt_s, axis=0)
    attitude = quaternions.integrate(rate_dps, start.dt_s, quaternions.facing(start.up))
    return quaternions.into_body(attitude, speeding / _G_MPS2)


COHERENT = "coherent"
_WORLDS = {**KINDS, COHERENT: coherent}
_LSB, _LSB_PER_G, _RAIL = 16.4, 4096.0, 32767
#: Recordings of at most so many samples, for the bench's own time.
_MOST_SAMPLES = 60_000
_SIGMAS = 2.0
#: Samples of a piece in which heading is lost.
_PIECE = 6000
_UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Case:
    """A device: its kind of motion, its number, and whether its axes and scales are off."""

    kind: str
    number: int
    off: bool


def run(devices: int, processes: int, resume: Path | None) -> dict[str, Any]:
    """What was said of every case: `devices` of each kind with errors, of each without, and as
    many as all of these whose hand pushes as it turns. resume: as of `outcomes`."""
    cases = [Case(k, i, off) for off in (True, False) for k in KINDS for i in range(devices)]
    cases += [Case(COHERENT, i, False) for i in range(devices * len(KINDS))]
    return {"devices": devices, "rows": list(outcomes(outcome, cases, processes, resume))}


def outcome(case: Case) -> dict[str, Any]:
    """What one device's recording shows, beside the truth."""
    recording, truth, motion = simulated(case)
    with TemporaryDirectory() as scratch:
        path = Path(scratch) / "run.parquet"
        write_recording(recording, path)
        moving = moving_of(path)
        shown = None if moving is None else by_windows([moving], [])
    row: dict[str, Any] = {"kind": case.kind, "off": case.off, "found": False, "entries": []}
    if shown is None:
        return row
    deployed = shown.deployed if shown.found else np.zeros((3, 3))
    parts = zip(truth.ravel(), shown.matrix.ravel(), shown.deviation.ravel())
    entries = [[float(v) for v in part] for part in parts]
    before, after = (heading_lost_deg(m, motion) for m in (truth, truth - deployed))
    return {**row, "found": shown.found, "entries": entries, "before": before, "after": after}


def heading_lost_deg(matrix: Array, motion: Array) -> float:
    """Degrees RMS of heading lost within 6,000 samples; what only turns the frame loses none.

    motion: (m, 6) degrees turned in each sample and the vertical, both in the body.
    """
    turned = (motion[:, 3:] * (motion[:, :3] @ (matrix + matrix.T) / 2)).sum(axis=1)
    pieces = np.array_split(np.cumsum(turned), max(len(motion) // _PIECE, 1))
    return float(np.sqrt(np.mean([((m - m[0]) ** 2).mean() for m in pieces])))


def simulated(case: Case) -> tuple[Recording, Array, Array]:
    """A recording of 5 to 60 minutes, 0 to 90 % of them at rest, at 25 to 400 Hz; the matrix of
    `error = matrix reading`; (m, 6) what turned, and the vertical, a sample in motion."""
    rng = np.random.default_rng([case.number, crc32(case.kind.encode()), case.off])
    hz = float(rng.choice([25.0, 50.0, 100.0, 200.0, 400.0]))
    seconds = min(60 * np.exp(rng.uniform(np.log(5), np.log(60))), _MOST_SAMPLES / hz)
    return recorded(case, rng, hz, seconds, rng.uniform(0.0, 0.9))


def recorded(
    case: Case,
    rng: np.random.Generator,
    hz: float,
    seconds: float,
    resting: float,
    errors: Callable[[np.random.Generator], Array] | None = None,
) -> tuple[Recording, Array, Array]:
    """As `simulated`, for so many seconds of which a share rests; errors: draws the matrix."""
    parts = list(_stretches(case, rng, hz, seconds, resting))
    rate, force, up = (np.concatenate(part) for part in zip(*parts))
    gyro = np.eye(3) + ((errors or _errors)(rng) if case.off else 0.0)
    white = 0.004 * np.sqrt(hz), 0.0003 * np.sqrt(hz)
    turned = rate @ gyro.T + rng.normal(0, 0.5, 3) + rng.standard_normal(rate.shape) * white[0]
    accel = force @ (np.eye(3) + np.diag(rng.normal(0, 0.005, 3))).T
    accel = accel + rng.normal(0, 0.02, 3) + rng.standard_normal(rate.shape) * white[1]
    columns = {"t_us": np.rint(np.arange(len(rate)) * 1e6 / hz).astype(np.int64)}
    for letter, values in (("g", turned * _LSB), ("a", accel * _LSB_PER_G)):
        columns |= counts(letter, np.maximum(values, -_RAIL))
    recording = Recording(columns, Scales("MPU-6050", hz, _LSB, _LSB_PER_G, None, None), case.kind)
    motion = np.hstack([rate / hz, up])[rate.any(axis=1)]
    return recording, np.eye(3) - np.linalg.inv(gyro), motion


def _errors(rng: np.random.Generator) -> Array:
    """(3, 3) scale 0.3 to 2 %, cross-axis up to 1 %, axes turned by 0.3 to 5 degrees."""
    scale = np.diag(rng.choice([-1, 1], 3) * rng.uniform(0.003, 0.02, 3))
    cross = np.triu(rng.uniform(-0.01, 0.01, (3, 3)), 1)
    axis = rng.standard_normal(3)
    turn = axis / np.linalg.norm(axis) * np.radians(rng.uniform(0.3, 5.0))
    turned = Rotation.from_rotvec(turn).as_matrix()
    return (np.eye(3) + scale + cross + cross.T) @ turned - np.eye(3)


def felt(start: Start, bout: Bout) -> tuple[Array, ...]:
    """Of each sample, in the body: rates, specific force in g, the vertical; and the attitude."""
    attitude = quaternions.integrate(bout.rate_dps, start.dt_s, quaternions.facing(start.up))
    level = quaternions.into_body(attitude, _UP)
    return bout.rate_dps, level if bout.push_g is None else level + bout.push_g, level, attitude


def _stretches(
    case: Case, rng: np.random.Generator, hz: float, seconds: float, resting: float
) -> Iterator[tuple[Array, ...]]:
    """Rates, specific force and the vertical, in the body: motion of 20 to 120 s and rests in
    turn."""
    dt_s, at_s = 1 / hz, 0.0
    up = FACES[str(rng.choice(list(FACES)))] if case.kind in ("hand", "walking") else _UP
    attitude = quaternions.facing(up)
    while at_s < seconds:
        moving = rng.uniform(20.0, 120.0)
        for act, long_s in ((_WORLDS[case.kind], moving), (rest, moving * resting / (1 - resting))):
            n = round(long_s * hz)
            if n < hz:
                continue
            start = Start(
                rng, np.arange(1, n + 1) * dt_s, dt_s, quaternions.into_body(attitude, _UP)
            )
            *shown, turned = felt(start, act(start))
            yield tuple(shown)
            attitude = turned[-1]
        at_s += moving / (1 - resting)


def in_markdown(found: dict[str, Any]) -> str:
    """The page: a table by kind of motion, and one of devices without errors."""
    rows = found["rows"]
    off, bare, pushed = (
        [r for r in rows if (r["off"], r["kind"] == COHERENT) == which]
        for which in ((True, False), (False, False), (False, True))
    )
    worse = [r for r in off if r["found"] and r["after"] > 1.02 * r["before"]]
    others = [
        ["nothing wrong: something found", *_share(bare, _found(bare), 0.5)],
        ["errors: deployed and worse by 2 %", *_share(off, worse, 0.5)],
        ["nothing wrong, pushes as it turns: found", *_share(pushed, _found(pushed), 1.0)],
    ]
    known = table(_HEADS, [_of_kind(kind, [r for r in off if r["kind"] == kind]) for kind in KINDS])
    return "\n\n".join(
        [_INTRODUCTION.format(devices=found["devices"]), known, table(_MORE, others)]
    )


def _found(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return [r for r in rows if r["found"]]


def _share(of: list[dict[str, Any]], some: list[dict[str, Any]], limit: float) -> list[str]:
    share = 100 * len(some) / max(len(of), 1)
    return [f"{len(some)} of {len(of)}", f"{limit} %", "yes" if share <= limit else "NO"]


def _of_kind(kind: str, rows: list[dict[str, Any]]) -> list[str]:
    entries = np.array([[*e, r["found"]] for r in rows for e in r["entries"]]).reshape(-1, 4)
    true, said, sigma, found = entries.T
    worth = sigma < np.abs(true) / 3
    seen = worth & (found > 0) & (np.abs(said) > _SIGMAS * sigma)
    within = 100 * np.mean(np.abs(said - true) < _SIGMAS * sigma) if len(entries) else np.nan
    percent = 100 * seen.sum() / max(worth.sum(), 1)
    enough = "yes" if percent >= 95 else "NO"
    deployed = [r["after"] / r["before"] for r in rows if r["found"]]
    return [
        *(kind, f"{len(_found(rows))} of {len(rows)}"),
        *(f"{seen.sum()} of {worth.sum()} ({percent:.0f} %)", enough if worth.any() else "-"),
        *(f"{within:.0f} %", "yes" if 90 <= within <= 99 else "NO"),
        f"{np.median(deployed):.2f}" if deployed else "-",
    ]


_HEADS = [
    *("motion", "devices that got a matrix"),
    *("entries found", "found: at least 95 %"),
    *("entries within two sigma of the truth", "within: 90 to 99 %"),
    "heading loss that is left",
]
_MORE = ["devices", "how many", "at most", "met"]
_INTRODUCTION = """\
# Heading in simulated motion, measured

`zerorate bench heading-simulated --devices {devices}` wrote this page: {devices} devices a kind.

Scale factors are off by 0.3 to 2 %. Cross-axis terms reach 1 %. Axes are turned by up to 5 degrees.
Each device has one recording of 5 to 60 minutes. It rests for 0 to 90 % of them. Its rate is 25 to
400 Hz. A recording has at most 60,000 samples.

An entry is one of the nine of a matrix. The entries counted are those whose sigma is below a third
of their size. An entry is found if the matrix that a device got has it. Heading loss that is left
is a share of the loss without a matrix, a median of the devices that got one."""
