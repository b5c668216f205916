"""`watch --own` on an emulated Pico: the board's program is shown and goes on."""

import re

import pytest
from zerorate_tools.cli import main

from . import test_programs as first
from .conftest import Console

programs, start = first.programs, first.start


def test_what_the_own_program_learned_is_watched_and_not_replaced(
    pico, programs, start, tmp_path, capsys
):
    explains = "    if count == imu.odr_hz:\n        print(corrector.corrector.explain())\n"
    console = start(programs[0].replace("    if count == imu.odr_hz:\n", explains))
    first.learned(console)
    console.close()
    picture = tmp_path / "own.png"
    assert main(["watch", pico.port, "--own", "--for", "6", "--plot", str(picture)]) == 0
    x_dps, source = re.search(r"x (\S+)±\S+ (\S+)", capsys.readouterr().out).groups()
    assert float(x_dps) == pytest.approx(first.BIAS_DPS[0], abs=0.02)
    assert source in ("any-temperature", "fit", "this-temperature")
    assert picture.read_bytes().startswith(b"\x89PNG")
    console = Console(pico.port)
    try:
        _, after = next(first.rates(console))
        assert after == pytest.approx([0, 0, 0], abs=0.02)
        assert not any("reboot" in line or "found:" in line for line in console.said)
    finally:
        console.close()
