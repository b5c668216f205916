"""A closed loop made by hand, so that no search decides what is found: its report.

Effects are fitted to short sessions with steps, a matrix, a delay and lines.
"""

import json
from dataclasses import replace

import numpy as np
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.fit.single import PiecesByLine
from zerorate_tools.loop.motion.by_windows import RateScale
from zerorate_tools.loop.motion.scales_and_timing import InMotion, Timing
from zerorate_tools.loop.read.gate import GateReport
from zerorate_tools.loop.read.lines import Line
from zerorate_tools.loop.read.sessions import block_basis
from zerorate_tools.loop.report.report import as_json, report
from zerorate_tools.loop.report.result import in_words
from zerorate_tools.loop.search.catalogue import Candidate
from zerorate_tools.loop.search.decide import Decision
from zerorate_tools.loop.search.select import select
from zerorate_tools.loop.search.selection import Found, Selection
from zerorate_tools.loop.search.steps import Step
from zerorate_tools.loop.search.steps_first import remove_steps
from zerorate_tools.loop.verify.analysis import Analysis
from zerorate_tools.loop.verify.courses import AFTER, BEFORE, ONLINE, ONLINE_BEFORE, Course, Courses
from zerorate_tools.loop.verify.judge import ResidualTest, judge
from zerorate_tools.model.term import Term
from zerorate_tools.report import page

from host_tests.loop import dense

_T, _V = Term("temp", 10.0, 40.0, 25.0), Term("vdd_mv", 3200.0, 3400.0, 3300.0)
_TERMS = {
    "temperature-polynomial": (replace(_T, power=2), replace(_T, power=3)),
    "thermal-lag": (replace(_T, lag_s=60.0, lag_mode="difference"),),
    "supply-temperature": (
        replace(_V, second="temp", second_lo=10.0, second_hi=40.0, second_centre=25.0),
    ),
    "thermal-hysteresis": (replace(_T, memory="play", width=2.0),),
    "thermal-rate": (replace(_T, lag_s=30.0, lag_mode="rate"),),
    "power-on-transient": (Term("one", decay_s=300.0),),
    "lagged-square": (replace(_T, lag_s=60.0, lag_mode="lag", power=2, power_first=True),),
    "peak-temperature": (replace(_T, memory="peak"),),
    "channel": (Term("load", 10.0, 250.0, 100.0, delay_s=40.0),),
    "temperature-kink": (replace(_T, knot=3.0),),
}
_STEP = Step(0, 40, np.array([0.03, -0.01, 0.0]), 9.0, 1e-6, np.full(3, 0.002), 800.0, "seen")


def _session(seed, kinds, tempered):
    """90 blocks of 20 s, two ticks each, with gaps; the effects are in it."""
    s = replace(dense.made(seed, 90, gap=(7, 30, 31), scale=1e-3), ticks_per_block=2)
    at = np.arange(180) / 180
    s = replace(s, start_us=seed * 1_000_000, sources={
        "temp": 25 + 9 * np.sin(5 * at + seed) * at**0.5 + 0.05 * np.sin(400 * at),
        "vdd_mv": 3300 + 60 * np.sin(19 * at),
        "load": 100.0 + 50 * (at * 7 % 2 > 1), "time": at * 1800, "one": np.ones(180),
    })  # fmt: skip
    for number, term in enumerate(term for kind in kinds for term in _TERMS[kind]):
        course = block_basis(term, s)
        s.rate_dps[:] += np.outer(course / np.ptp(course), [0.01, -0.02, 0.001 * number])
    s.listed = (_STEP, replace(_STEP, said="", at_s=1200.0)) * (seed == 1)
    if not tempered:
        del s.sources["temp"]
    return s


def _found(number, kind):
    decision = Decision(True, 1e-4 / (1 + number), 20.5678, 1.2345, np.array([1.234, 2.345, 3.456]))
    rivals = {"vibration": -1.0, "drift": -5.0} if number else {}
    axes = (True, number != 1, True)
    return Found(Candidate(kind, _TERMS[kind], "catalogue"), decision, rivals, axes)


