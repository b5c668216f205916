"""`zerorate bench peers`: what a peer's figure hangs on, by changing one thing of its scenario.

The scenarios are words; whoever simulates them must choose what the words leave open.
"""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from zerorate_tools.demo.broad import rms_mdps
from zerorate_tools.peers import Given, Peer, fusion, given
from zerorate_tools.simulate import simulate
from zerorate_tools.simulate.description import bundled, parsed

from .accuracy import SEEDS
from .peers.sources import ardupilot_cubic, px4_cubic
from .tables import machine_line, number, table

_HOW = """\
Made by `zerorate bench peers`. The accuracy table describes its scenarios in words, and a
simulation must choose what the words leave open. Each row changes one such choice and runs the
same peer.

imufusion learns at rest only and starts at zero. Its figure is mostly the first minute: it
depends on whether the part rests or moves at power-on. A cubic fitted on session 1 does not know
a walk. On C its figure is mostly the walk of both sessions, and differs much from seed to seed.
"""
Table = dict[str, Any]
Change = Callable[[Table], None]


def as_it_is(description: Table) -> None:
    """Change nothing."""


def moved_at_once(description: Table) -> None:
    """Every power-on begins with 40 s of motion, then 20 s still."""
    moving = description["every_session"]["motion"][1]
    description["every_session"]["motion"] = [moving, {"kind": "rest", "s": 20}]


def evenly_warmed(description: Table) -> None:
    """The temperature rises along a line."""
    for session in description["session"]:
        for segment in session["temperature"]:
            segment.pop("tau_s")


def without_lag(description: Table) -> None:
    """The thermometer is as warm as the die."""
    description["sensor"].pop("temp_lag_s")


def without_walk(description: Table) -> None:
    """The bias does not walk."""
    description.pop("noise")


CASES: tuple[tuple[str, str, str, Peer, Change, Change], ...] = (
    # peer, scenario, words, peer itself, change of session 1, change of session 2
    ("imufusion", "warm-up-a", "as it is", fusion, as_it_is, as_it_is),
    ("imufusion", "warm-up-a", "moved from the first second", fusion, as_it_is, moved_at_once),
    ("imufusion", "warm-up-a", "warmed evenly", fusion, evenly_warmed, evenly_warmed),
    ("PX4-style", "warm-up-c", "as it is", px4_cubic, as_it_is, as_it_is),
    ("PX4-style", "warm-up-c", "no lag", px4_cubic, without_lag, without_lag),
    ("PX4-style", "warm-up-c", "no walk", px4_cubic, without_walk, without_walk),
    ("PX4-style", "warm-up-c", "a walk in session 2 only", px4_cubic, without_walk, as_it_is),
    ("ArduPilot-style", "warm-up-c", "as it is", ardupilot_cubic, as_it_is, as_it_is),
    ("ArduPilot-style", "warm-up-c", "no walk", ardupilot_cubic, without_walk, without_walk),
)


def peer_differences(
    seeds: Sequence[int] = SEEDS, advance: Callable[[float], None] = lambda n: None
) -> dict[str, list[dict[str, Any]]]:
    """`cases`: a dict each: peer, scenario, change, rms_mdps of session 2 (least, median, most)."""
    rows = []
    for name, scenario, words, peer, first, second in CASES:
        found = [_error(peer, scenario, (first, second), seed) for seed in seeds]
        spread = {"least": min(found), "median": float(np.median(found)), "most": max(found)}
        rows.append({"peer": name, "scenario": scenario, "change": words, "rms_mdps": spread})
        advance(1)
    return {"cases": rows}


def in_markdown(found: dict[str, list[dict]]) -> str:
    cells = [
        [
            f"{row['peer']}, {row['scenario'][-1].upper()}",
            row["change"],
            *map(number, row["rms_mdps"].values()),
        ]
        for row in found["cases"]
    ]
    header = ["session 2, RMS, mdps", "scenario", "least", "median", "most of the seeds"]
    return "\n".join(
        ["# What the peers' figures hang on\n", _HOW, machine_line(), table(header, cells)]
    )


def _error(peer: Peer, scenario: str, changes: tuple[Change, Change], seed: int) -> float:
    sessions: list[Given] = []
    for session, change in enumerate(changes, start=1):
        description = parsed(bundled(scenario) or Path(scenario))
        change(description)
        recording, truth = simulate(description, session=session, seed=seed)
        sessions.append(given(recording, truth.still))
    bias_dps = truth.bias_lsb / recording.scales.gyro_lsb_per_dps
    return rms_mdps(peer(sessions)[-1] - bias_dps)
