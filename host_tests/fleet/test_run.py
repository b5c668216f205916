"""Many recordings at once: nothing stops the rest, and what was done stays done."""

import errno
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
from zerorate_tools.cli import main
from zerorate_tools.errors import MissingLibrary, ZerorateError
from zerorate_tools.fleet import devices_of, fleet
from zerorate_tools.fleet.cluster import _safe_path, cluster, run_all
from zerorate_tools.fleet.fleet_in_words import in_words
from zerorate_tools.fleet.prior import beginning, moving_from
from zerorate_tools.fleet.whole_fleet import Parts
from zerorate_tools.model import read_model
from zerorate_tools.recordings import read_recording, write_recording
from zerorate_tools.replay import replay

from .conftest import DEVICES


def parts_in(out):
    return sorted((out / "parts").glob("[!.]*.parquet"))


def test_the_table_has_a_row_for_each_device_and_effect(done):
    table = pq.read_table(done[1] / "fleet.parquet").to_pandas()
    assert table.groupby("effect")["device"].nunique().to_dict() == {
        "level": DEVICES,
        "slope": DEVICES,
        "curvature": DEVICES,
    }
    assert (table["error_x"] > 0).all() and not table["own_x"].isna().any()


def test_what_is_common_is_told_from_what_is_each_devices_own(done):
    level, slope, _ = done[0].report["effects"]
    assert slope["verdict"][0] == "common"
    assert "by device" in level["verdict"][2]
    low, high = slope["ci95"][0]
    assert low < 0.025 + 2 * 3e-4 * (done[0].report["reference_degc"] - 25) < high


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


def test_a_prior_is_tried_over_no_more_minutes_than_were_recorded(done, data, tmp_path, scheduler):
    shutil.copytree(done[1] / "parts", tmp_path / "parts")
    again = fleet(devices_of([data]), tmp_path, scheduler=scheduler)
    assert again.report["prior"]["benefit"]["minutes"] == 1.5
    assert "error in the first 1.5 minutes" in in_words(again)


def test_a_second_run_does_nothing_again(done, data, tmp_path, scheduler):
    out = shutil.copytree(done[1], tmp_path / "out")
    before = parts_in(out)
    again = fleet(devices_of([data]), out, scheduler=scheduler, minutes=None)
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


def test_without_a_cache_it_runs_and_says_so_once(data, tmp_path):
    home = tmp_path / "not a folder"
    home.write_text("")
    environment = {name: text for name, text in os.environ.items() if name != "XDG_CACHE_HOME"}
    environment.update(HOME=str(home), ZERORATE_CACHE="")
    folders = sorted(str(path.parent) for path in data.rglob("*.parquet"))[:2]
    command = [sys.executable, "-m", "zerorate_tools.cli", "fleet", *folders, "--workers", "1"]
    command += ["--out", str(tmp_path / "out"), "--minutes", "1"]
    ran = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert ran.stderr.count("no cache can be kept (Not a directory)") == 1
    report = json.loads((tmp_path / "out" / "fleet.json").read_text())
    assert (report["devices"], report["failures"]) == (2, [])


def test_other_settings_are_another_run(data, tmp_path, scheduler):
    devices = devices_of([data])[:1]
    first = fleet(devices, tmp_path, scheduler=scheduler)
    other = fleet(devices, tmp_path, scheduler=scheduler, options={"step_degc": 2.0})
    assert (first.resumed, other.resumed) == (0, 0)


def test_a_run_cut_off_goes_on_where_it_stopped(data, tmp_path, scheduler):
    command = [sys.executable, "-m", "zerorate_tools.cli", "fleet", str(data)]
    options = ["--out", str(tmp_path), "--workers", "1", "--devices-per-task", "1"]
    run = subprocess.Popen([*command, *options], start_new_session=True)
    while not parts_in(tmp_path) and run.poll() is None:
        time.sleep(0.01)
    os.killpg(run.pid, signal.SIGKILL)
    run.wait()
    kept = len(parts_in(tmp_path))
    assert 1 <= kept < DEVICES
    options = {"scheduler": scheduler, "devices_per_task": 1, "minutes": None}
    again = fleet(devices_of([data]), tmp_path, **options)
    assert (again.resumed, again.tasks) == (kept, DEVICES - kept)
    assert again.report["devices"] == DEVICES and not again.report["failures"]


def test_a_full_disk_is_one_line_and_what_was_done_is_kept(
    data, tmp_path, scheduler, monkeypatch, capsys
):
    write_whole, written = pq.write_table, []

    def write(table, where, **options):
        write_whole(table, where, **options)
        written.append(where)
        if len(written) == 2:
            where.write_bytes(where.read_bytes()[:300])  # torn, as full disks do
            raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("zerorate_tools.fleet.whole_fleet.pq.write_table", write)
    folders = [str(folder) for folder in sorted(data.iterdir())[:3]]
    words = ["fleet", *folders, "--out", str(tmp_path / "out"), "--scheduler", scheduler]
    words += ["--devices-per-task", "1"]
    assert main(words) == 2
    assert re.search(
        r"zerorate: .*: No space left on device; make room.*\n\Z", capsys.readouterr().err
    )
    assert len(list((tmp_path / "out").rglob("*"))) == len(["parts", "one of three"])
    assert main(words) == 0
    assert "3 devices" in capsys.readouterr().out


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


