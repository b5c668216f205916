"""What the plots hold, whoever draws them."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from zerorate import Corrector, Sensor
from zerorate_tools.errors import ZerorateError
from zerorate_tools.layout import AXIS, ESTIMATOR, SETTINGS, axis_at
from zerorate_tools.loop.search.curve import FORMS, KIND
from zerorate_tools.model.effects import EFFECTS
from zerorate_tools.numbers import chance, figure
from zerorate_tools.recordings import open_recording, read_recording
from zerorate_tools.replay import replay
from zerorate_tools.report import kinds
from zerorate_tools.report.estimators import moments
from zerorate_tools.report.held_out import held_out, trend
from zerorate_tools.report.plot import thinned
from zerorate_tools.report.report_folder import plots_of
from zerorate_tools.report.residual_plots import against_time, longest

from host_tests.report.devices import Closed, device


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


@pytest.mark.parametrize(
    ("name", "said"), [("run-4", "run-4"), ("29_disturbed_stationary", "what was held out")]
)
def test_the_label_of_the_time_axis_fits_a_phone(outcome, name, said):
    [part] = held_out(outcome("an effect").analysis)
    panel = against_time([replace(part, name=name)], []).panels[-1]
    assert panel.x_label == f"minutes since the start of {name}"
    assert panel.x_narrow == f"minutes since the start of {said}"


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


def test_heating_and_cooling_are_told_apart(outcome):
    session = outcome("an effect").analysis.holdout[0]
    told = trend(session)
    step = np.diff(session.block_mean(session.sources["temp"]))
    fast = np.abs(step) > 0.2
    assert fast.sum() > 20
    agree = told[1:][fast] == np.sign(step[fast])
    assert agree.mean() > 0.9


def test_every_scored_point_is_in_the_plot_over_temperature_once(outcome, plots):
    scored = np.isfinite(held_out(outcome("an effect").analysis)[0].after_mdps[:, 0]).sum()
    drawn = [s for s in plots["residual-temperature"].series if s.panel == 0]
    assert sum(len(s.x) for s in drawn if s.views == ("after",)) == scored
    assert sum(len(s.x) for s in drawn if s.views == ("before",)) == scored


def test_slots_of_one_source_are_told_apart_and_drawn_as_one_curve(tmp_path):
    effects = [("temperature-cubic", 20.0), ("temperature-quadratic", 10.0)]
    closed = Closed(tmp_path, device(tmp_path, 2, effects, names=["alone"]))
    made, _ = plots_of(closed.analysis, closed.result, closed.logs, closed.folder)
    curve = next(plot for plot in made if plot.key == "effect-1")
    step = closed.result["effects"][0]
    assert step["effect"] == "temperature-curve"
    assert len(step["coefficients"]) == 8
    assert (curve.views, curve.panels[0].x_label) == ((), "temperature, °C")


def test_an_effects_points_lie_about_its_curve(outcome):
    closed = outcome("hostile names")
    made, _ = plots_of(closed.analysis, closed.result, closed.logs, closed.folder)
    effect = next(plot for plot in made if plot.key == "effect-1")
    for a in range(3):
        series = [s for s in effect.series if s.panel == a]
        curve = next(s for s in series if s.name == "correction")
        off = [s.y - np.interp(s.x, curve.x, curve.y) for s in series if s is not curve]
        assert np.std(np.concatenate(off)) < np.ptp(curve.y)


def test_the_allan_deviation_is_of_the_longest_stretch_without_a_gap(outcome):
    parts = held_out(outcome("one recording").analysis)
    scored = np.isfinite(parts[0].after_mdps).all(axis=1)
    runs = "".join("x" if there else " " for there in scored).split()
    assert len(longest(parts)[2]) == max(map(len, runs))


def test_the_floor_is_the_lowest_point_of_the_noise(outcome, plots):
    for a, floor in enumerate(outcome("an effect").result["floor_mdps"]):
        noise = [s for s in plots["allan"].series if s.panel == a and s.role == "floor"][0]
        assert plots["allan"].panels[a].lines[0].value == floor
        assert noise.y.min() == pytest.approx(floor, rel=0.05)


def test_every_kind_that_can_be_found_has_words():
    for kind in (*(row.kind for row in EFFECTS), *FORMS, KIND):
        assert kinds.words_of(kind)[1]


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
    assert kinds.per_unit(slot) == unit


@pytest.mark.parametrize(
    ("value", "said"),
    [
        *((26.3111, "26.3"), (0.808, "0.808"), (1234.5, "1,234"), (99.96, "100"), (-3.2, "−3.20")),
        *((0, "0"), (5.9e-4, "0.000590"), (5.9e-5, "5.9 × 10⁻⁵"), (2.5e7, "2.5 × 10⁷")),
    ],
)
def test_figures_have_three_digits(value, said):
    assert figure(value) == said


def test_a_chance_below_a_millionth_is_not_told_apart():
    assert (chance(3e-51), chance(0.0011)) == ("below 10⁻⁶", "0.00110")


@pytest.fixture(scope="module")
def log(outcome):
    return outcome("an effect").logs[0]


@pytest.fixture(scope="module")
def seen(log):
    return moments([log], every_s=300.0)


def test_one_moment_every_five_minutes(log, seen):
    samples = len(read_recording(log))
    assert len(seen) == -(-samples // 300)
    assert np.diff([m.minute for m in seen])[:-1] == pytest.approx(5.0)


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


def test_a_histogram_holds_its_bias_and_its_edges_rise(seen):
    for m in seen:
        for held in m.axes:
            for e in held:
                assert np.all(np.diff(e.edges_dps) > 0)
                assert e.edges_dps[0] <= e.bias_dps <= e.edges_dps[-1]
                bins = Corrector().settings[SETTINGS.BINS]
                assert len(e.readings) == len(e.edges_dps) - 1 == bins


def test_three_short_and_five_long_are_held_at_most_and_one_learns(seen):
    for held in seen[-1].axes:
        count = {kind: sum(e.kind == kind for e in held) for kind in ("any", "short", "long")}
        assert count["any"] == 1 and 1 <= count["short"] <= 3 and 1 <= count["long"] <= 5
        assert sum(e.in_use for e in held) == 1


def test_what_was_learned_outlasts_the_power_cut(outcome):
    logs = outcome("an effect").logs[:2]
    both = moments(logs, every_s=600.0)
    first = [m for m in both if m.recording == both[0].recording][-1]
    then = next(m for m in both if m.recording != first.recording)
    kept = {round(e.temp_degc) for e in then.axes[0] if e.kind == "long"}
    assert kept & {round(e.temp_degc) for e in first.axes[0] if e.kind == "long"}


def test_a_sensor_that_the_firmware_cannot_take_is_said(tmp_path, outcome):
    from dataclasses import replace as changed

    from zerorate_tools.recordings import write_recording

    whole = read_recording(outcome("nothing").logs[0])
    odd = changed(whole, scales=changed(whole.scales, gyro_lsb_per_dps=9000.0))
    write_recording(odd, tmp_path / "odd.parquet")
    with pytest.raises(ZerorateError, match="gyro_lsb_per_dps"):
        moments([tmp_path / "odd.parquet"])
