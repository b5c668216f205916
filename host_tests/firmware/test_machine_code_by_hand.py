"""Which kernels run, as told on a host that passes for a board."""

import sys
from types import SimpleNamespace

import pytest
from zerorate import machine_code, trying

_LOW_BITS, _HIGH_BITS = 0x3FF, 1 << 14
_RIGHT, _KNOWN = bytes.fromhex("201d16a1"), (1, 4, 0, 1, (2, (1, 9), ()), (1, (), ()), (1, (), ()))


@pytest.fixture
def board(monkeypatch):
    """A function that makes this host a board whose interpreter gives this number."""

    def pretend(mpy, name="micropython"):
        own = vars(sys.implementation) | {"name": name, "_mpy": mpy}
        monkeypatch.setattr(sys, "implementation", SimpleNamespace(**own))

    monkeypatch.setattr(machine_code, "chosen", {})
    return pretend


@pytest.mark.parametrize(
    ("processor", "kind"),
    [(2, None), (3, "thumb"), (8, "thumb"), (9, None), (10, None), (11, "rv32"), (12, None)],
)
def test_a_processor_has_machine_code_by_its_number(board, monkeypatch, processor, kind):
    fake = SimpleNamespace(tried=lambda part, kind: (kind, f"{part} on {kind}"))
    for part in ("a", "b"):
        monkeypatch.setitem(sys.modules, "zerorate.trying", fake)
        board(processor << 10 | _LOW_BITS | _HIGH_BITS)
        assert machine_code.machine_code(part) == kind
    none = "bytecode: there is no machine code for this processor"
    assert machine_code.chosen == {p: f"{p} on {kind}" if kind else none for p in "ab"}


def test_a_host_has_nothing_to_choose(board):
    board(0, "cpython")
    assert machine_code.machine_code("a") is None and machine_code.chosen == {}


def test_only_a_board_lets_a_module_go(board, monkeypatch):
    fake = SimpleNamespace(inner=1)
    for name, left in (("cpython", 1), ("micropython", 0)):
        monkeypatch.setitem(sys.modules, "a", fake)
        monkeypatch.setitem(sys.modules, "a.inner", fake)
        board(0, name)
        machine_code.unload("a", "inner")
        machine_code.unload("a", "none")
        assert ("a.inner" in sys.modules, len(vars(fake))) == (left, left)


def runs(a, b, c, what):
    a[0] += what * a[1]
    c[0] -= len(b)


@pytest.mark.parametrize(
    ("can", "there", "answer", "said"),
    [
        (True, True, _RIGHT, "machine code"),
        (True, True, bytes(4), "bytecode: its machine code gives wrong numbers here"),
        (True, 0, _RIGHT, "bytecode: its machine code is not here, or is another board's"),
        (False, True, _RIGHT, "bytecode: this interpreter takes no machine code"),
    ],
)
def test_code_runs_where_it_gives_its_known_answer(monkeypatch, can, there, answer, said):
    def decorator(function):
        if not can:
            raise NameError("no such decorator")
        return function

    file = SimpleNamespace(run=runs, KNOWN=_KNOWN, ANSWER=answer)
    monkeypatch.setitem(sys.modules, "micropython", SimpleNamespace(asm_thumb=decorator))
    monkeypatch.setitem(sys.modules, "zerorate.native.thumb_x", file if there else None)
    assert trying.tried("x", "thumb") == (runs if said == "machine code" else None, said)
