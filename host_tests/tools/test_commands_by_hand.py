"""What commands do beside the function behind them: what they print, fetch, serve and refuse."""

import errno
import fcntl
import os
import sys
import time
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import Mock, call

import pytest
from zerorate_tools import cli
from zerorate_tools.errors import MissingRuntime, ZerorateError

pytestmark = pytest.mark.usefixtures("own_folder")
NONE = SimpleNamespace(samples=0, resumed=0, report={"sessions": 0})


@pytest.mark.parametrize(
    ("words", "function", "nothing"),
    [
        ("fleet run.parquet --out o --json", "fleet.fleet", NONE),
        ("record 0 --out o.csv", "boards.recording.record", NONE),
        ("record fake: --out o.csv --guide", "boards.recording.record", NONE),
    ],
)
def test_1_says_that_nothing_came(stands_in, words, function, nothing, capsys):
    stands_in(f"zerorate_tools.{function}", nothing)
    assert cli.main(words.split()) == 1
    assert words[:6] != "record" or "no sample came" in capsys.readouterr().out


def test_without_its_package_bench_says_what_to_install(monkeypatch, capsys):
    from zerorate_tools.commands import demo

    monkeypatch.setattr(demo, "find_spec", lambda name: None)
    monkeypatch.setattr(cli, "parser", cli.parser.__wrapped__)
    assert cli.main(["bench", "accuracy"]) == 2
    assert "the wheel has no benchmarks" in capsys.readouterr().err


@pytest.mark.parametrize(("runtime", "fetched"), [("./mine", False), ("armhf", True)])
def test_an_interpreter_that_was_asked_for_is_none_other_and_ones_own_is_not_fetched(
    stands_in, capsys, runtime, fetched
):
    stands_in("zerorate_tools.runtimes.find", MissingRuntime("not there"))
    fetch = stands_in("zerorate_tools.runtimes.fetch", MissingRuntime("not there either"))
    assert cli.main(["demo", "--runtime", runtime]) == 2 and fetch.called is fetched
    assert "not there" in capsys.readouterr().err


# --- record ---


def test_record_says_what_a_killed_one_left(stands_in, capsys):
    stands_in("zerorate_tools.boards.recording.record", SimpleNamespace(samples=1))
    stands_in("zerorate_tools.recordings.growing.left_over", ["a.partial.csv", "b.partial.csv"])
    cli.main(["record", "0", "--out", "o.csv"])
    said = capsys.readouterr().err.splitlines()
    assert [line.partition(":")[0] for line in said] == ["a.partial.csv", "b.partial.csv"]
    assert "--recover b.partial.csv" in said[1]


@pytest.mark.parametrize("words", ["", "P --recover x.csv", "P", "--out o.csv"])
def test_record_needs_a_port_and_a_file_or_what_to_recover(words, capsys):
    assert cli.main(["record", *words.split()]) == 2
    assert "name " in capsys.readouterr().err


# --- run ---


@pytest.fixture
def serving(stands_in, monkeypatch):
    """What the service is made of, and what opens a bus of Linux."""
    service = stands_in("zerorate_tools.service.Service", SimpleNamespace(run=lambda: None))
    stands_in("signal.signal")
    imu = stands_in("zerorate_i2c.mpu6050.MPU6050", "imu")
    bus = SimpleNamespace(close=Mock())
    linux = stands_in("zerorate_i2c.linux.LinuxI2C", bus)
    made = {
        name: stands_in(f"zerorate_tools.service.{name}", name)
        for name in ("Datagrams", "Metrics", "UnixSocket", "Lines", "FakeBus")
    }
    return SimpleNamespace(service=service, imu=imu, bus=bus, linux=linux, **made)


def test_run_serves_lines_unless_told(serving, capsys):
    assert cli.main(["run", "7"]) == 0
    system, sinks, model, _ = serving.service.call_args.args
    assert sinks == ["Lines"] and model == b"" and not serving.FakeBus.called
    assert system.open_imu() == "imu" and serving.linux.call_args.args == ("/dev/i2c-7",)
    assert serving.imu.call_args == call(serving.bus)  # which has the defaults
    Path("learned.bin").touch()
    os.utime("learned.bin", (0, time.time() - 500))
    assert system.stored_ago_s() == pytest.approx(500, abs=60)
    system.say("a line")
    assert capsys.readouterr().err == "a line\n"


def test_run_is_given_what_was_typed(serving):
    Path("m.bin").write_bytes(b"model")
    words = "--address 0x69 --hz 50 --dps 500 --g 8 --dlpf-hz 20 --part mpu6500 --model m.bin"
    words += " --udp h:1 --metrics h:2 --socket s --remote"
    assert cli.main(["run", "fake:", *words.split()]) == 0
    system, sinks, *model = serving.service.call_args.args
    assert sinks == ["Datagrams", "Metrics", "UnixSocket"] and model == [b"model", "m.bin"]
    assert serving.Datagrams.call_args == call("h:1", True)
    assert serving.Metrics.call_args == call("h:2", True)
    assert serving.FakeBus.call_args == call(address=0x69, part="mpu6500")
    assert system.open_imu() == "imu" and not serving.linux.called
    typed = {"odr_hz": 50, "full_scale_dps": 500, "full_scale_g": 8, "dlpf_hz": 20}
    assert serving.imu.call_args == call("FakeBus", address=0x69, part="mpu6500", **typed)
    assert cli.main(["run", "fake:", "--udp", "h:1"]) == 0
    assert serving.Datagrams.call_args.args == ("h:1", False)


