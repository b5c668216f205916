"""Many recordings at once: nothing stops the rest, and what was done stays done."""

import errno
import json
import re
import shutil
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
from zerorate_tools.cli import main
from zerorate_tools.errors import ZerorateError
from zerorate_tools.fleet import devices_of, fleet, whole_fleet
from zerorate_tools.fleet.fleet_in_words import in_words
from zerorate_tools.fleet.job import one_line
from zerorate_tools.fleet.population import Curve
from zerorate_tools.fleet.prior import beginning, benefit, moving_from
from zerorate_tools.fleet.whole_fleet import Parts
from zerorate_tools.model import read_model
from zerorate_tools.recordings import Scales, read_recording, write_recording
from zerorate_tools.replay import replay

from .conftest import DEVICES, run_here


@pytest.fixture(autouse=True)
def alone(monkeypatch):
    run_here(monkeypatch)


def parts_in(out):
    return sorted((out / "parts").glob("[!.]*.parquet"))


def test_the_prior_is_a_model_that_the_firmware_takes(done, data):
    path = done[1] / "prior" / "model.bin"
    assert {slot.term.source for slot in read_model(path).slots} == {"one", "temp"}
    recording = beginning(str(next(data.rglob("*.parquet"))), 0.2)
    moved = replay(moving_from(recording, 0.0), model=path)
    assert np.abs(moved.table["bias_gx"].to_numpy()[-1]) > 1


def test_left_out_devices_gain_by_the_prior(done):
    scenarios = done[0].report["prior"]["benefit"]["scenarios"]
    soon = scenarios["at-rest-for-10-s"]
    assert soon["prior"]["median_mdps"] < 0.6 * soon["without"]["median_mdps"]
    gain = scenarios["always-at-rest"]["gain"]
    assert gain["ci95_mdps"][0] > 0 and gain["share_better"] > 0.7
    assert "error in the first 1.5 minutes" in in_words(done[0])  # no more were recorded


def test_two_hundred_devices_left_out_try_a_prior_in_tasks_of_sixteen():
    names = [f"d{n}" for n in range(203)]
    curve = Curve(np.tile(np.eye(3) * 1e4, (3, 1, 1)), np.zeros((3, 3)), 15.0, 40.0, 50)
    curves = [replace(curve, score=curve.score + n % 7) for n in range(203)]
    row = {"always-at-rest": {"without": 3.0, "prior": 2.0}}
    tasks = []

    def run(function, batches):
        for batch in batches:
            tasks.append(batch)
            found = {name: row for name, _, _ in batch[1:]} | {batch[0][0]: "E: torn"}
            yield batch, KeyError("lost") if len(tasks) == 4 else found

    first = {name: f"{name}.csv" for name in names}
    scales = Scales("X", 25.0, 131.0, None, 340.0, 36.53)
    told = benefit(names, curves, first, scales, 2.0, run)
    assert [len(batch) for batch in tasks] == [16] * 12 + [8]
    devices = [device for batch in tasks for device in batch]
    assert {path for _, path, _ in devices} <= {*first.values()}
    assert len({name for name, *_ in devices}) == 200
    assert Counter(fold for *_, fold in devices) == dict.fromkeys(range(5), 40)
    assert Counter(told["failed"].values()) == {"E: torn": 12, "KeyError: 'lost'": 16}
    assert told["devices"] == told["scenarios"]["always-at-rest"]["devices"] == 172
    assert benefit(names[:9], curves[:9], first, scales, 2.0, run) is None


def test_a_second_run_does_nothing_again(done, data, tmp_path):
    out = shutil.copytree(done[1], tmp_path / "out")
    before = parts_in(out)
    again = fleet(devices_of([data]), out, minutes=None)
    assert (again.resumed, again.tasks) == (DEVICES, 0)
    assert parts_in(out) == before
    assert again.report["effects"] == done[0].report["effects"]


def test_the_devices_of_a_damaged_part_are_done_again(tmp_path):
    parts = Parts(tmp_path)
    parts.add([{"device": "a", "fingerprint": "1", "failures": []}])
    (torn,) = parts._files()
    parts.add([{"device": "b", "fingerprint": "2", "failures": []}])
    torn.write_bytes(torn.read_bytes()[:300])
    assert parts.whole() == {"2"}
    assert [row["device"] for row in parts.results({"a": "1", "b": "2"})] == ["b"]


def test_other_settings_are_another_run(data, tmp_path):
    devices = devices_of([data])[:1]
    first = fleet(devices, tmp_path)
    other = fleet(devices, tmp_path, options={"step_degc": 2.0})
    assert (first.resumed, other.resumed) == (0, 0)


