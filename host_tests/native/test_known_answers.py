"""The answer that a board asks its machine code for is the one that the kernels give.

A board whose code does not give it takes the bytecode instead: with a wrong answer all of them do.
"""

import ast

import pytest
from zerorate_bench.native.native_files import plain_kernels
from zerorate_tools.kernels.known import answer_by, known
from zerorate_tools.kernels.parts import PARTS


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