def analysed(kinds, sessions=4, tempered=True, **more):
    """The analysis of so many sessions with effects of these kinds, the last one held out."""
    every = [_session(seed, kinds, tempered) for seed in range(sessions)]
    train, held = every[:-1] or every, every[-1:]
    chosen = Selection(
        [_found(number, kind) for number, kind in enumerate(kinds)],
        [("supply-voltage", "other sessions"), *((kind, "again") for kind in kinds)], 3,
        Regression(train), (_T,) * tempered, (), [_found(0, "supply-temperature").candidate],
        {"thermal-lag": 0.004, "linear-g": 0.0012345}, len(train) == 1, sessions > 1,
        [("drift", "worse")],
    )  # fmt: skip
    faults = {"s1": {"repeated": 3, "jumps": 0}, "s2": {"jumps": 0}}
    beside = np.array([0.00112345, 0.0021, 0.0015]), GateReport(faults, {"odd": "why"}, ["noted"])
    return Analysis(every, train, held, chosen, judge(chosen, held), *beside, **more)


def _scale(unseen):
    matrix, lsb = np.arange(9.0).reshape(3, 3) / 1000, np.array([400.0, 300.0, 200.0])
    return RateScale(
        *(matrix, matrix / 10 + 1e-4, 1e-9, "scale-factor+cross-axis", "gravity", np.ones(2)),
        *(2.0, 0.5, "degrees a minute", 40, lsb, unseen & (matrix > 0.0), 0.01, 0.8 * matrix),
        lost=(3.1, 0.4),
    )


def _measured(analysis):
    """What the kernels would have had, made of what floats have."""
    courses = {}
    for number, s in enumerate(analysis.sessions):
        ways = {BEFORE: 1.0, AFTER: 0.3, ONLINE: 0.2, ONLINE_BEFORE: 0.4, "after_1": 0.7}
        error = s.rate_dps - np.nanmean(s.rate_dps, 0)
        left = {way: share * error for way, share in ways.items()}
        offsets = {BEFORE: np.full(3, 0.6 + number), AFTER: np.full(3, 0.1)}
        courses[s.name] = Course(np.arange(s.blocks) * 20.0, {}, left, offsets)
    names = [s.name for s in analysis.holdout]
    return Courses(courses, names, np.array([1e-5, 2e-5, 4e-5]), "kernels", ["s0"])


def gathered(parts):
    """{name: [its words], name and numbers: its numbers} of {name: what JSON holds}."""
    found = {}
    for name, part in parts.items():
        words, numbers = [], []
        _gather(part, words, numbers)
        found |= {name: [" ".join(words)], f"{name} numbers": [float(f"{v:.6g}") for v in numbers]}
    return found


def gathered_plain(parts):
    """The same of values that only JSON makes plain."""
    return gathered(_plain(parts))


def _gather(value, words, numbers):
    """Words and integers; numbers; of long rows their mean, slope and size."""
    row = value if isinstance(value, list) and len(value) > 3 else ()
    if isinstance(value, str):
        words.append(value)
    elif row and all(v is None or isinstance(v, float) for v in row):
        v = np.nan_to_num(np.array(row, float))
        words.append(str(len(v)))
        numbers += [v.mean(), (v * np.linspace(-1, 1, len(v))).mean(), np.abs(v).mean()]
    elif isinstance(value, float):
        numbers.append(value)
    elif isinstance(value, dict | list):
        for part in value.values() if isinstance(value, dict) else value:
            _gather(part, words, numbers)
    else:
        words.append(str(value))