def test_a_full_disk_is_one_line_and_what_was_done_is_kept(data, tmp_path, monkeypatch, capsys):
    write_whole, written = pq.write_table, []

    def write(table, where, **options):
        write_whole(table, where, **options)
        written.append(where)
        if len(written) == 2:
            where.write_bytes(where.read_bytes()[:300])  # torn, as full disks do
            raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("zerorate_tools.fleet.whole_fleet.pq.write_table", write)
    folders = [str(folder) for folder in sorted(data.iterdir())[:3]]
    words = ["fleet", *folders, "--out", str(tmp_path / "out")]
    words += ["--devices-per-task", "1"]
    assert main(words) == 2
    assert re.search(
        r"zerorate: .*: No space left on device; make room.*\n\Z", capsys.readouterr().err
    )
    assert len(list((tmp_path / "out").rglob("*"))) == len(["parts", "one of three"])
    assert main(words) == 0
    said = capsys.readouterr().out
    assert "3 devices" in said and "had done 1 device of these" in said


@pytest.fixture
def with_bad_ones(data, tmp_path):
    """Two good recordings of one device, one damaged, and a device with nothing else."""
    home = tmp_path / "in" / "device=mixed"
    home.mkdir(parents=True)
    for i, path in enumerate(sorted(data.rglob("*.parquet"))[:2]):
        (home / f"s{i}.parquet").write_bytes(path.read_bytes())
    (home / "s2.parquet").write_bytes(b"PAR1 and then nothing")
    (tmp_path / "in" / "lone.csv").write_text("t_us,gx,gy,gz\n0,1,2,3\n")
    return tmp_path


def test_a_failed_recording_is_reported_and_stops_nothing(with_bad_ones, capsys):
    out = with_bad_ones / "out"
    words = ["fleet", str(with_bad_ones / "in"), "--out", str(out)]
    assert main(words) == 0
    report = json.loads((out / "fleet.json").read_text())
    assert (report["devices"], report["sessions"]) == (2, 2)
    reasons = {Path(f["file"]).name: f["reason"] for f in report["failures"]}
    assert set(reasons) == {"s2.parquet", "lone.csv"}
    assert "cut off" in reasons["s2.parquet"] and "lone.json" in reasons["lone.csv"]
    assert "2 left out" in capsys.readouterr().out


@pytest.mark.parametrize(("kind", "said"), [("KilledWorker", "out of memory"), ("E", "E: why")])
def test_a_task_that_is_lost_is_said_of_each_of_its_recordings(
    data, tmp_path, monkeypatch, kind, said
):
    lost = type(kind, (Exception,), {})("why")
    lose = lambda client, function, batches: ((batch, lost) for batch in batches)  # noqa: E731
    monkeypatch.setattr(whole_fleet, "run_all", lose)
    failures = fleet(devices_of([data])[:2], tmp_path).report["failures"]
    assert [(f["device"], said in f["reason"]) for f in failures] == [
        ("00000", True),
        ("00001", True),
    ]


def test_an_error_is_a_line_that_says_its_kind_unless_it_is_our_own():
    errors = ZerorateError("a\n b"), KeyError("c")
    assert [one_line(error) for error in errors] == ["a b", "KeyError: 'c'"]


def test_a_failed_device_is_tried_again_and_the_others_are_not(with_bad_ones):
    devices = devices_of([with_bad_ones / "in"])
    fleet(devices, with_bad_ones / "out")
    (with_bad_ones / "in" / "device=mixed" / "s2.parquet").unlink()
    again = fleet(devices_of([with_bad_ones / "in"]), with_bad_ones / "out")
    assert [Path(f["file"]).name for f in again.report["failures"]] == ["lone.csv"]


def test_close_on_a_recording_too_short_for_it_says_so(data, tmp_path):
    whole = read_recording(next(data.rglob("*.parquet")))
    write_recording(whole.between(0, 10 * 25), tmp_path / "short.parquet")
    done = fleet(devices_of([tmp_path / "short.parquet"]), tmp_path, job="close")
    (failure,) = done.report["failures"]
    assert failure["reason"].startswith("close: ") and "too short" in failure["reason"]


def test_close_that_finds_nothing_says_so(data, tmp_path):
    logs = sorted(data.rglob("*.parquet"))[:1]
    done = fleet(devices_of(logs), tmp_path, job="close")
    assert "close found no effect in any device" in in_words(done)
    assert "found no effect in any device" in (tmp_path / "fleet.html").read_text()


def test_power_ons_of_a_device_remember_those_before(data, tmp_path):
    path = sorted(data.rglob("*.parquet"))[0]
    home = tmp_path / "in" / "device=a"
    home.mkdir(parents=True)
    for name in ("1.parquet", "2.parquet"):
        (home / name).write_bytes(path.read_bytes())
    fleet(devices_of([tmp_path / "in"]), tmp_path / "out", keep=True)
    first, second = (
        pq.read_table(tmp_path / "out" / "devices" / "device=a" / f"{n}.replay.parquet")
        for n in (1, 2)
    )
    assert first["source"][0].as_py() == "none"
    assert second["source"][0].as_py() != "none"
