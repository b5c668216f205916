"""Recordings are grouped by device as their owner would expect."""

import copy

import pytest
from zerorate_bench.fleet import in_markdown, on_paper
from zerorate_tools.errors import ZerorateError
from zerorate_tools.fleet import Device, devices_of
from zerorate_tools.fleet.cluster import in_batches
from zerorate_tools.fleet.plots import headline, write_page


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


@pytest.fixture
def hostile(done, tmp_path):
    """The page of a fleet whose files and devices have names that strangers chose."""
    report = copy.deepcopy(done[0].report)
    report["failures"] = [{"device": HOSTILE, "file": HOSTILE, "reason": HOSTILE}]
    report["worst"][0]["device"] = HOSTILE
    report["effects"][0]["unusual_devices"] = [HOSTILE]
    write_page(report, None, tmp_path / "fleet.html")
    return tmp_path / "fleet.html"


def test_the_page_says_what_the_prior_is_worth(done):
    found = done[0].report["prior"]["benefit"]["scenarios"]["at-rest-for-10-s"]
    assert found["prior"]["median_mdps"] < found["without"]["median_mdps"]
    assert f"{found['prior']['median_mdps']:.1f}" in headline(done[0].report)
    assert headline(done[0].report) in (done[1] / "fleet.html").read_text()


def test_names_of_strangers_are_only_names(hostile):
    text = hostile.read_text()
    assert HOSTILE not in text
    assert text.count("&lt;script&gt;document.title") >= 3


def test_a_fleet_too_small_for_a_part_has_a_page_too(tmp_path):
    report = {"devices": 1, "sessions": 0, "hours": 0.0, "sensor": None, "effects": [], "steps": []}
    report |= {
        "job": "replay",
        "prior": None,
        "worst": [],
        "failures": [],
        "left_out_of_the_part": [],
    }
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


def test_a_bench_of_too_few_devices_for_a_prior_says_so():
    million = on_paper({"cpu_s": 1.0, "devices": 6, "out_bytes": 1}, 1.5, 25.0, 1000.0)
    some = {"minutes": 1.5, "odr_hz": 25.0, "bytes_per_recording": 1000.0, "scaling": []}
    assert "it takes 10 devices" in in_markdown({**some, "prior": None, "million": million})
