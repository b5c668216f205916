"""What stands in no folder of the tools: words, limits, deviations, results, worked out by hand."""

import errno
import io
import signal
import sys
from math import radians
from types import SimpleNamespace
from unittest.mock import Mock

import numpy as np
import pytest
from zerorate_tools import bounds, cli, closing, numbers, progress
from zerorate_tools.allan import Noise, overlapping
from zerorate_tools.errors import InFile, ZerorateError, os_error_in_words, printable
from zerorate_tools.host import FloatCorrector
from zerorate_tools.model import Slot, build_model, write_model
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales


@pytest.fixture
def heard():
    """heard(corrector): the (words, dt_us) that the integer corrector in it is given from then on;
    its bias is 10, 20 and 30 LSB."""

    def listen(corrector):
        given = []
        corrector.corrector = SimpleNamespace(
            update=lambda sample, dt_us: given.append((list(sample), dt_us)),
            bias_lsb=lambda axis: 10 * (axis + 1),
            sensor=corrector.corrector.sensor,
        )
        return given

    return listen


def test_floats_become_words_of_the_full_scale(heard):
    corrector = FloatCorrector(50, 250.0, 2.0, "rad/s", "m/s2")
    given = heard(corrector)
    said = "1 LSB is 0.000133 rad/s (0.00763 dps) and 0.061 mg"
    assert corrector.said == said
    x, y, z = corrector.update(
        (radians(10), -99.0, 0.0), (9.80665, -4.903325, 999.0), 27.0, dt_s=0.03
    )
    corrector.update((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    assert given == [
        ([16384, -8192, 32767, 680, 1311, -32768, 0], 30_000),
        ([0, 0, 0, 0, 0, 0, 0], 20_000),
    ]
    lsb = radians(250 / 32767)
    assert (x, y, z) == pytest.approx((radians(10) - 10 * lsb, -99 - 20 * lsb, -30 * lsb))


def test_what_the_guard_refuses_and_what_is_no_number_is_counted(heard):
    corrector = FloatCorrector(50)
    given = heard(corrector)
    corrector.update((0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    assert given[0][0][2] == round(32767 / 16)  # g, where no unit is told
    for refused, temp_degc in ((0, 25.0), (3, 25.0), (0, float("inf")), (1, 25.0)):
        corrector.corrector.update = lambda sample, dt_us, said=refused: said
        left = corrector.update((1.0, 2.0, 3.0), (0.0, 0.0, 1.0), temp_degc)
        assert (left == (1.0, 2.0, 3.0)) is (temp_degc == float("inf"))
    assert corrector.update((1.0, 2.0, 3.0), (0.0, 0.0, 1.0), dt_s=float("nan")) == (1.0, 2.0, 3.0)
    assert corrector.refused == 4


def test_ranges_that_are_not_told_are_the_widest_and_a_model_has_its_own(tmp_path):
    sensor = FloatCorrector(50).corrector.sensor
    assert (sensor.gyro_lsb_per_dps, sensor.accel_lsb_per_g) == (32767 / 2000, 32767 / 16)
    slot = Slot(Term("temp", 20, 45, 30), (0.01, 0.0, 0.0))
    write_model(build_model([slot], Scales("X", 50.0, 131.0, None, 340.0, 36.53)), tmp_path)
    own = FloatCorrector(50, model=tmp_path / "model.bin").corrector.sensor
    assert (own.gyro_lsb_per_dps, own.accel_lsb_per_g) == (131.0, 32767 / 16)
    assert (own.temp_lsb_per_degc, own.temp_offset_degc) == (340.0, 36.53)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        *((26.34, "26.3"), (0.808, "0.808"), (1240.4, "1,240"), (5.94e-5, "5.9 × 10⁻⁵")),
        *((0, "0"), (-2.5, "−2.50"), (1e-4, "0.000100"), (9.996e-5, "0.000100")),
        (-9.96e-5, "−1 × 10⁻⁴"),
        *((123456.0, "123,456"), (1e6, "1 × 10⁶"), (-2.5e12, "−2.5 × 10¹²")),
    ],
)
def test_a_figure_has_three_digits(value, text):
    assert numbers.figure(value) == text


@pytest.mark.parametrize(
    ("content", "said"),
    [(b"a" * ((1 << 20) + 1), "more than 1 MiB; do"), (b"\xff", "no text in UTF-8"),
     (None, "no such file; do")],
)  # fmt: skip
def test_a_small_file_of_text_is_one_of_one_mebibyte_at_most(tmp_path, content, said):
    if content is not None:
        (tmp_path / "x").write_bytes(content)
    with pytest.raises(InFile, match=said):
        bounds.text_of(tmp_path / "x", "do")
    with pytest.raises(InFile, match="is no file; do"):
        bounds.text_of(tmp_path, "do")
    (tmp_path / "x").write_bytes(b"a" * (1 << 20))
    assert len(bounds.text_of(tmp_path / "x", "do")) == 1 << 20


def test_a_session_is_held_out_by_its_path_or_its_name_if_it_was_still():
    logs = ["a/x.csv", "a/y.csv", "a/z.csv"]
    for named in ("a/z.csv", "z.csv"):
        assert closing._index(named, logs, ["x", "y", "z"], ["x", "z"]) == 1
    with pytest.raises(ZerorateError, match="none of the recordings given"):
        closing._index("b/z.csv", logs, ["x", "y", "z"], ["x", "z"])
    with pytest.raises(ZerorateError, match="cannot be held out"):
        closing._index("y.csv", logs, ["x", "y", "z"], ["x", "z"])


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGHUP")
def test_a_program_of_its_own_ends_by_a_signal_unless_nohup_ignores_it(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["zerorate", "--help"])
    monkeypatch.setattr(sys, "stdout", sys.stdout)
    monkeypatch.setenv("FORCE_COLOR", "1")  # as on a terminal, for Python 3.14
    before = {n: signal.getsignal(n) for n in (signal.SIGTERM, signal.SIGHUP)}
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with pytest.raises(SystemExit):
            cli.main()
        assert signal.getsignal(signal.SIGTERM) == cli._end
        assert signal.getsignal(signal.SIGHUP) == signal.SIG_IGN
        print("a\x1bb")
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    said = capsys.readouterr().out
    assert said.endswith("a\\x1bb\n") and said.count("\\x1b") == 1


def test_a_name_that_is_no_text_is_shown_with_what_stands_around_it(monkeypatch, capsys):
    name = "a" * 60 + "\udcff" + "b" * 60
    unread = UnicodeEncodeError("utf-8", name, 60, 61, "surrogates not allowed")
    monkeypatch.setattr(cli, "parser", lambda: Mock(parse_args=Mock(side_effect=unread)))
    assert cli.main(["x"]) == 2
    said = capsys.readouterr().err
    assert f" {'a' * 40}\\udcff{'b' * 40}: not UTF-8" in said


def test_the_system_s_own_words_come_with_the_file_s_name_and_what_to_do():
    for number, path, said in (
        (errno.ENOENT, "/dev/i2c-1", "is I2C switched on"),
        (errno.EACCES, "/dev/i2c-1", "usermod"),
        (errno.ENOTDIR, "x/parts", "name a folder"),
    ):
        assert said in os_error_in_words(OSError(number, "words", path))
    assert os_error_in_words(OSError(errno.EACCES, "words", "x")) == "x: words"
    assert os_error_in_words(OSError(errno.EACCES, "words")) == "words"
    assert printable("a\x1b\u202e\tb\n") == "a\\x1b\\u202e\tb\n"


def test_the_allan_deviation_is_that_of_all_pairs_of_means():
    rate = np.cumsum(np.random.default_rng(1).normal(size=(40, 2)), axis=0)
    cluster_s, deviation = overlapping(rate, 0.5)
    for tau_s, found in zip(cluster_s, deviation):
        m = round(tau_s / 0.5)
        means = np.array([rate[i : i + m].mean(axis=0) for i in range(len(rate) - m + 1)])
        expected = np.sqrt(((means[m:] - means[:-m]) ** 2).mean(axis=0) / 2)
        assert found == pytest.approx(expected)
    assert cluster_s.tolist() == [0.5 * m for m in (1, 2, 3, 4, 5, 7, 8, 10, 13)]
    with pytest.raises(ValueError, match="9 samples"):
        overlapping(rate[:8], 1.0)


def test_the_deviation_of_noise_has_its_three_slopes_and_a_floor():
    noise = Noise(2.0, 0.3, 0.0, 0.0)
    assert noise.deviation(np.array([2.0, 8.0])) == pytest.approx([0.3, 0.15])
    walk = Noise(2.0, 0.0, 0.0, 0.3)
    assert walk.deviation(np.array([6.0])) == pytest.approx([0.3])
    flat = Noise(2.0, 0.0, 0.3, 0.0)
    assert flat.deviation(np.array([1.0, 9.0])) == pytest.approx([0.3 * 0.6643] * 2, rel=1e-3)
    assert noise.floor_dps(1.0) == pytest.approx(0.3 / 2**0.5)  # two blocks at least
    assert noise.floor_dps(100.0) == pytest.approx(0.3 / (100 / 6) ** 0.5)
    assert Noise(3.0, 0.3, 0.0, 0.0).floor_dps(1.0) == pytest.approx(0.3 / 2**0.5)
    assert walk.floor_dps(96.0) == pytest.approx(0.3 / 3**0.5)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such limits")
def test_a_child_limits_itself_by_the_file_s_size_and_never_beyond_what_its_user_set(monkeypatch):
    import resource

    put = {}
    hard = {resource.RLIMIT_DATA: -1, resource.RLIMIT_CORE: 0, resource.RLIMIT_CPU: 70}
    used = SimpleNamespace(ru_utime=1.0, ru_stime=2.0)
    monkeypatch.setattr(resource, "getrusage", lambda who: used)
    monkeypatch.setattr(resource, "getrlimit", lambda what: (-1, hard[what]))
    monkeypatch.setattr(resource, "setrlimit", put.__setitem__)
    bounds.limit_myself(1_000_000)
    assert put[resource.RLIMIT_DATA] == (400 << 20, -1) and put[resource.RLIMIT_CORE] == (0, 0)
    assert put[resource.RLIMIT_CPU] == (69, 70)
    bounds.limit_myself(2_000_000)
    assert put[resource.RLIMIT_CPU] == (70, 70)
    hard[resource.RLIMIT_CPU] = 0
    bounds.limit_myself(0)
    assert put[resource.RLIMIT_CPU] == (0, 0)


@pytest.mark.parametrize("terminal", [False, True])
def test_a_pipe_is_told_now_and_then_how_long_it_takes_and_a_terminal_has_a_bar(
    monkeypatch, terminal
):
    told = io.StringIO()
    told.isatty = lambda: terminal
    monkeypatch.setattr(sys, "stderr", told)
    monkeypatch.setattr(progress, "QUIET_S", 0.001)
    with progress.waiting("fetching"):
        while not told.getvalue():
            pass
    assert ("fetching: 0 s so far" in told.getvalue()) is not terminal
