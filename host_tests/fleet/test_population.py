"""What is said of a part is right about parts whose truth is known."""

import copy

import numpy as np
import pytest
from zerorate_tools.errors import ZerorateError
from zerorate_tools.fleet import Device, devices_of
from zerorate_tools.fleet.cluster import in_batches
from zerorate_tools.fleet.plots import write_page
from zerorate_tools.fleet.population import population

MEAN = np.array([0.5, 0.2, 0.0])
DEVIATION = np.array([1.0, 0.05, 0.02])


def devices(rng, number):
    """Information and score of `number` devices, told with an error of 0.01."""
    true = MEAN + DEVIATION * rng.standard_normal((number, 3))
    information = np.tile(np.eye(3) * 1e4, (number, 1, 1))
    return information, 1e4 * (true + 0.01 * rng.standard_normal((number, 3)))


def test_the_interval_of_the_mean_holds_it_as_often_as_it_says():
    rng, inside = np.random.default_rng(1), []
    for _ in range(200):
        low, high = population(*devices(rng, 15)).interval().T
        inside.append((low <= MEAN) & (high >= MEAN))
    # 95 %, less three deviations of 600 trials
    assert np.mean(inside) > 0.92


@pytest.mark.parametrize("number", [8, 40])
def test_a_device_unlike_the_others_is_named_and_does_not_move_the_mean(number):
    rng = np.random.default_rng(4)
    information, score = devices(rng, number)
    score[7] += information[7] @ [0, 3.0, 0]
    found = population(information, score)
    assert (found.p_unusual < 0.05).nonzero()[0].tolist() == [7]
    assert found.mean[1] == pytest.approx(MEAN[1], abs=3 * DEVIATION[1] / np.sqrt(number))


def test_among_devices_alike_hardly_ever_one_is_called_unusual():
    rng = np.random.default_rng(5)
    called = [(population(*devices(rng, 30)).p_unusual < 0.05).any() for _ in range(100)]
    assert np.mean(called) < 0.15


@pytest.fixture
def folder(tmp_path):
    for name in ("device=b/s2.parquet", "device=b/s10.parquet", "device=a%20b/s.csv", "c.csv.gz"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(b"x" * 10)
    (tmp_path / "notes.txt").write_text("no recording")
    (tmp_path / ".1.partial.d.parquet").write_bytes(b"half")
    return tmp_path


def names(devices):
    return {d.name: [p.rpartition("/")[2] for p in d.recordings] for d in devices}


def test_a_folder_is_partitioned_by_device(folder):
    wanted = {"a b": ["s.csv"], "b": ["s2.parquet", "s10.parquet"], "c": ["c.csv.gz"]}
    assert names(devices_of([folder])) == wanted


def test_a_pattern_finds_what_a_shell_would(folder):
    assert names(devices_of([f"{folder}/**/s*.parquet"])) == {"b": ["s2.parquet", "s10.parquet"]}


def test_a_recording_named_twice_counts_once(folder):
    both = devices_of([folder / "c.csv.gz", folder / "." / "c.csv.gz"])
    assert names(both) == {"c": ["c.csv.gz"]}


def test_an_expression_names_devices(tmp_path):
    for name in ("imu7_mon.csv", "imu7_tue.csv", "imu8_mon.csv"):
        (tmp_path / name).touch()
    found = names(devices_of([tmp_path], device_from=r"imu(\d+)_"))
    assert found == {"7": ["imu7_mon.csv", "imu7_tue.csv"], "8": ["imu8_mon.csv"]}


@pytest.mark.parametrize(
    "expression, said", [("(", "expression"), ("imu", "no group"), ("(q+)", "finds no")]
)
def test_an_expression_that_cannot_do_it_is_refused(folder, expression, said):
    with pytest.raises(ZerorateError, match=said):
        devices_of([folder / "c.csv.gz"], device_from=expression)


def test_a_place_without_recordings_is_said(tmp_path):
    with pytest.raises(ZerorateError, match="no recording there"):
        devices_of([tmp_path / "*.parquet"])


def test_what_a_run_wrote_is_no_input_of_the_next(folder):
    out = folder / "out"
    (out / "devices").mkdir(parents=True)
    (out / "devices" / "s.replay.parquet").touch()
    assert "s.replay" not in names(devices_of([folder], without=out))


def test_every_device_is_in_one_batch():
    devices = [Device(str(i), ()) for i in range(1000)]
    batches = in_batches(devices, workers=2)
    assert [device for batch in batches for device in batch] == devices
    assert max(map(len, batches)) <= 64
    assert len(in_batches(devices[:20], workers=2)) >= 2


def test_large_recordings_make_small_batches(tmp_path):
    path = tmp_path / "large.parquet"
    with path.open("wb") as file:
        file.truncate(40 << 20)
    devices = [Device(str(i), (str(path),)) for i in range(30)]
    assert {len(batch) for batch in in_batches(devices, workers=1)} == {1}


HOSTILE = "<script>document.title='taken'</script>"


def test_names_of_strangers_are_only_names(done, tmp_path):
    report = copy.deepcopy(done[0].report)
    report["failures"] = [{"device": HOSTILE, "file": HOSTILE, "reason": HOSTILE}]
    report["worst"][0]["device"] = HOSTILE
    report["effects"][0]["unusual_devices"] = [HOSTILE]
    write_page(report, None, tmp_path / "fleet.html")
    text = (tmp_path / "fleet.html").read_text()
    assert HOSTILE not in text
    assert text.count("&lt;script&gt;document.title") >= 3


def test_a_fleet_too_small_for_a_part_has_a_page_too(tmp_path):
    report = {"devices": 1, "sessions": 0, "hours": 0.0, "sensor": None, "effects": [], "steps": []}
    report |= {"job": "replay", "prior": None, "worst": [], "failures": []}
    report |= {"left_out_of_the_part": []}
    write_page(report, None, tmp_path / "fleet.html")
    assert "it takes five devices" in (tmp_path / "fleet.html").read_text()


def test_chromium_draws_every_plot_without_a_word(done, browser):
    said = []
    page = browser.new_page(viewport={"width": 390, "height": 844})
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.goto((done[1] / "fleet.html").as_uri())
    page.wait_for_selector("html[data-drawn=all]", state="attached")
    drawn = page.evaluate("document.querySelectorAll('.canvas .main-svg').length")
    wide = page.evaluate("document.documentElement.scrollWidth")
    page.close()
    assert said == []
    assert drawn >= 3 and wide <= 390
