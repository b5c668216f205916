"""What was learned survives a power cut at any byte and any one bit turned, or is not believed."""

from array import array
from binascii import crc32
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from zerorate.storage import codes
from zerorate.storage import store as stores
from zerorate.storage.crc32 import checksum
from zerorate.storage.plain_crc32 import plain_crc32
from zerorate.storage.store import Store
from zerorate_fakes.memory import FakeMemory, FakeMemoryInPieces, PowerCut

BINDING = bytes([0x68, 0, 0, 3])
WORDS = 12
OLD = array("i", [7, -8, 2**29, -(2**30), 2**30 - 1, 0, -1, 5, 6, 7, 8, 9])
NEW = array("i", [-value // 3 for value in OLD])
BLANK = array("i", [99] * WORDS)


def make_store(memory, **options):
    return Store(memory, options.pop("binding", BINDING), 4 * WORDS, **options)


def loaded(memory, **options):
    """(reason, payload) as after the next power-on."""
    payload = array("i", BLANK)
    return make_store(memory, **options).load(payload), payload


@pytest.fixture
def memory_of_two(memory):
    """Both slots whole: OLD, then NEW."""
    store = make_store(memory)
    assert store.save(OLD) and store.save(NEW)
    return memory


def test_plain_bytes_are_stored_as_they_are(memory):
    store = Store(memory, BINDING, 5)
    assert store.save(b"\x00\xff\x80\x01\x7f")
    payload = bytearray(5)
    for reader in (store, Store(memory, BINDING, 5)):
        assert reader.load(payload) == codes.LOADED
        assert payload == b"\x00\xff\x80\x01\x7f"
    assert set(memory.bytes[store.slot_bytes :]) == {0xFF}


def test_nothing_is_written_outside_the_two_slots(memory):
    store = make_store(memory, base=100)
    for _ in range(4):
        store.save(NEW)
    assert set(memory.bytes[:100]) == {0xFF}
    assert set(memory.bytes[100 + 2 * store.slot_bytes :]) == {0xFF}


@pytest.mark.parametrize(
    ("kind", "torn_byte"),
    [(FakeMemory, torn) for torn in (None, 0x00, 0xFF, 0x5A)] + [(FakeMemoryInPieces, None)],
)
def test_power_cut_at_every_byte_of_every_write_loads_the_newest_whole(kind, torn_byte):
    memory = kind(4096)
    saved = [None, OLD, NEW, OLD, NEW]
    store = make_store(memory)
    for before, after in zip(saved, saved[1:], strict=False):
        image = bytes(memory.bytes)
        for cut in range(store.slot_bytes):
            memory.bytes[:] = image
            memory.cut_after, memory.torn_byte = cut, torn_byte
            with pytest.raises(PowerCut):
                make_store(memory).save(after)
            memory.cut_after = None
            reason, payload = loaded(memory)
            allowed = (
                (before, after)
                if torn_byte is not None and cut == store.slot_bytes - 1
                else (before,)
            )
            if reason == codes.LOADED:
                assert payload in allowed
            else:
                assert before is None and payload == BLANK
                assert reason in (codes.EMPTY, codes.DAMAGED)
        memory.bytes[:] = image
        memory.torn_byte = None
        assert make_store(memory).save(after)


def test_every_bit_turned_in_either_slot_loads_the_newest_whole(memory_of_two):
    slot_bits = 8 * make_store(memory_of_two).slot_bytes
    for bit in range(2 * slot_bits):
        memory_of_two.flip(bit)
        in_newest = bit >= slot_bits
        assert loaded(memory_of_two) == (codes.LOADED, OLD if in_newest else NEW), bit
        memory_of_two.flip(bit)


@pytest.mark.parametrize("cut_after", [0, 3, 30, 60])
def test_a_bit_turned_under_a_living_store_and_then_a_cut_cost_one_of_the_slots(
    memory_of_two, cut_after
):
    store, image = make_store(memory_of_two), bytes(memory_of_two.bytes)
    store.load(array("i", BLANK))
    for bit in range(16 * store.slot_bytes):
        memory_of_two.flip(bit)
        memory_of_two.cut_after = cut_after
        with pytest.raises(PowerCut):
            store.save(BLANK)
        reason, payload = loaded(memory_of_two)
        assert reason == codes.LOADED
        # what was written of the header may have mended the newest
        assert payload == NEW or (payload == OLD and bit >= 8 * store.slot_bytes), bit
        memory_of_two.cut_after, memory_of_two.bytes[:] = None, image


def test_a_bit_turned_in_both_slots_is_a_clean_start(memory_of_two):
    slot_bits = 8 * make_store(memory_of_two).slot_bytes
    for bit in range(slot_bits):
        memory_of_two.flip(bit)
        memory_of_two.flip(slot_bits + (bit * 7 + 3) % slot_bits)
        assert loaded(memory_of_two) == (codes.DAMAGED, BLANK)
        memory_of_two.flip(bit)
        memory_of_two.flip(slot_bits + (bit * 7 + 3) % slot_bits)


@given(noise=st.binary(min_size=200, max_size=200))
def test_noise_is_never_loaded_and_never_raises(noise):
    memory = FakeMemory(4096)
    memory.bytes[:200] = noise
    reason, payload = loaded(memory)
    assert reason != codes.LOADED and payload == BLANK


def test_a_storage_that_fails_is_a_reason_and_not_an_exception(memory_of_two):
    memory_of_two.broken = True
    assert loaded(memory_of_two) == (codes.UNREADABLE, BLANK)
    store = make_store(memory_of_two)
    assert not store.save(OLD)
    assert store.failures == 1


def test_a_storage_that_reads_another_thing_each_time_cannot_be_read(memory_of_two):
    reads, readblock = [], memory_of_two.readblock

    def read(offset, buf):
        readblock(offset, buf)
        reads.append(offset)
        buf[-1] ^= len(reads) > 2

    memory_of_two.readblock = read
    assert loaded(memory_of_two) == (codes.UNREADABLE, array("i", [0] * WORDS))


@pytest.mark.parametrize(
    "options",
    [
        {"binding": bytes(9)},
        {"version": -1},
        {"version": 256},
        {"pitch": 1},
        {"pitch": 71},
        {"pitch": -1},
    ],
    ids=str,
)
def test_what_does_not_fit_is_a_value_error(memory, options):
    with pytest.raises(ValueError):
        make_store(memory, **options)


@pytest.mark.parametrize("size", [0, 65536])
def test_a_size_that_does_not_fit_is_a_value_error(memory, size):
    with pytest.raises(ValueError):
        Store(memory, BINDING, size)


@pytest.mark.parametrize(("size", "version", "pitch"), [(1, 0, 0), (65535, 255, 65559)])
def test_the_ends_of_every_range_fit(size, version, pitch):
    memory, payload = FakeMemory(140000), bytearray(size)
    store = Store(memory, bytes(8), size, version, pitch=pitch)
    assert store.save(b"\xa5" * size) and store.save(b"\x5a" * size)
    assert store.load(payload) == codes.LOADED and payload == b"\x5a" * size
    assert (store.saves, store.failures) == (2, 0)


@pytest.mark.parametrize("length", [0, 1, 11, 13, 47, 49, 192])
def test_a_payload_of_another_length_is_a_value_error(memory, length):
    for use in (make_store(memory).save, make_store(memory).load):
        with pytest.raises(ValueError, match="48 bytes"):
            use(bytearray(length))


@pytest.mark.parametrize("words", [WORDS - 1, WORDS + 1, 2 * WORDS])
@pytest.mark.parametrize("other", [0, 1])
def test_a_record_of_another_size_or_version_is_told_apart_and_stays(memory, words, other):
    pitch = 4 * stores.slot_bytes(4 * WORDS)
    older = Store(memory, BINDING, 4 * words, version=1 + other, pitch=pitch)
    assert older.save(array("i", range(words))) and older.save(array("i", range(words)))
    found = (codes.OTHER_SIZE, codes.OTHER_VERSION)[other]
    assert loaded(memory, pitch=pitch) == (found, BLANK)
    assert older.load(array("i", [0] * words)) == codes.LOADED


@given(st.binary(max_size=300))
def test_the_plain_checksum_is_the_interpreters(data):
    plain, own = bytearray(4), bytearray(4)
    plain_crc32(data, plain)
    checksum(data, own)
    assert plain == own == crc32(data).to_bytes(4, "little")


def test_cuts_and_turned_bits_end_alike_on_micropython_to_the_last_byte(micropython, find_runtime):
    root = Path(__file__).resolve().parents[2]
    script = Path(__file__).parent / "on_micropython" / "store_cut_and_turned.py"
    modules = [root / "firmware", root / "host_tests" / "fakes"]
    on_cpython = find_runtime("cpython").run(script, modules=modules, check=True).stdout
    assert micropython.run(script, modules=modules, check=True).stdout == on_cpython
    assert on_cpython.strip().endswith("2639f4cb")
