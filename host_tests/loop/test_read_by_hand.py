"""How recordings are read, part by part: at the edges, in batches, and as a plain computation."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from zerorate_tools.loop.read import lines, sessions
from zerorate_tools.loop.read.bad_readings import BadReadings
from zerorate_tools.loop.read.reference import Reference, attitude_names, declared
from zerorate_tools.loop.read.sessions import Session, block_basis
from zerorate_tools.model.term import Term, play
from zerorate_tools.recordings.checks import GAP

FRAME = {"t_us": 0, "gx": 5, "gy": 6, "gz": 7, "ax": 1, "ay": 2, "az": 3, "temp": 100}
FRAME |= {"other": 9}


@pytest.mark.parametrize(
    ("hz", "changes", "fault"),
    [
        *((100.0, {"gy": 32766}, ""), (100.0, {"gy": 32767}, "clipped")),
        *((100.0, {"gz": -32767}, "clipped"), (100.0, {"ax": 32767}, "")),
        *((100.0, {"other": 7}, "repeated"), (2.0, {}, ""), (2.1, {}, "repeated")),
        (100.0, dict.fromkeys(FRAME, 0), "all-zero"),
        *((100.0, {"gx": 1, "temp": 499}, ""), (100.0, {"gx": 1, "temp": 500}, "temperature-jump")),
        *((100.0, {"gx": 1, "temp": -300}, "temperature-jump"), (2.0, {"temp": 500}, "")),
        *(
            (2.0, {"temp": 32767}, "temperature-jump"),
            (100.0, {"gx": 32767, "temp": 600}, "clipped"),
        ),
    ],
)
@pytest.mark.parametrize("cut", [1, 2])
def test_a_reading_that_is_none_is_set_aside_by_its_first_fault(hz, changes, fault, cut):
    rows = [{**FRAME, "gz": 8}, FRAME, {**FRAME, **changes}]
    bad, good = BadReadings([*FRAME], hz), []
    for part in (rows[:cut], rows[cut:]):
        good += bad.set_aside({n: np.array([r[n] for r in part]) for n in FRAME}).tolist()
    assert good == [True, True, not fault]
    assert {name: n for name, n in bad.faults.items() if n} == ({fault: 1} if fault else {})


def attitude(n, seed, lost):
    """(n, 4) of a device that turns, as whole numbers w x y z of any sign, not always seen."""
    rng = np.random.default_rng(seed)
    turns = Rotation.from_rotvec(rng.normal(0, 0.2, (n, 3)))
    at = [Rotation.identity()]
    for turn in turns[1:]:
        at.append(at[-1] * turn)
    q = np.array([one.as_quat()[[3, 0, 1, 2]] for one in at]) * rng.choice([-1, 1], (n, 1))
    words = np.rint(q * 1e9).astype(np.int64)
    words[lost] = rng.choice([0, GAP], (n, 1))[lost]
    return words, [turn.as_rotvec() for turn in turns]


@given(
    st.integers(0, 999),
    st.sets(st.integers(0, 29), max_size=6),
    st.lists(st.integers(1, 29), max_size=4),
)
def test_an_attitude_tells_the_rates_between_samples_that_were_both_seen(seed, lost, cuts):
    words, turned = attitude(30, seed, sorted(lost))
    dt_us = np.random.default_rng(seed).integers(5_000, 90_000, 30)
    t_us, names = np.cumsum(dt_us), [f"a_q{part}" for part in "wxyz"]
    reference, found, signs = Reference(["gx", *names], 131.0), [], []
    for a, b in zip([0, *sorted(cuts)], [*sorted(cuts), 30]):
        if a < b:
            batch = {name: words[a:b, i] for i, name in enumerate(names)}
            q = reference.quaternions(batch)
            signs += q.tolist()
            found += reference.rate_dps(t_us[a:b], batch, q).tolist()
    for k in range(30):
        known = k > 0 and not {k, k - 1} & lost
        expected = np.degrees(turned[k]) / (dt_us[k] * 1e-6) if known else np.full(3, np.nan)
        assert found[k] == pytest.approx(expected, abs=1e-3, nan_ok=True)
    seen = np.array([q for k, q in enumerate(signs) if k not in lost])
    assert ((seen[1:] * seen[:-1]).sum(axis=1) > 0).all()
    assert np.linalg.norm(seen, axis=1) == pytest.approx(np.ones(len(seen)))


def test_a_reference_is_rates_or_four_columns_of_one_beginning_or_what_is_declared():
    four = ["b_qw", "b_qx", "b_qy", "b_qz"]
    assert attitude_names(["a_qw", "a_qx", *four, "qw"]) == tuple(four)
    assert attitude_names(["qw", "qx", "qy"]) is None
    rates = ["ref_gx", "ref_gy", "ref_gz"]
    both = Reference([*rates, *four], 131.0)
    assert both.names == (*rates, *four) and Reference(rates[:2], 131.0).names == ()
    batch = dict(zip(rates, np.array([[131, GAP], [262, 0], [-131, 1]])))
    rate = both.rate_dps(np.arange(2), batch, None)
    assert rate.tolist()[0] == [1.0, 2.0, -1.0]
    assert np.isnan(rate[1]).tolist() == [True, False, False]
    told = {"a": {"role": "reference"}, "b": {"role": "cause"}, "c": "reference"}
    assert declared({"channels": told}) == {"a"} and declared({"channels": [1]}) == set()


def noise(seed, m=4096):
    return np.random.default_rng(seed).normal(0, 0.1, (m, 3))


def test_lines_of_every_session_are_found_by_their_size_the_strongest_first():
    at_s, each = np.arange(4096) * 0.1, []
    for seed in range(3):
        rate = noise(seed)
        for hz, axis, dps in ((0.5, 0, 0.1), (1.3, 1, 0.06), (2.2, 2, 0.08), (3.1, 0, 0.05)):
            rate[:, axis] += dps * np.sin(2 * np.pi * hz * at_s + seed)
        rate[:, 1] += 0.1 * np.sin(2 * np.pi * 4.0 * at_s) * (seed == 2)  # in one alone
        rate[100:110] = np.nan
        each.append(lines.spectrum(rate, 0.1, 8192))
    found = lines.find(each, [], 4.0, 0.1)
    assert [line.hz for line in found] == pytest.approx([0.5, 2.2, 1.3], abs=0.002)
    sizes = [line.amplitude_dps.max() for line in found]
    assert sizes == pytest.approx([0.1, 0.08, 0.06], rel=0.15)
    assert [int(line.amplitude_dps.argmax()) for line in found] == [0, 2, 1]
    assert not any(line.in_holdout for line in found)
    held = [line.in_holdout for line in lines.find(each[:2], each[2:], 4.0, 0.1)]
    assert held == [True] * 3
    bare = lines.spectrum(noise(9), 0.1, 8192)
    assert not any(line.in_holdout for line in lines.find(each, [each[0], bare], 4.0, 0.1))
    assert [line.hz for line in lines.find(each, [], 4.0, 0.6)] == pytest.approx(
        [2.2, 1.3, 3.1], abs=0.002
    )


@given(st.lists(st.integers(0, 12_000), max_size=4))
def test_segments_are_those_of_the_whole_and_count_where_all_of_them_rests(cuts):
    n = 6 * lines.SEGMENT + 500
    rate, tick = noise(1, n), np.arange(n) // 50
    rate[:, 0] += 0.5 * np.sin(2 * np.pi * 128 / lines.SEGMENT * np.arange(n))
    segments = lines.Segments()
    for a, b in zip([0, *sorted(cuts)], [*sorted(cuts), n]):
        segments.add(tick[a:b], rate[a:b])
    ends = np.arange(7) * lines.SEGMENT
    assert segments.ticks == [*zip(ends[:-1] // 50, (ends[1:] - 1) // 50)]
    still = np.ones(n // 50 + 1, bool)
    for moving, left in ((slice(0), 6), (0, 5), (41, 4), (100, None)):
        still[moving] = False
        seen = segments.at_rest(still, 50.0)
        assert (seen and seen.averages) == left
    whole = segments.at_rest(np.ones_like(still), 50.0)
    assert whole.step_hz == 50.0 / lines.SEGMENT
    assert whole.power[128, 0] == pytest.approx(0.5**2 / 2, rel=0.1)
    for hz, left in ((44.0, 6), (42.0, None)):  # too short for that rate
        seen = segments.at_rest(np.ones_like(still), hz)
        assert (seen and seen.averages) == left


def test_a_term_is_told_once_for_the_sources_of_a_session():
    one = Session("s", 20.0, 2, np.zeros((4, 3)), np.ones(4), {"temp": np.arange(8.0)})
    late = Term("temp", memory="play", width=2.0)
    told = block_basis(late, one)
    assert told == pytest.approx(play(np.arange(8.0), 2.0).reshape(4, 2).mean(axis=1))
    one.sources["temp"][:] = 0.0
    assert block_basis(late, one) is told
    assert set(one.known) == {late}
    one.sources = {"temp": np.zeros(8)}
    assert not block_basis(late, one).any()
    for k in range(sessions._MOST_KNOWN):
        block_basis(replace(late, width=3.0 + k), one)
    assert len(one.known) == sessions._MOST_KNOWN + 1
    block_basis(replace(late, width=1.0), one)
    assert len(one.known) == 1
