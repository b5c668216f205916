"""`zerorate state show` names every word of a state and of a store, with its value and unit."""

import pytest
from zerorate import Corrector
from zerorate.storage.learned_store import LearnedStore
from zerorate_fakes.memory import FakeMemory
from zerorate_tools.cli import main
from zerorate_tools.errors import InFile
from zerorate_tools.layout import AXIS, STATE, axis_at
from zerorate_tools.model import build_model
from zerorate_tools.replay.replaying import state_bytes
from zerorate_tools.replay.state_in_words import words_of_file

from ..tools.test_model import SCALES, SLOTS


@pytest.fixture
def corrector():
    made = Corrector()
    made.state[STATE.OUT_Q8 + 1] = -384
    made.state[axis_at(made.settings, 2) + AXIS.OFFSET_FROM] = 4
    return made


def by_name(path, **options):
    return {word.name: word for word in words_of_file(path, options)}


@pytest.mark.parametrize("options", [{}, {"motion": False}, {"gravity": False}, {"document": True}])
def test_every_word_of_a_state_has_a_name_of_its_own(tmp_path, options):
    (tmp_path / "s.bin").write_bytes(state_bytes(Corrector(**options)))
    given = {"document": True} if "document" in options else {}
    words = words_of_file(tmp_path / "s.bin", given)
    names = [(word.array, word.name) for word in words]
    assert len(words) == len(state_bytes(Corrector(**options))) // 4 == len(set(names))


def test_a_word_has_its_value_in_its_unit_and_a_code_its_name(tmp_path, corrector):
    (tmp_path / "s.bin").write_bytes(state_bytes(corrector))
    words = by_name(tmp_path / "s.bin")
    assert words["OUT_Q8[1]"].shown == "-1.5 LSB"
    assert words["z.OFFSET_FROM"].shown == "IN_MOTION"


def test_the_words_of_a_model_are_those_of_its_slots(tmp_path, corrector):
    from zerorate.model import EffectModel
    from zerorate_tools.model import encoded

    model = EffectModel()
    model.load(encoded(build_model(SLOTS, SCALES)), corrector.sensor)
    corrector.use_model(model)
    (tmp_path / "s.bin").write_bytes(state_bytes(corrector))
    assert by_name(tmp_path / "s.bin")["SLOTS[0].SLOT_POWER"].raw == 2


def test_of_a_store_the_newest_whole_record_counts(tmp_path, corrector, capsys):
    memory = FakeMemory(1 << 16)
    store = LearnedStore(memory, b"\x68\0\0\0", corrector)
    for value in (256, 512):
        corrector.state[STATE.OUT_Q8] = value
        assert store.save()
    path = tmp_path / "learned.bin"
    path.write_bytes(memory.bytes)
    assert main(["state", "show", str(path), "--find", "out_q8[0]"]) == 0
    assert capsys.readouterr().out.split()[-5:] == ["61", "OUT_Q8[0]", "512", "2", "LSB"]
    assert store.save_model(b"ZRM")  # a record of another kind
    path.write_bytes(memory.bytes)
    assert by_name(path)["WINDOW"].raw == 32  # of the settings, which are stored, too
    damaged = bytearray(memory.bytes)
    damaged[store.state.slot_bytes + 100] ^= 1
    path.write_bytes(damaged)
    assert by_name(path)["OUT_Q8[0]"].raw == 256
    damaged[100] ^= 1
    path.write_bytes(damaged)
    with pytest.raises(InFile, match="no state of this store is whole"):
        words_of_file(path)


def test_a_file_of_another_size_says_what_to_do(tmp_path, capsys):
    (tmp_path / "s.bin").write_bytes(bytes(40))
    assert main(["state", "show", str(tmp_path / "s.bin")]) == 2
    assert f"40 bytes where a state with these settings has {4 * len(Corrector().state)}" in (
        capsys.readouterr().err
    )
