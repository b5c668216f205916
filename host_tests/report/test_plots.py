"""What the plots hold, whoever draws them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from zerorate import Corrector, Sensor
from zerorate_tools.layout import AXIS, ESTIMATOR, SETTINGS, axis_at
from zerorate_tools.loop.search.curve import FORMS, KIND
from zerorate_tools.model.effects import EFFECTS
from zerorate_tools.recordings import open_recording
from zerorate_tools.replay import replay
from zerorate_tools.report import sentences
from zerorate_tools.report.estimators import moments
from zerorate_tools.report.plot import thinned
from zerorate_tools.report.report_folder import plots_of
from zerorate_tools.report.residual_plots import HeldOut, against_time, longest


@pytest.fixture(scope="module")
def plots(outcome):
    closed = outcome("an effect")
    made, notes = plots_of(closed.analysis, closed.result, closed.logs, closed.folder)
    assert notes == []
    return {plot.key: plot for plot in made}


@given(st.integers(0, 4000), st.integers(0, 2**32 - 1))
def test_thinning_keeps_the_extremes_and_the_order(n, seed):
    y = np.random.default_rng(seed).normal(size=n)
    x, kept = thinned(np.arange(n), y, 300)
    assert len(x) <= max(300, 0) and np.all(np.diff(x) > 0)
    assert np.array_equal(kept, y[x])
    if n:
        assert kept.min() == y.min() and kept.max() == y.max()


def test_thinning_keeps_a_gap():
    y = np.ones(5000)
    y[2000:3000] = np.nan
    assert np.isnan(thinned(np.arange(5000), y, 100)[1]).any()


def test_the_error_drawn_has_the_root_mean_square_that_is_said(outcome, plots):
    for a in range(3):
        for name in ("before", "after"):
            drawn = [s for s in plots["residual-time"].series if s.panel == a and s.name == name]
            rms = np.sqrt(np.nanmean(drawn[0].y ** 2))
            said = outcome("an effect").result[f"{name}_mdps"][a]
            assert rms == pytest.approx(said, abs=1e-4)


def test_the_floor_is_the_lowest_point_of_the_noise(outcome, plots):
    for a, floor in enumerate(outcome("an effect").result["floor_mdps"]):
        noise = [s for s in plots["allan"].series if s.panel == a and s.role == "floor"][0]
        assert plots["allan"].panels[a].lines[0].value == floor
        assert noise.y.min() == pytest.approx(floor, rel=0.05)


def test_every_kind_that_can_be_found_has_words():
    for kind in (*(row.kind for row in EFFECTS), *FORMS, KIND):
        assert sentences.words_of(kind)[1]


@pytest.mark.parametrize(
    ("slot", "unit"),
    [
        ({"source": "temp", "power": 1}, "mdps per °C"),
        ({"source": "temp", "power": 2}, "mdps per °C²"),
        ({"source": "temp", "lag_mode": "rate"}, "mdps per (°C per s)"),
        ({"source": "vdd_mv", "second": "temp"}, "mdps per (mV × °C)"),
        ({"source": "load", "power": 2}, "mdps per (unit of load)²"),
        ({"source": "one", "decay_s": 300.0}, "mdps"),
    ],
)
def test_a_coefficient_has_its_unit(slot, unit):
    assert sentences.per_unit(slot) == unit


@pytest.fixture(scope="module")
def log(outcome):
    return outcome("an effect").logs[0]


@pytest.fixture(scope="module")
def seen(log):
    return moments([log], None, 300.0)


def test_the_last_moment_is_the_state_that_a_replay_ends_in(log, seen):
    state = np.frombuffer(replay(log).state, "<i4")
    scales = open_recording(log).scales
    settings = Corrector(
        Sensor(
            *(scales.odr_hz, scales.gyro_lsb_per_dps, scales.accel_lsb_per_g),
            *(scales.temp_lsb_per_degc, scales.temp_offset_degc),
        )
    ).settings
    for axis in range(3):
        first = axis_at(settings, axis) + AXIS.ESTIMATORS + ESTIMATOR.EST_BIAS_Q8
        biases = state[first :: settings[SETTINGS.ESTIMATOR_WORDS]] / 256 / scales.gyro_lsb_per_dps
        biases = biases[: settings[SETTINGS.ESTIMATOR_COUNT]]
        shown = [e.bias_dps for e in seen[-1].axes[axis]]
        assert shown[0] == pytest.approx(biases[0])
        assert set(np.round(shown, 9)) <= set(np.round(biases, 9))


def part(blocks, gap=None, name="a"):
    left = np.ones((blocks, 3))
    if gap is not None:
        left[gap] = np.nan
    minutes = (np.arange(blocks) + 0.5) / 3
    return HeldOut(name, minutes, 20.0, None, np.zeros(blocks, int), left, left / 2, 0)


def test_the_longest_stretch_has_nine_blocks_or_is_none():
    assert longest([part(8), part(19, 10)])[1].shape == (10, 3)
    assert longest([part(9)])[1].shape == (9, 3) and longest([part(8)]) is None


def test_held_out_recordings_are_laid_end_to_end():
    step = {"recording": "b", "t_us": 60_000_000}
    plot = against_time([part(9), part(12, name="b")], [step])
    assert plot.series[-1].x[0] == pytest.approx(9 / 3 + 0.5 / 3)
    assert [line.value for line in plot.panels[0].lines] == [0.0, pytest.approx(9 / 3 + 1.0)]