def _variants():
    kinds = [*_TERMS]
    lines = [
        Line(0.004, np.array([0.01, 0.02, 0.0]), 1e-5, True),
        Line(3.5, np.full(3, 1 / 3), 1e-7),
    ]
    late = InMotion(_scale(False), Timing(0.004, 0.001, 1e-9, (0.004, 0.003, 0.005)))
    early = InMotion(replace(_scale(True), heading=(3.21, 1.05)), Timing(-0.7, 0.1, 1e-9, (-0.7,)))
    yield "many", analysed(kinds[:4], motion=late, lines=lines)
    measured = analysed([*kinds[4:6], "channel"], sessions=5)
    yield "measured", replace(measured, measured=_measured(measured))
    yield "alone", analysed(kinds[:1], sessions=1, motion=early)
    yield "cold", analysed(["power-on-transient"], sessions=3, tempered=False)
    nothing = analysed([])
    yield "nothing", nothing
    drifts = ResidualTest(0.0, 99.0, np.array([-0.4, 0.1, 0.2]))
    judged = replace(nothing.judgement, residual_test=drifts)
    blind = replace(nothing.selection, pool=[])
    yield "drifting", replace(nothing, judgement=judged, selection=blind)


def _plain(value):
    return json.loads(json.dumps(value, default=as_json))


def reported():
    """What report.json and the terminal have of each, and what the page takes from it."""
    found = {}
    for name, analysis in _variants():
        result = _plain(report(analysis))
        beside = {
            "words": in_words(result),
            "of page": [page.smallest(result), page.faults(result)],
        }
        every = {key: part for key, part in {**result, **beside}.items() if key != "steps"}
        found |= gathered({f"{name} {key}": _plain(part) for key, part in every.items()})
    return found


def _power_ons(effects, blocks=120):
    """Two sessions of a device, cut to so many blocks."""
    made = simulate(7, effects).sessions[:2]
    ticks = blocks * made[0].ticks_per_block
    return [
        replace(s, rate_dps=s.rate_dps[:blocks], weight=s.weight[:blocks],
                sources={name: of[:ticks] for name, of in s.sources.items()})
        for s in made
    ]  # fmt: skip


def steps_found():
    """Of two power-ons with a step each, and a disturbance of two blocks."""
    one, other = _power_ons([])
    one.rate_dps[70:] += [0.02, -0.03, 0.0]
    other.rate_dps[40:] += [0.0, 0.0, 0.05]
    other.rate_dps[90:92] += 0.1
    per, rng = one.ticks_per_block, np.random.default_rng(1)
    ticks = np.repeat(one.rate_dps, per, axis=0) + rng.normal(0, 0.01, (len(one.rate_dps) * per, 3))
    at_rest = replace(one, ticks_dps=ticks, temp_step_degc=0.2)
    sessions = remove_steps([at_rest, other])
    steps = [
        {n: v for n, v in vars(step).items() if n != "at"} for s in sessions for step in s.steps
    ]
    left = {f"rate {n}": s.rate_dps.ravel().tolist() for n, s in enumerate(sessions)}
    left |= {n: getattr(sessions[0], n).ravel().tolist() for n in ("ticks_dps", "level_dps")}
    return gathered_plain({"steps": steps, **left})


_PLAIN = vars(Term(""))


def _selected(selection):
    """What a search found, with what it refused, and the least that it would see."""
    found = [
        {**vars(f.decision), "kind": f.candidate.kind, "with": f.confounded_with}
        | {"terms": [dict(sorted(vars(t).items() - _PLAIN.items())) for t in f.candidate.terms]}
        for f in selection.found
    ]
    refused = [label for label, _ in selection.refused]
    told = {"found": found, "refused": refused, "least": selection.smallest_dps}
    return gathered_plain(told)


def searched_two():
    """Of two power-ons with a hysteresis and a supply: what the search takes and refuses."""
    return _selected(select(_power_ons([("thermal-hysteresis", 4.0), ("supply-voltage", 4.0)], 80)))


def searched_one():
    """Of one power-on that bends over temperature, judged by pieces left out."""
    one = _power_ons([("temperature-kink", 6.0)], 80)[0]
    return _selected(select([one], on_pieces=PiecesByLine(one)))
