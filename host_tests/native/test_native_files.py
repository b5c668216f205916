"""The generated files are those that the kernels give, and what they must not hold is found."""

import ast
import struct

import pytest
from zerorate_bench.native.machine_code import machine_code, problems
from zerorate_bench.native.native_files import plain_kernels, stale
from zerorate_bench.native.parts import PARTS, answer_by, known
from zerorate_tools.errors import ZerorateError
from zerorate_tools.kernels.reading import Kernels


def test_the_committed_machine_code_is_what_the_kernels_give_byte_for_byte(repository):
    pytest.importorskip("ziglang")
    assert stale(repository / "firmware" / "zerorate") == [], "make native"


@pytest.mark.parametrize(
    ("processor", "code", "found"),
    [
        ("thumb", struct.pack("<2H", 0x2001, 0x4801), "the instruction at 2 reads beside the code"),
        ("thumb", struct.pack("<1H", 0xA001), "the instruction at 0 reads beside the code"),
        ("rv32", struct.pack("<HI", 0x0001, 0x00000517), "the instruction at 2 addresses from"),
    ],
)
def test_what_reads_beside_the_code_is_found(processor, code, found):
    assert [problem for problem in problems(code, processor) if problem.startswith(found)]


def test_what_only_looks_like_it_is_not():
    assert list(problems(struct.pack("<3H", 0xF000, 0xF802, 0x4770), "thumb")) == []


def test_a_kernel_outside_the_subset_is_refused_with_its_row(tmp_path):
    (tmp_path / "effects.py").write_text(
        "ptr32 = None\n\n\ndef sense(s: ptr32, e: ptr32, x: ptr32, t: int):\n    return 1.5\n"
    )
    with pytest.raises(ZerorateError, match="effects.py: row 5: Constant is not in the"):
        machine_code(Kernels(tmp_path), "effects", "thumb")


def test_two_kernel_files_of_one_name_are_refused(tmp_path):
    text = "ptr32 = None\n\n\ndef f(s: ptr32):\n    s[0] = 1\n"
    (tmp_path / "one").mkdir()
    (tmp_path / "one" / "a.py").write_text(text)
    (tmp_path / "a.py").write_text(text)
    with pytest.raises(ZerorateError, match="has the name of another file with kernels"):
        Kernels(tmp_path)


@pytest.mark.parametrize("processor", ["thumb", "rv32"])
@pytest.mark.parametrize("part", PARTS)
def test_the_known_answer_on_every_board_is_the_kernels(repository, part, processor):
    file = repository / "firmware" / "zerorate" / "native" / f"{processor}_{part}.py"
    committed = {
        line.partition(" = ")[0]: ast.literal_eval(line.partition(" = ")[2])
        for line in file.read_text(encoding="utf-8").splitlines()[:10]
        if line.startswith(("KNOWN", "ANSWER"))
    }
    assert committed["KNOWN"] == known(part)
    assert committed["ANSWER"] == answer_by(plain_kernels()[part], part)
