"""`replay --plot`: the orientation before and after each pass of the source in motion."""

import sys

import numpy as np
import pytest
from zerorate_tools.cli import main
from zerorate_tools.errors import ZerorateError
from zerorate_tools.recordings import write_recording
from zerorate_tools.replay.passes import plot_windows, windows, windows_to_plot
from zerorate_tools.simulate import simulate

BIAS_DPS = (5.0, -6.0, 3.0)


def recorded(motion, minutes=0.75):
    return simulate(
        {
            "name": "half a minute",
            "seed": 4,
            "sensor": {"odr_hz": 50.0, "gyro_noise_dps": 0.05},
            "bias": {"b0": list(BIAS_DPS)},
            "session": [
                {
                    "temperature": [{"to": 25.0, "minutes": minutes}],
                    "start_degc": 25,
                    "motion": motion,
                }
            ],
        }
    )[0]


@pytest.fixture(scope="module")
def swinging():
    return recorded([{"kind": "swing", "s": 15, "dps": 60, "hz": 0.7}])


@pytest.fixture(scope="module")
def resting():
    return recorded([{"kind": "rest", "s": 15}], minutes=0.4)


def drift(orientation_deg):
    return np.abs(np.polyfit(np.arange(len(orientation_deg)), orientation_deg, 1)[0]).max()


def test_every_pass_of_the_documents_own_form_leaves_less_drift(swinging):
    window = next(windows(swinging, document=True))
    assert window.orientation_deg.shape == (3, 128, 3)
    drifts = [drift(seen) for seen in window.orientation_deg]
    assert drifts[2] < drifts[1] < drifts[0]


def test_the_slopes_of_all_passes_add_up_to_the_bias(swinging):
    window = next(windows(swinging, document=True))
    assert window.slopes_dps.shape == (3, 3)
    assert np.abs(window.slopes_dps.sum(axis=0) - BIAS_DPS).max() < 0.5


def test_each_window_reports_its_own_slopes(swinging):
    found = [w.slopes_dps for w in windows(swinging) if w.reason == "learned"]
    assert len(found) > 1
    assert not any(np.array_equal(one[-1], other[-1]) for one, other in zip(found, found[1:]))


def test_the_latest_window_is_drawn_into_a_png_and_several_into_a_folder(swinging, tmp_path):
    taught = windows_to_plot(swinging, tmp_path / "windows")
    (one,) = plot_windows(taught, tmp_path / "window.png")
    several = plot_windows(taught, tmp_path / "windows")
    assert len(several) > 1
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in [one, *several])


def test_a_recording_without_motion_says_why_there_is_nothing_to_draw(resting, tmp_path):
    with pytest.raises(ZerorateError, match="still"):
        windows_to_plot(resting, tmp_path / "window.png")
    assert not any(tmp_path.iterdir())


def test_the_command_draws_what_it_replayed(swinging, tmp_path, capsys):
    log, picture = tmp_path / "log.parquet", tmp_path / "window.png"
    write_recording(swinging, log)
    options = ["--runtime", "cpython", "--out", str(tmp_path / "out.parquet")]
    assert main(["replay", str(log), "--motion", *options, "--plot", str(picture)]) == 0
    assert str(picture) in capsys.readouterr().out
    assert picture.stat().st_size > 10_000


@pytest.fixture
def refused_plot(swinging, tmp_path, capsys):
    """A function that asks for a plot in vain: what is said of it; nothing is written."""

    def run(plot, *options):
        write_recording(swinging, log := tmp_path / "log.parquet")
        words = ["replay", str(log), "--out", str(tmp_path / "out.parquet"), *options]
        assert main([*words, "--plot", str(tmp_path / plot)]) == 2
        assert list(tmp_path.iterdir()) == [log]
        return capsys.readouterr().err

    return run


def test_a_plot_without_matplotlib_leaves_nothing(refused_plot, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    assert "matplotlib" in refused_plot("window.png")


def test_a_plot_for_a_folder_that_is_not_there_leaves_nothing(refused_plot):
    assert "window.png: its folder is not there" in refused_plot("nowhere/window.png")


def test_a_replay_that_fails_leaves_no_plot(refused_plot):
    assert "no such setting" in refused_plot("windows", "--set", "colour=1")


def test_readings_too_slow_for_a_window_are_said_in_a_line(tmp_path, capsys):
    slow = simulate(
        {
            "name": "slow",
            "sensor": {"odr_hz": 5.0},
            "session": [{"start_degc": 25, "temperature": [{"to": 25.0, "minutes": 1}]}],
        }
    )[0]
    write_recording(slow, tmp_path / "slow.parquet")
    words = ["replay", str(tmp_path / "slow.parquet"), "--out", str(tmp_path / "bias.parquet")]
    assert main([*words, "--plot", str(tmp_path / "window.png")]) == 2
    assert [path.name for path in tmp_path.iterdir()] == ["slow.parquet"]
    said = capsys.readouterr().err
    assert (
        said.startswith("zerorate: slow: learning in motion needs 8 Hz") and said.count("\n") == 1
    )
