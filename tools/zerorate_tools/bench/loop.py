"""`zerorate bench loop`: what the loop finds, names, removes and invents, as tables."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, field
from os import PathLike
from pathlib import Path

import numpy as np

CATALOGUE = (
    "temperature-quadratic",
    "temperature-cubic",
    "thermal-rate",
    "thermal-lag",
    "thermal-hysteresis",
    "power-on-transient",
    "time-drift",
    "linear-acceleration",
    "squared-acceleration",
    "vibration",
    "supply-voltage",
    "supply-temperature",
    "scale-factor",
    "cross-axis",
)
#: Effects outside the catalogue and the channels that they must be tied to.
OUTSIDE = {
    "load-squared-delayed": ("load",),
    "load-squared-lagged": ("load",),
    "load-kink": ("load",),
    "load-humidity": ("load", "humidity"),
    "temperature-peak": ("temp",),
}
PAIRS = (
    ("thermal-hysteresis", "supply-voltage"),
    ("thermal-lag", "vibration"),
    ("power-on-transient", "linear-acceleration"),
)
_SEEDS = {"null": 10_000, "effect": 200_000, "hidden": 400_000, "real": 600_000, "pair": 800_000}


@dataclass(frozen=True)
class Device:
    """What to simulate and which row of the tables it counts for."""

    row: str
    seed: int
    effects: tuple[tuple[str, float], ...] = ()
    sessions: int = 4
    noise: str = "plain"
    hidden: float = 0.0
    real: str | None = None


@dataclass
class Outcome:
    """What the loop said of a device. before, after: held-out RMS over that of the noise alone."""

    device: Device
    found: list[str] = field(default_factory=list)
    sources: list[list[str]] = field(default_factory=list)
    rivals: list[list[str]] = field(default_factory=list)
    confidence: list[str] = field(default_factory=list)
    events: int = 0
    excess: bool = False
    before: float = 1.0
    after: float = 1.0

    def named(self, effect: str) -> bool:
        """Whether an effect is among the named, or among what is confounded with one of them."""
        everything = [*self.found, *(r for rivals in self.rivals for r in rivals)]
        return any(n == effect or n.startswith(effect + "+") for n in everything)

    def tied_to(self, channels: tuple[str, ...]) -> bool:
        """Whether an effect found follows exactly these channels."""
        return any(set(s) == set(channels) for s in self.sources)


def look(device: Device) -> Outcome:
    """Simulate a device, run the loop on it and judge by its last session."""
    from ..loop.simulated import simulate

    if device.real:
        sessions, noise = real_sessions(device)
    else:
        simulated = simulate(
            device.seed, list(device.effects), device.sessions, 1.0, device.noise, device.hidden
        )
        sessions, noise = simulated.sessions, simulated.noise_dps
    return _outcome(device, sessions, noise[-1])


def _outcome(device, sessions, noise_dps):
    from dataclasses import replace

    from ..loop.confounding import label
    from ..loop.judge import judge, scored
    from ..loop.select import select

    selection = select(sessions[:-1])
    verdict = judge(selection, sessions[-1:])
    alone, _ = scored(replace(sessions[-1], rate_dps=noise_dps), np.zeros(noise_dps.shape))
    unit = float(np.sqrt(np.nanmean(alone**2)))
    found = selection.found
    return Outcome(
        device,
        [label(f.candidate) for f in found],
        [f.candidate.sources for f in found],
        [f.confounded_with for f in found],
        [verdict.confidence(i) for i in range(len(found))],
        len(selection.steps),
        bool(verdict.excess.left),
        float(verdict.before_rms / unit),
        float(verdict.after_rms / unit),
    )


def real_sessions(device: Device):
    """A quiet real recording cut into sessions, simulated channels that mean nothing beside."""
    from ..loop.sessions import Session
    from ..loop.simulated import BLOCK_S, TICKS, channels

    rng = np.random.default_rng(device.seed)
    blocks = np.load(device.real)
    length = int(rng.uniform(0.18, 0.245) * len(blocks))
    slack = len(blocks) - 4 * length
    starts = np.sort(rng.integers(0, slack + 1, 4)) + length * np.arange(4)
    sign = rng.choice([-1.0, 1.0], 3) * rng.choice([-1.0, 1.0])
    backwards = rng.random() < 0.5
    out = []
    for i, s in enumerate(starts[rng.permutation(4)]):
        rate = blocks[s : s + length] * sign
        rate = rate[::-1].copy() if backwards else rate.copy()
        sources = channels(rng, length * TICKS, BLOCK_S / TICKS)
        out.append(Session(f"cut-{i + 1}", BLOCK_S, TICKS, rate, np.ones(length), sources))
    return out, [s.rate_dps for s in out]


def real_noise(data: Path, folder: Path) -> list[str]:
    """Block means of the real recordings at rest, one .npy each in a folder; their paths."""
    import pyarrow.parquet as pq

    paths = []
    for path in sorted((data / "adis16405-static").glob("*.parquet")):
        table = pq.read_table(path, columns=["gx_lsb", "gy_lsb", "gz_lsb"])
        rate = np.column_stack([c.to_numpy() for c in table.columns]) * 0.05
        for seconds in (10, 20):
            per = seconds * 100
            n = len(rate) // per
            out = folder / f"{path.stem}-{seconds}s.npy"
            np.save(out, rate[: n * per].reshape(n, per, 3).mean(axis=1))
            paths.append(str(out))
    return paths


def devices(nulls: int, seeds: int, real: list[str]) -> list[Device]:
    """Every device of the tables."""
    from ..loop.simulated import HOSTILE

    out = [Device("null", _SEEDS["null"] + i) for i in range(nulls)]
    for k, kind in enumerate(HOSTILE):
        first = _SEEDS["null"] + 1000 * (k + 1)
        share = -(-nulls // len(HOSTILE))
        out += [Device(f"null, {kind}", first + i, noise=kind) for i in range(share)]
    for i in range(nulls if real else 0):
        out.append(Device("real noise", _SEEDS["real"] + i, real=real[i % len(real)]))
    for size in (1.0, 2.0, 5.0):
        for e in (*CATALOGUE, "temperature-kink", "step"):
            first = _SEEDS["effect"]
            out += [Device(f"{size:g}x", first + i, ((e, size),)) for i in range(seeds)]
    for e in OUTSIDE:
        out += [Device("outside", _SEEDS["effect"] + i, ((e, 2.0),)) for i in range(seeds)]
    for n in (4, 7):
        row = f"not recorded, {n} sessions"
        first = _SEEDS["hidden"] + 1000 * n
        out += [
            Device(row, first + i, sessions=n, hidden=5.0) for i in range(max(seeds, nulls // 4))
        ]
    for k, pair in enumerate(PAIRS):
        first = _SEEDS["pair"] + 1000 * k
        both = tuple((e, 2.0) for e in pair)
        out += [Device("two at once", first + i, both) for i in range(seeds)]
    return out


def tables(outcomes: list[Outcome]) -> dict:
    """The figures of issue 4 and what they must be, as plain values."""
    rows: dict = {"false_alarms": {}, "effects": {}, "outside": {}, "not_recorded": {}, "pairs": {}}
    by_row: dict[str, list[Outcome]] = {}
    for o in outcomes:
        by_row.setdefault(o.device.row, []).append(o)
    for row, group in by_row.items():
        if row.startswith("null") or row == "real noise":
            rows["false_alarms"][row] = _false_alarms(group)
        elif row.endswith("x"):
            rows["effects"][row] = {e: _effect(e, g) for e, g in _by_effect(group).items()}
        elif row == "outside":
            rows["outside"] = {e: _tied(e, g) for e, g in _by_effect(group).items()}
        elif row.startswith("not recorded"):
            rows["not_recorded"][row] = _false_alarms(group)
        else:
            rows["pairs"] = {e: _both(g) for e, g in _by_effect(group).items()}
    rows["made_worse_percent"] = _percent([o.after > 1.02 * o.before for o in outcomes])
    rows["devices"] = len(outcomes)
    return rows


def _by_effect(group):
    out: dict[str, list[Outcome]] = {}
    for o in group:
        out.setdefault(" + ".join(e for e, _ in o.device.effects), []).append(o)
    return out


def _percent(values) -> float:
    return round(100.0 * float(np.mean(values)), 2) if len(values) else 0.0


def _false_alarms(group):
    return {
        "devices": len(group),
        "found_percent": _percent([bool(o.found) for o in group]),
        "confirmed_percent": _percent(["confirmed" in o.confidence for o in group]),
        "step_listed_percent": _percent([o.events > 0 for o in group]),
        "excess_said_percent": _percent([o.excess for o in group]),
        "after_over_noise": _median([o.after for o in group]),
        "examples": [[o.device.seed, o.found] for o in group if o.found][:5],
    }


def _median(values):
    return round(float(np.median(values)), 3)


def _effect(effect, group):
    if effect == "step":
        return {
            "devices": len(group),
            "listed_percent": _percent([o.events > 0 for o in group]),
            "corrected_percent": _percent([bool(o.found) for o in group]),
        }
    return {
        "devices": len(group),
        "found_percent": _percent([bool(o.found) for o in group]),
        "named_percent": _percent([o.named(effect) for o in group if o.found]),
        "confirmed_percent": _percent(["confirmed" in o.confidence for o in group]),
        "before_over_noise": _median([o.before for o in group]),
        "after_over_noise": _median([o.after for o in group]),
    }


def _tied(effect, group):
    right = [o.tied_to(OUTSIDE[effect]) for o in group]
    return {**_effect(effect, group), "tied_to_right_channel_percent": _percent(right)}


def _both(group):
    both = [all(o.named(e) for e, _ in o.device.effects) for o in group]
    return {**_effect("", group), "both_named_percent": _percent(both)}


def run(
    nulls: int = 200,
    seeds: int = 20,
    processes: int = 2,
    data: str | PathLike[str] | None = None,
    json_path: str | PathLike[str] | None = None,
    advance: Callable[[float], None] = lambda n: None,
) -> dict:
    """Run the whole benchmark. data: folder of the real recordings, else ZERORATE_DATA, else none.

    Returns the tables; writes them to json_path. `markdown` makes them readable.
    """
    import tempfile

    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(name, "1")
    folder = Path(data or os.environ.get("ZERORATE_DATA", "../shared/data"))
    with tempfile.TemporaryDirectory() as scratch:
        real = real_noise(folder, Path(scratch)) if folder.is_dir() else []
        outcomes = []
        with ProcessPoolExecutor(processes) as pool:
            for outcome in pool.map(look, devices(nulls, seeds, real), chunksize=4):
                outcomes.append(outcome)
                advance(1)
    result = tables(outcomes)
    if folder.is_dir():
        from .loop_real import real_rows

        result["real_recordings"] = real_rows(folder)
    if json_path:
        Path(json_path).write_text(json.dumps(result, indent=1), encoding="utf-8")
        every = Path(json_path).with_suffix(".devices.json")
        every.write_text(json.dumps([asdict(o) for o in outcomes]), encoding="utf-8")
    return result


def markdown(result: dict) -> str:
    """The tables as Markdown."""
    out = []
    for title in ("false_alarms", "not_recorded", "outside", "pairs"):
        out += [f"### {title.replace('_', ' ')}", "", *_table(result[title]), ""]
    for size, rows in result["effects"].items():
        out += [f"### effects at {size} the floor", "", *_table(rows), ""]
    out.append(
        f"Held-out error made worse by more than 2 %: {result['made_worse_percent']} % "
        f"of {result['devices']} devices."
    )
    if "real_recordings" in result:
        out += ["", "### real recordings", "", *_table(result["real_recordings"])]
    return "\n".join(out)


def _table(rows: dict) -> list[str]:
    keys = [k for k in dict.fromkeys(k for r in rows.values() for k in r) if k != "examples"]
    lines = [
        "| | " + " | ".join(k.replace("_", " ") for k in keys) + " |",
        "|---" * (len(keys) + 1) + "|",
    ]
    for name, row in rows.items():
        lines.append(f"| {name} | " + " | ".join(str(row.get(k, "")) for k in keys) + " |")
    return lines
