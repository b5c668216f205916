"""What the page says to do on a board works as it stands, on a MicroPython."""

import shlex
from pathlib import Path

import pytest
from zerorate_tools.cli import parser
from zerorate_tools.layout import EFFECTS
from zerorate_tools.report.board import deployment

PROGRAM = """
from zerorate import Corrector, Sensor
corrector = Corrector(Sensor({scales}))
class imu:
    binding = None
{lines}
value = load = 700
{each}
print("slots", corrector.effects.e[{slots}], list(effects.channels))
"""


def program(closed, told):
    s = closed.scales
    scales = (s.odr_hz, s.gyro_lsb_per_dps, s.accel_lsb_per_g, s.temp_lsb_per_degc)
    given = ", ".join(map(repr, (*scales, s.temp_offset_degc)))
    slots = EFFECTS.SLOT_COUNT
    return PROGRAM.format(scales=given, lines=told.program, each=told.each_reading, slots=slots)


@pytest.mark.parametrize("name", ["an effect", "hostile names"])
def test_the_lines_load_the_model_on_a_micropython(
    outcome, name, find_runtime, repository, tmp_path
):
    closed = outcome(name)
    script = tmp_path / "main.py"
    channels = [s for step in closed.result["effects"] for s in step["sources"] if s != "temp"]
    script.write_text(program(closed, deployment(closed.folder, channels)))
    model = (closed.folder / "model.bin").read_bytes()
    done = find_runtime("wasm").run(
        script, modules=[repository / "firmware"], files_in={"model.bin": model}
    )
    assert done.stdout.split("slots")[1].split()[0] > "0", done.stdout + done.stderr


def test_every_command_of_zerorate_is_one(outcome):
    commands = deployment(outcome("an effect").folder, []).commands.splitlines()
    own = [shlex.split(line)[1:] for line in commands if line.startswith("zerorate ")]
    assert len(own) == 2
    for arguments in own:
        assert parser().parse_args(arguments).run


def test_the_model_is_one_that_the_device_would_load(outcome, capsys):
    line = deployment(outcome("an effect").folder, []).commands.splitlines()[0]
    arguments = parser().parse_args(shlex.split(line)[1:])
    arguments.run(arguments)
    assert capsys.readouterr().out


def test_a_channel_is_named_so_that_python_reads_it_back():
    told = deployment(Path("out"), ["vdd_mv", 'a "b"\n<script>'])
    plain, odd = told.each_reading.splitlines()
    assert plain == "effects.channel('vdd_mv', vdd_mv)"
    assert odd == "effects.channel('a \"b\"\\n<script>', value)"


def test_a_folder_with_a_blank_is_quoted():
    told = deployment(Path("my out"), [])
    assert "--model 'my out/model.bin'" in told.commands
