"""`record --guide`: what it asks for, when it ends, and what the recording it made then gives."""

import contextlib
import io

import numpy as np
import pytest
from rich.console import Console
from rich.live import Live
from zerorate_fakes import FakeClock
from zerorate_tools.boards import fake_hand, port
from zerorate_tools.boards.bus import record_bus
from zerorate_tools.boards.port import record_port
from zerorate_tools.cli import main
from zerorate_tools.closing import close
from zerorate_tools.guide import (
    KNOWN,
    NAMES,
    Bars,
    Guide,
    KnownSoFar,
    asked,
    left,
    notes,
    shares,
    unknown,
)
from zerorate_tools.loop.motion.device import SIZES
from zerorate_tools.recordings import read_recording
from zerorate_tools.simulate import load_description, simulate

from ..tools.killed_recorders import Board


def described(motion, minutes=0.8):
    """The device of the bundled scenario, moved otherwise."""
    description = load_description("in-hand")
    session = {"minutes": minutes, "motion": motion}
    effect = [{"kind": "scale", "dps": 1.0, "matrix": truth().tolist()}]
    sensor = {"odr_hz": 100.0, "gyro_noise_dps": 0.05}
    bias = {"b0": [0.4, -0.3, 0.2]}
    return {"name": description.name, "sensor": sensor, "bias": bias, "effect": effect} | {
        "every_session": session
    }


def truth():
    """(3, 3) what the emulated device's gyroscope adds."""
    return np.array(load_description("in-hand").effects[0]["matrix"])


def fed(recording, look_s=5.0):
    """What is known at the end of a recording, fed at speed."""
    known, n = KnownSoFar(recording.scales), round(look_s * recording.scales.odr_hz)
    for first in range(0, len(recording), n):
        known.look([{k: v[first : first + n] for k, v in recording.columns.items()}])
        if known.all_known:
            break
    return known


def swings(*axes, faces=("+y", "+x", "+y")):
    """Turns about axes held level, one after the other."""
    bouts = [{"kind": "rest", "s": 5}]
    for axis in axes:
        bouts.append({"kind": "pose", "face": faces["xyz".index(axis)], "s": 1.5})
        bouts.append({"kind": "swing", "axis": axis, "dps": 180, "hz": 0.4, "s": 8.5})
    return bouts


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """(file, printed) of a recording of the emulated hand, made by the command."""
    out = tmp_path_factory.mktemp("guided") / "run.parquet"
    with pytest.MonkeyPatch.context() as patched:
        said = io.StringIO()
        patched.setattr("sys.stdout", said)
        assert main(["record", "fake:", "--guide", "--out", str(out)]) == 0
    return out, said.getvalue()


def test_it_ends_by_itself_within_two_minutes_when_all_nine_are_known(recorded):
    out, said = recorded
    assert read_recording(out).columns["t_us"][-1] < 120e6
    assert "9 of 9" in said and "not known" not in said


def test_the_recording_closed_gives_the_matrix_within_its_intervals(recorded, tmp_path):
    result = close([recorded[0]], tmp_path / "closed")
    motion = result["in_motion"]
    off = np.array(motion["matrix_percent"]) / 100 - truth()
    assert result["effects"]
    # 3.5 sigma, which the largest of nine exceeds once in 240 times
    assert (np.abs(off) < 1.8 * np.array(motion["ci95_percent"]) / 100).all()
    assert np.abs(off).max() < 1.5 * KNOWN


@pytest.fixture(scope="module")
def planar():
    """What is known of a device turned about x alone."""
    return fed(simulate(described(swings("x")))[0])


def test_planar_motion_asks_for_an_axis_that_was_not_turned(planar):
    known = planar
    assert not known.all_known
    assert known.next_axis in (1, 2)
    assert {"scale of y", "scale of z"} <= set(unknown(known))
    assert "scale of x" not in unknown(known)


def test_of_two_axes_turned_the_third_is_asked_for():
    known = fed(simulate(described(swings("x", "z")))[0])
    assert known.next_axis == 1 and "about y" in asked(known)


def test_a_device_that_only_rests_shows_nothing():
    known = fed(simulate(described([{"kind": "rest", "s": 60}], minutes=1.0))[0])
    assert unknown(known) == NAMES and not known.lately_dps.max() > 1.0


def test_what_is_known_does_not_wait_for_the_end_nor_cost_more_the_longer_it_lasts():
    """Parts that are done are kept as what they state."""
    recording, _ = simulate(described(swings("x"), minutes=2.0))
    known = fed(recording, look_s=30.0)
    assert sum(len(batch["t_us"]) for batch in known._batches) == 0
    assert known.sigma[0, 0] < 2 * KNOWN and known._kept.normal.any()


