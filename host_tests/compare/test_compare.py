"""`compare`: its own judgement, from the log alone, is the truth's wherever it is sure."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq
from zerorate_tools.cli import main
from zerorate_tools.compare import compare, judge
from zerorate_tools.compare.judge import (
    FIRST_REST,
    FRESH,
    NOTHING,
    TAUGHT,
    Compared,
    Rest,
    TooFewRests,
    matrix_of,
)
from zerorate_tools.compare.show import write_page
from zerorate_tools.errors import BadRecording
from zerorate_tools.recordings import Recording, Scales, write_recording
from zerorate_tools.simulate import load_description, simulate

HZ, LSB = 50.0, 131.0


def a_log(path, biases_dps, seed=1, rest_s=20, turn_s=10):
    """Rests of 20 s, each with its bias about all axes, and turns about z between them."""
    random = np.random.default_rng(seed)
    rate = []
    for bias in biases_dps:
        rest = np.full((round(rest_s * HZ), 3), bias)
        turn = np.full((round(turn_s * HZ), 3), bias)
        turn[:, 2] += 60 * np.sin(np.arange(len(turn)) / 40)
        rate += [rest, turn]
    rate = np.concatenate(rate)
    lsb = np.round((rate + random.normal(0, 0.05, rate.shape)) * LSB).astype(int)
    accel = np.round(random.normal(0, 40, rate.shape) + [0, 0, 16384]).astype(int)
    columns = {"t_us": (np.arange(len(rate)) * 1e6 / HZ).astype(np.int64)}
    columns |= {"g" + axis: lsb[:, i] for i, axis in enumerate("xyz")}
    columns |= {"a" + axis: accel[:, i] for i, axis in enumerate("xyz")}
    scales = Scales("MPU-6050", HZ, LSB, 16384.0)
    write_recording(Recording(columns, scales), path)
    return path


@pytest.fixture
def drifting(tmp_path):
    """A log whose bias wanders by 0.1 dps from rest to rest."""
    return a_log(tmp_path / "drifting.parquet", [0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1])


def test_a_log_named_twice_is_refused_as_nothing_was_learned_before_it(drifting, tmp_path):
    copy = tmp_path / "copy.parquet"
    copy.write_bytes(drifting.read_bytes())
    with pytest.raises(BadRecording, match="copy.parquet: holds the same samples as .*drifting"):
        compare([drifting, copy])
    (other := tmp_path / "day2" / "drifting.parquet").parent.mkdir()
    a_log(other, [0.9, 0.6, 0.7])
    with pytest.raises(BadRecording, match="day2.drifting.parquet: has the name of .*drifting"):
        compare([drifting, other])


def test_what_is_known_before_a_rest_is_held_against_it(drifting):
    compared = compare([drifting])
    assert len(compared.rests) == 6
    steps = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    assert compared.error_dps[FIRST_REST][:, 0] == pytest.approx(steps, abs=0.01)
    assert compared.error_dps[NOTHING][:, 2] == pytest.approx(0.5 + steps, abs=0.01)
    assert np.abs(compared.error_dps[FRESH]) == pytest.approx(0.1, abs=0.05)


EARTH_DPS = 15.04 / 3600 / np.sqrt(3)


def told(theirs, sigma_dps=0.0, down=(0.0, 0.0, 1.0)):
    """A comparison at so many rests: zerorate is right, the mean off by (rests, 3)."""
    down = None if down is None else np.array(down)
    rest = Rest(0, 9, 0.0, np.zeros(3), np.full(3, sigma_dps), down)
    errors = {FRESH: np.zeros_like(theirs), FIRST_REST: theirs}
    return Compared(["a"], [(0, rest)] * len(theirs), errors, {})


@pytest.mark.parametrize("share", [0.99, 1.01])
@pytest.mark.parametrize(
    ("rests", "sigma_dps", "limit_dps"),
    [
        *((1, 0.0, 4 * EARTH_DPS), (4, 0.0, 2 * EARTH_DPS), (99, 0.0, np.sqrt(3) * EARTH_DPS)),
        *((1, 0.03, 4 * np.hypot(0.03, EARTH_DPS)), (4, 0.03, 2 * np.hypot(0.03, EARTH_DPS))),
    ],
)
def test_a_way_is_better_beyond_twice_what_the_rests_themselves_do_not_know(
    rests, sigma_dps, limit_dps, share
):
    compared = told(np.full((rests, 3), [share * limit_dps, 0.0, 0.0]), sigma_dps)
    ways = ((FRESH, FIRST_REST), (FIRST_REST, FRESH))
    words = [compared.verdict(*pair).word for pair in ways]
    assert words == ["better", "worse"] if share > 1 else all(w.startswith("no ") for w in words)


def test_five_rests_and_more_show_by_their_scatter_what_is_chance():
    def word(*gains):
        errors = np.outer(np.sqrt(gains), [0.0, 1.0, 0.0])
        return told(errors).verdict(FRESH, FIRST_REST).word

    def beyond(third):
        gain = np.array([1.0, 1.0, third, 0.0, 0.0])
        return gain.mean() - 2 * gain.std(ddof=1) / np.sqrt(5)

    third = brentq(beyond, 0.0, 0.9)
    assert word(1.0, 1.0, 0.98 * third, 0.0, 0.0).startswith("no ")
    assert word(1.0, 1.0, 1.02 * third, 0.0, 0.0) == word(1.0, 1.0, 0.0, 0.0) == "better"


@pytest.mark.parametrize(("down", "lost"), [((0.0, 0.6, 0.8), (0.32, 0.06)), (None, (0.4, 0.0))])
def test_heading_is_lost_about_the_vertical_or_the_worst_axis_where_nobody_knows_it(down, lost):
    compared = told(np.array([[0.3, 0.0, 0.4], [0.0, 0.1, 0.0]]), down=down)
    rms = 60 * np.sqrt(np.mean(np.square(lost)))
    assert compared.heading_deg_per_min(FIRST_REST) == pytest.approx(rms)
    assert compared.verdict(FRESH, FIRST_REST).times == pytest.approx(rms / 1e-9)
    errors = {FIRST_REST: np.full((2, 3), [0.9, 0.0, 0.0]), FRESH: np.full((2, 3), [0.0, 0.0, 0.1])}
    better = "in deg/s better" if down else "9.0 times better"  # about the vertical it is worse
    assert f"{better} than the mean" in replace(compared, error_dps=errors).headline()


def test_what_the_logs_before_taught_counts_from_the_second_log_on(tmp_path):
    logs = [a_log(tmp_path / f"{n}.parquet", [0.5, 0.6, 0.7], seed=n) for n in range(2)]
    compared = compare(logs)
    assert [number for number, _ in compared.rests] == [0, 0, 1, 1]
    first, second = np.split(compared.error_dps[TAUGHT] - compared.error_dps[FRESH], 2)
    assert not first.any() and second.any()


def test_what_is_not_installed_is_said(drifting, monkeypatch):
    monkeypatch.setattr(judge, "find_spec", lambda name: None)
    compared = compare([drifting])
    assert compared.left_out["vqf"] == "not installed: pip install vqf"
    assert "vqf" not in compared.error_dps


@pytest.mark.parametrize("ticks", [3, 6, 30])
def test_a_rest_of_a_few_ticks_knows_its_mean_as_well_as_it_says(ticks):
    means = np.random.default_rng(7).normal(0, 0.05, (ticks, 20_000))
    off = np.abs(means.mean(axis=0)) > 2 * judge.standard_error(means)
    assert 0.04 < off.mean() < 0.05  # of a normal deviate, 4.6 % are beyond two sigma


def test_one_rest_judges_no_method_and_without_motion_the_log_is_refused(tmp_path, capsys):
    log = a_log(tmp_path / "once.parquet", [0.5])
    with pytest.raises(TooFewRests, match="leave it at rest again"):
        compare([log])
    still = a_log(tmp_path / "still.parquet", [0.5], turn_s=0)
    assert main(["compare", str(still)]) == 2


def test_a_page_is_not_written_over_a_recording(drifting, tmp_path, capsys):
    other = tmp_path / "other.parquet"
    other.write_bytes(b"a recording that no page may replace")
    assert main(["compare", str(drifting), "--out", str(other)]) == 2
    assert "end the name in .html" in capsys.readouterr().err
    assert other.read_bytes() == b"a recording that no page may replace"


def test_the_page_needs_no_other_file(drifting, tmp_path, capsys):
    page = tmp_path / "page.html"
    assert main(["compare", str(drifting), "--out", str(page)]) == 0
    text = page.read_text()
    assert "times better" in text and "<svg" in text and "src=" not in text
    said = capsys.readouterr().out
    assert "mean of the first rest" in said and said.endswith(f"\n\n{page}\n")


#: CSS pixels of every text that is shown: of a drawing as it is scaled.
_TEXT_PX = """() => [...document.querySelectorAll("h1, p, th, td, svg text")]
    .filter((e) => e.getClientRects().length && e.textContent.trim())
    .map((e) => {
        const at = e.getScreenCTM ? e.getScreenCTM() : { a: 1, b: 0 };
        return parseFloat(getComputedStyle(e).fontSize) * Math.hypot(at.a, at.b);
    })"""


@pytest.mark.parametrize("width", [390, 1440])
def test_the_page_is_read_on_a_phone_and_on_a_desk(drifting, tmp_path, browser, width):
    write_page(compare([drifting]), tmp_path / "page.html")
    tab = browser.new_page(viewport={"width": width, "height": 844})
    tab.goto((tmp_path / "page.html").as_uri())
    sizes = tab.evaluate(_TEXT_PX)
    wide = tab.evaluate("document.documentElement.scrollWidth")
    drawings = tab.evaluate(
        "[...document.querySelectorAll('svg')].filter((e) => e.getClientRects().length).length"
    )
    tab.close()
    assert (wide, drawings) == (width, 1)
    assert len(sizes) > 40 and min(sizes) >= 12


TRUTH = np.array(load_description("in-hand").effects[0]["matrix"])


def described(matrix, minutes):
    motion = [{"kind": "rest", "s": 5}]
    for axis, face in (("x", "+y"), ("y", "+x"), ("z", "+y")):
        motion.append({"kind": "pose", "face": face, "s": 1.5})
        motion.append({"kind": "swing", "axis": axis, "dps": 150, "hz": [0.2, 0.5], "s": 8.5})
        motion.append({"kind": "turn", "axis": axis, "deg": 300, "s": 4})
    return {
        "sensor": {"odr_hz": 50.0, "gyro_noise_dps": 0.05, "gyro_lsb_per_dps": 65.5},
        "bias": {"b0": [0.4, -0.3, 0.2]},
        "effect": [{"kind": "scale", "dps": 1.0, "matrix": np.asarray(matrix).tolist()}],
        "every_session": {"minutes": minutes, "motion": motion},
    }


@pytest.fixture
def log(tmp_path):
    def write(seed, matrix=TRUTH, attitude=False, minutes=2.0):
        recording, truth = simulate(described(matrix, minutes), seed=seed)
        columns = dict(recording.columns)
        if attitude:
            parts = np.round(truth.attitude * 30000).astype(np.int32)
            columns |= {f"q{n}": parts[:, i] for i, n in enumerate("wxyz")}
        path = tmp_path / f"log-{seed}.parquet"
        write_recording(Recording(columns, recording.scales, path.stem), path)
        return path

    return write


def test_a_log_with_an_attitude_tells_the_heading_that_its_own_other_half_wins(log):
    won = matrix_of([log(1, attitude=True)])
    assert won.deployed and won.turned[1] < 0.5 * won.turned[0]
    assert won.heading[1] < 0.3 * won.heading[0]
    assert won.heading[0] > 1.0
    assert "of heading" in won.sentence() and len(won.rows()) == 3


def test_a_device_that_rests_says_nothing_of_motion(tmp_path):
    description = described(TRUTH, 1.0)
    description["every_session"]["motion"] = [{"kind": "rest", "s": 100}]
    write_recording(simulate(description)[0], tmp_path / "still.parquet")
    assert matrix_of([tmp_path / "still.parquet"]) is None


def test_logs_of_two_devices_are_said_to_be_so(log):
    logs = [log(s, m) for s, m in ((5, TRUTH), (6, TRUTH), (7, -TRUTH), (8, -TRUTH), (9, TRUTH))]
    won = matrix_of(logs)
    assert not won.deployed and "log-7" in won.sentence() and won.rows() == []


def test_a_log_that_never_rests_is_still_told_what_the_matrix_wins(tmp_path, capsys):
    description = described(TRUTH, 1.5)
    del description["every_session"]["motion"][0]
    write_recording(simulate(description)[0], tmp_path / "never.parquet")
    page = tmp_path / "page.html"
    assert main(["compare", str(tmp_path / "never.parquet"), "--out", str(page)]) == 0
    for said in (capsys.readouterr().out, page.read_text()):
        assert "never lay still twice" in said and "In motion the matrix of" in said
    assert "<p>never.parquet</p>" in page.read_text()  # which log it was
