"""`zerorate bench accuracy`: the tables and their figures."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from .accuracy import FIRST_S, SCENARIOS, SEEDS, day, second_power_on
from .peers import PEERS
from .real_recordings import COLUMNS, data_folder, real
from .tables import machine, machine_line, number, table

STEPS = 5 + len(SCENARIOS) * len(SEEDS) * len(PEERS)
LIMITS_ALL = {"warm-up-a": 7, "warm-up-b": 12, "warm-up-c": 35}
LIMITS_FIRST = {"warm-up-a": 20, "warm-up-b": 40, "warm-up-c": 50}


def accuracy(advance: Callable[[float], None] = lambda n: None) -> dict:
    """All figures, mdps: day_rms_mdps, session_2_rms_mdps, real_rms_mdps (None without data)."""
    folder = data_folder()
    return {
        "machine": machine(),
        "day_rms_mdps": day(advance=advance),
        "session_2_rms_mdps": {n: second_power_on(n, advance=advance) for n in SCENARIOS},
        "session_2_limits_mdps": {"all": LIMITS_ALL, "first": LIMITS_FIRST},
        "real_rms_mdps": real(folder) if folder else None,
    }


def in_markdown(found: Mapping) -> str:
    """The tables of `accuracy`."""
    parts = ["# Accuracy\n", machine_line(), *_day(found["day_rms_mdps"])]
    parts += _second_power_on(found["session_2_rms_mdps"])
    parts += _real(found["real_rms_mdps"])
    return "\n".join(parts)


def _day(figures: Mapping[str, float]) -> list[str]:
    rows = [[peer, number(value)] for peer, value in figures.items()]
    return [
        "## A simulated day: half of it moving, 25 degC of change\n",
        table(["RMS bias error, mdps", "all day"], rows),
    ]


def _second_power_on(figures: Mapping[str, Mapping[str, Mapping[str, float]]]) -> list[str]:
    header = ["RMS bias error, mdps"]
    header += [f"{name[-1].upper()} {part}" for part in ("all", "first 15 s") for name in figures]
    rows = []
    for peer in PEERS:
        parts = [figures[name][peer][part] for part in ("all", "first") for name in figures]
        rows.append([peer, *map(number, parts)])
    rows.append(["at most", *LIMITS_ALL.values(), *LIMITS_FIRST.values()])
    return [
        f"## Session 2, after a warm-up and a power cut; all, and the first {FIRST_S:.0f} s\n",
        f"Median of {len(SEEDS)} seeds. zerorate is online and unaided, its state kept from "
        "session 1; no model of the loop is loaded.\n",
        table(header, rows),
    ]


def _real(figures: Mapping | None) -> list[str]:
    title = "## Real recordings at rest: all of it / without the first 20 s (8 readings)\n"
    if figures is None:
        return [title, "Left out: no real recordings here; ZERORATE_DATA names their folder.\n"]
    rows = [
        [name, *(f"{number(f['all'])} / {number(f['later'])}" for f in columns.values())]
        for name, columns in figures.items()
    ]
    note = (
        "RMS over axes and over means of 20 s, true rate zero (Earth's 4 mdps is in it); "
        "blocks in which the sensor was handled are left out.\n"
    )
    return [title, note, table(["mdps", *COLUMNS], rows)]
