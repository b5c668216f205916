"""`zerorate run` as a process of its own: what it prints first, and how it comes back."""

import configparser
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from functools import partial

import pytest
from zerorate_tools.model import Slot, build_model, write_model
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales

from .test_service import BIAS_DPS


def first_line(folder, *options, bus="fake:"):
    """The first line of a service on a bus, and what it said; None where it ended.

    Without numpy: docs/linux-service.md installs the extra `linux` alone.
    """
    start = (
        "import sys; sys.modules['numpy'] = None; from zerorate_tools.cli import main; exit(main())"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", start, "run", bus, *options],
        **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True},
        cwd=folder,
    )
    line = process.stdout.readline()
    process.terminate()
    return json.loads(line) if line else None, process.communicate(timeout=30)[1]


def model_of(folder, temp_lsb_per_degc):
    """The file of a model that says 0.01 dps a degC on x, for the chip at 25 Hz."""
    slot = Slot(Term("temp", 0.0, 50.0, 5.0), (0.01, 0.0, 0.0))
    scales = Scales("MPU-6050", 25, 131, 16384, temp_lsb_per_degc, 36.53)
    return str(write_model(build_model([slot], scales), folder)[1])


def test_it_runs_on_an_emulated_chip_with_a_model_that_fits_and_keeps_its_state(tmp_path):
    line, said = first_line(tmp_path, "--hz", "25", "--model", model_of(tmp_path, 340))
    assert "MPU-6050" in said and "--model" not in said and "fake.bin" in said.splitlines()[0]
    assert not (tmp_path / "learned.bin").exists()  # a real chip would begin with it
    assert line["accel_g"][2] == pytest.approx(1, abs=0.05)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("mine.csv", "zerorate: mine.csv: no I2C bus.*-*"),
        ("/dev/null", "zerorate: /dev/null: no I2C bus.*-*"),
        ("fake: --state no/learned.bin", "zerorate: no: no such folder; make it, or name"),
        ("fake: --socket no/imu.sock", "zerorate: no: no such folder; make it, or name"),
        ("fake: --state mine.csv", "zerorate: mine.csv: "),
        ("fake: --state .", "zerorate: .: "),
        ("fake: --model none.bin", "zerorate: none.bin: no such file; name a model"),
        ("fake: --hz 25 --model model.bin", "zerorate: model.bin: .*other scales; name another"),
        ("fake: --model mine.csv", "zerorate: mine.csv: this is no effect model; name another"),
    ],
)
def test_what_it_cannot_run_with_is_one_line_and_stays_as_it_is(tmp_path, words, said):
    model_of(tmp_path, 326.8)
    (tmp_path / "mine.csv").write_text("t_us,gx,gy,gz\n0,1,2,3\n")
    bus, *options = words.split()
    line, complaint = first_line(tmp_path, *options, bus=bus)
    assert line is None and re.match(said, complaint) and complaint.count("\n") == 1
    assert (tmp_path / "mine.csv").read_text() == "t_us,gx,gy,gz\n0,1,2,3\n"
    assert not (tmp_path / "learned.bin").exists()


LIVE = """
import sys, time
from zerorate_fakes import FakeI2C, FakeMPU6050, Physical
from zerorate_fakes.smbus import SMBus
from zerorate_i2c import clock, linux
from zerorate_tools.cli import main
chip = FakeMPU6050(Physical(gyro_dps=(0.31, -0.19, 0.08)))
last = clock.ticks_us()
class Bus(FakeI2C):
    def _begin(self, wire_bytes):
        global last
        now = clock.ticks_us()
        chip.advance_us(20 * (now - last))  # twenty times as fast as time
        last = now
        return super()._begin(wire_bytes)
import smbus2
smbus2.SMBus = lambda bus: SMBus(Bus(chip))
sys.exit(main(["run", "/dev/i2c-1", "--hz", "20", "--state", sys.argv[1]]))
"""


def test_the_real_process_comes_back_after_kill_9(tmp_path):
    pytest.importorskip("smbus2")
    command = [sys.executable, "-c", LIVE, str(tmp_path / "learned.bin")]
    pipe = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    pipe["preexec_fn"] = partial(signal.signal, signal.SIGHUP, signal.SIG_DFL)  # nohup ignores it
    said = []
    for ending in (signal.SIGKILL, signal.SIGHUP, signal.SIGTERM):
        process = subprocess.Popen(command, **pipe)
        lines, end = [], time.monotonic() + 60
        while len(lines) < 400 and time.monotonic() < end:
            lines.append(json.loads(process.stdout.readline()))
        os.kill(process.pid, ending)
        said.append(process.communicate(timeout=60)[1])
    assert lines[0]["bias_dps"] == pytest.approx(BIAS_DPS, abs=0.05)
    assert "nothing was ever stored" in said[0]
    for words in said[1:]:
        assert "loaded" in words and "within the hour, is not kept" in words


def test_the_unit_has_a_watchdog_and_no_rights(repository, tmp_path):
    unit = configparser.ConfigParser(strict=False, interpolation=None)
    unit.optionxform = str
    text = (repository / "examples" / "zerorate.service").read_text()
    assert text in (repository / "docs" / "linux-service.md").read_text()
    unit.read_string(text)
    service = unit["Service"]
    assert service["Type"] == "notify" and int(service["WatchdogSec"]) >= 15
    assert service["DynamicUser"] == "yes" and service["DevicePolicy"] == "closed"
    assert service["Restart"] == "always" and service["UMask"] == "0000"
    if shutil.which("systemd-analyze"):
        (tmp_path / "zerorate.service").write_text(text.replace(service["ExecStart"], "/bin/true"))
        command = ["systemd-analyze", "verify", str(tmp_path / "zerorate.service")]
        said = subprocess.run(command, capture_output=True, text=True).stderr
        assert "zerorate.service" not in said, said