def test_what_is_said_of_nine_entries_names_the_worst_and_what_to_turn():
    known = KnownSoFar(load_description("in-hand").sensor)
    known.sigma = np.full((3, 3), 0.0005)
    known.confirmed, known.seconds, known.next_axis = known.sigma.copy(), 12.4, 2
    known.sigma[1, 2] = 0.02
    known.lately_dps, known.clipped = np.array([1.0, 9.0, 2.0]), 3
    assert left(known) == "8 of 9 known to 0.1 %, worst: y from z ±2.00 %"
    assert notes(known) == [
        "12 s; turning about y",
        "3 samples are clipped: turn more slowly, or widen the range",
    ]
    assert asked(known).startswith("Turn it about z: hold z level")
    known.sigma[1, 2], known.confirmed[0, 0], known.lately_dps[1] = 0.0005, 0.003, 5.0
    assert left(known).endswith("worst without a quarter of it: scale of x ±0.30 %")
    assert notes(known)[0] == "12 s; not turning" and asked(known).startswith("Once more, turn")
    known.confirmed[0, 0], known.seconds = 0.001, 4.9
    assert asked(known) == "All nine are known. Put it down."
    known.sigma[0, 0] = 0.0011
    assert asked(known) == "Leave it untouched for five seconds."
    shown = shares(np.array([SIZES[-1] * 2, SIZES[-1], np.sqrt(SIZES[-1] * KNOWN), KNOWN, 1e-5]))
    assert shown == pytest.approx([0.0, 0.0, 0.5, 1.0, 1.0])


def test_samples_at_the_rail_are_counted():
    recording, _ = simulate(described([{"kind": "swing", "axis": "z", "dps": 400, "s": 20}], 0.3))
    assert fed(recording).clipped > 100


def test_a_guide_beside_the_recording_sees_what_one_that_waits_sees(tmp_path):
    seen = {}
    for waits in (True, False):
        bus, clock, _ = fake_hand.in_hand()
        with Guide(Silent(), waits=waits) as guide:
            record_bus(
                *(bus, tmp_path / f"{waits}.parquet"),
                seconds=30,
                time_source=clock,
                heard=guide.heard,
                done=guide.done,
            )
            seen[waits] = guide.known.seconds
    assert seen[True] == pytest.approx(30, abs=3) and 0 < seen[False] <= 30


class Played:
    """Samples of a recording, as killed_recorders.Board takes them."""

    def __init__(self, recording):
        names = ("ax", "ay", "az", None, "gx", "gy", "gz")
        none = np.zeros(len(recording), int)
        words = np.column_stack([recording.columns.get(n, none) for n in names])
        self.made, self.most, self._rows = 0, len(words) - 1, words.tolist()

    def __iter__(self):
        for number, row in enumerate(self._rows):
            self.made = number
            yield row


def test_a_board_on_a_serial_port_is_guided_alike(tmp_path, monkeypatch):
    recording, _ = simulate("in-hand")
    board = Board(Played(recording))
    monkeypatch.setattr(port, "connected", lambda name: contextlib.nullcontext(board))
    with Guide(Silent(), waits=True) as guide:
        result = record_port(
            "/dev/ttyACM0", tmp_path / "run.parquet", heard=guide.heard, done=guide.done
        )
    assert guide.known.all_known and 40 < result.seconds < 120


class Silent:
    def show(self, known):
        pass


def test_a_recording_that_ends_before_says_what_is_not_known(tmp_path, capsys):
    out = tmp_path / "run.parquet"
    assert main(["record", "fake:", "--guide", "--seconds", "20", "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "not known yet: scale of x" in said and "zerorate close" in said


def test_a_recording_that_is_told_it_is_enough_ends_and_keeps_all(tmp_path):
    bus, clock, _ = fake_hand.in_hand()
    result = record_bus(bus, tmp_path / "x.csv", time_source=clock, done=lambda s: True)
    assert isinstance(clock, FakeClock) and 0.9 < result.seconds < 1.5


def test_nine_bars_are_drawn_and_fill_as_entries_become_known(planar):
    console = Console(file=io.StringIO(), force_terminal=True, width=80, height=30)
    with Live(console=console, auto_refresh=False) as area:
        Bars(area).show(planar)
    text = console.file.getvalue()
    assert all(name in text for name in NAMES)
    filled = shares(planar.sigma)
    assert filled[0, 0] == 1.0 and filled[2, 2] < 0.1