def test_a_model_in_words_is_turned_into_bytes_for_the_service(serving, stands_in):
    read = stands_in("zerorate_tools.model.read_model", "model")
    stands_in("zerorate_tools.model.encoded", b"bytes of it")
    cli.main(["run", "fake:", "--model", "m.json"])
    assert serving.service.call_args.args[2] == b"bytes of it"
    assert read.call_args == call(Path("m.json"))


def test_an_open_bus_is_closed_where_no_chip_answers_and_a_wrong_setting_is_one_line(serving):
    cli.main(["run", "/dev/i2c-7"])
    open_imu = serving.service.call_args.args[0].open_imu
    serving.imu.side_effect = OSError("nothing answers")
    with pytest.raises(OSError, match="nothing answers"):
        open_imu()
    assert serving.bus.close.call_count == 1
    serving.imu.side_effect = ValueError("no such rate")
    with pytest.raises(ZerorateError, match="no such rate"):
        open_imu()
    serving.linux.side_effect = OSError(errno.ENOTTY, "no ioctl")
    with pytest.raises(ZerorateError, match="no I2C bus"):
        open_imu()
    cli.main(["run", "i2c-7"])
    elsewhere = serving.service.call_args.args[0].open_imu
    raised = [(errno.ENOENT, open_imu, OSError), (errno.ENOENT, elsewhere, ZerorateError)]
    raised += [(number, elsewhere, OSError) for number in (errno.EPERM, errno.EACCES)]
    for number, opened, error in raised:
        serving.linux.side_effect = OSError(number, "not there yet")
        with pytest.raises(error, match="not there yet" if error is OSError else "no I2C bus"):
            opened()


def test_run_needs_the_folder_of_its_state_and_the_file_alone(serving, capsys):
    assert cli.main(["run", "fake:", "--state", "no/learned.bin"]) == 2
    assert not serving.service.called and capsys.readouterr().err.startswith("zerorate: no: ")
    with open("fake.bin", "ab") as of_another:
        fcntl.flock(of_another, fcntl.LOCK_EX)
        assert cli.main(["run", "fake:"]) == 2
    assert not serving.service.called and "another program" in capsys.readouterr().err
    assert cli.main(["run", "fake:"]) == 0


@pytest.mark.parametrize("words", ["--hz 3000", "--dlpf-hz 2", "--part nosuch"])
def test_a_setting_that_no_chip_takes_is_not_waited_for(serving, words, capsys):
    assert cli.main(["run", "/dev/i2c-7", *words.split()]) == 2
    assert words.split()[1] in capsys.readouterr().err
    assert not serving.service.called and not serving.linux.called
    for right in ("--hz 8000 --dlpf-hz 256", "--hz 10 --dlpf-hz 256 --part MPU-6500"):
        assert cli.main(["run", "/dev/i2c-7", *right.split()]) == 0


# --- runtimes ---


def test_interpreters_are_fetched_in_turn_and_2_says_that_one_could_not_be(stands_in, capsys):
    fetch = stands_in("zerorate_tools.runtimes.fetch")
    pico = stands_in("zerorate_bench.boards.pico.fetch_rp2040")
    assert cli.main(["runtimes", "get", "wasm", "rp2040", "x64"]) == 0
    assert fetch.call_args_list == [call("wasm"), call("x64")] and pico.call_count == 1
    assert capsys.readouterr().out == "wasm: ready\nrp2040: ready\nx64: ready\n"
    fetch.side_effect = MissingRuntime("cannot be had")
    assert cli.main(["runtimes", "get", "wasm", "rp2040"]) == 2
    ended = capsys.readouterr()
    assert ended.out == "rp2040: ready\n" and ended.err == "zerorate: wasm: cannot be had\n"


def test_the_emulated_pico_is_in_a_checkout_only(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "zerorate_bench.boards.pico", None)
    assert cli.main(["runtimes", "get", "rp2040"]) == 2
    assert "in a checkout only" in capsys.readouterr().err


def test_interpreters_are_listed_with_how_to_get_those_missing(monkeypatch, capsys):
    def find(name):
        if name == "x86":
            raise MissingRuntime("zerorate runtimes get x86")

    monkeypatch.setattr("zerorate_tools.runtimes.find", find)
    assert cli.main(["runtimes", "list"]) == 0
    said = dict(line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines())
    assert said["x86"] == "missing: zerorate runtimes get x86"
    assert {said["wasm"], said["armhf"], said["x64"]} == {"ready"}