def test_a_failed_recording_is_reported_and_stops_nothing(with_bad_ones, scheduler, capsys):
    out = with_bad_ones / "out"
    words = ["fleet", str(with_bad_ones / "in"), "--out", str(out), "--scheduler", scheduler]
    assert main(words) == 0
    report = json.loads((out / "fleet.json").read_text())
    assert (report["devices"], report["sessions"]) == (2, 2)
    reasons = {Path(f["file"]).name: f["reason"] for f in report["failures"]}
    assert set(reasons) == {"s2.parquet", "lone.csv"}
    assert "cut off" in reasons["s2.parquet"] and "lone.json" in reasons["lone.csv"]
    assert all("\n" not in reason for reason in reasons.values())
    assert "2 left out" in capsys.readouterr().out


def test_a_failed_device_is_tried_again_and_the_others_are_not(with_bad_ones, scheduler):
    devices = devices_of([with_bad_ones / "in"])
    fleet(devices, with_bad_ones / "out", scheduler=scheduler)
    (with_bad_ones / "in" / "device=mixed" / "s2.parquet").unlink()
    again = fleet(devices_of([with_bad_ones / "in"]), with_bad_ones / "out", scheduler=scheduler)
    assert [Path(f["file"]).name for f in again.report["failures"]] == ["lone.csv"]


def test_close_on_a_recording_too_short_for_it_says_so(data, tmp_path, scheduler):
    whole = read_recording(next(data.rglob("*.parquet")))
    write_recording(whole.between(0, 10 * 25), tmp_path / "short.parquet")
    done = fleet(
        devices_of([tmp_path / "short.parquet"]), tmp_path, job="close", scheduler=scheduler
    )
    (failure,) = done.report["failures"]
    assert failure["reason"].startswith("close: ") and "too short" in failure["reason"]


def test_close_that_finds_nothing_says_so(data, tmp_path, scheduler):
    logs = sorted(data.rglob("*.parquet"))[:1]
    done = fleet(devices_of(logs), tmp_path, job="close", scheduler=scheduler)
    assert "close found no effect in any device" in in_words(done)
    assert "found no effect in any device" in (tmp_path / "fleet.html").read_text()


def test_without_dask_nothing_is_left_behind(data, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "dask", None)
    with pytest.raises(MissingLibrary):
        fleet(devices_of([data]), tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_power_ons_of_a_device_remember_those_before(data, tmp_path, scheduler):
    path = sorted(data.rglob("*.parquet"))[0]
    home = tmp_path / "in" / "device=a"
    home.mkdir(parents=True)
    for name in ("1.parquet", "2.parquet"):
        (home / name).write_bytes(path.read_bytes())
    fleet(devices_of([tmp_path / "in"]), tmp_path / "out", scheduler=scheduler, keep=True)
    first, second = (
        pq.read_table(tmp_path / "out" / "devices" / "device=a" / f"{n}.replay.parquet")
        for n in (1, 2)
    )
    assert first["source"][0].as_py() == "none"
    assert second["source"][0].as_py() != "none"


def double_or_die(batch):
    if "die" in batch:
        os._exit(1)
    return [2 * item for item in batch]


@pytest.mark.parametrize("before", [None, "0"])
def test_the_callers_environment_is_afterwards_as_it_was(before, monkeypatch):
    monkeypatch.delenv("PYTHONSAFEPATH", raising=False)
    if before is not None:
        monkeypatch.setenv("PYTHONSAFEPATH", before)
    with pytest.raises(KeyError), _safe_path():
        assert os.environ["PYTHONSAFEPATH"] == "1"
        raise KeyError
    assert os.environ.get("PYTHONSAFEPATH") == before


def test_a_batch_whose_worker_dies_costs_only_the_item_that_killed_it():
    import distributed

    with cluster(workers=1) as client:
        batches = [["a", "die", "b"], ["c"]]
        results = {tuple(b): result for b, result in run_all(client, double_or_die, batches)}
    died = results.pop(("die",))
    assert isinstance(died, distributed.scheduler.KilledWorker)
    assert results == {("a",): ["aa"], ("b",): ["bb"], ("c",): ["cc"]}


def test_more_batches_than_the_scheduler_may_hold_all_come_back(monkeypatch):
    monkeypatch.setattr("zerorate_tools.fleet.cluster.MOST_WAITING", 3)
    with cluster(workers=1) as client:
        results = list(run_all(client, partial(map, abs), [[i] for i in range(20)]))
    assert sorted(batch[0] for batch, _ in results) == list(range(20))


def test_a_scheduler_that_does_not_answer_is_said(data, tmp_path, monkeypatch):
    monkeypatch.setattr("zerorate_tools.fleet.cluster._CONNECT_S", 0.2)
    with pytest.raises(ZerorateError, match="no Dask scheduler answers"):
        fleet(devices_of([data])[:1], tmp_path, scheduler="tcp://127.0.0.1:9")
