"""The generated files are those that the kernels give, and what they must not hold is found."""

import ast

import pytest
from zerorate_bench.native.native_files import plain_kernels, stale
from zerorate_bench.native.parts import PARTS, answer_by, known


def test_the_committed_machine_code_is_what_the_kernels_give_byte_for_byte(repository):
    pytest.importorskip("ziglang")
    assert stale(repository / "firmware" / "zerorate") == [], "make native"


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
