"""Where what was learned is kept: a file, or flash with its erase blocks."""

import os

import pytest
from zerorate.storage import codes
from zerorate.storage.block_device import BlockDeviceStorage
from zerorate.storage.places import FileStorage

from .test_store import BLANK, NEW, OLD, loaded, make_store


class TestFile:
    @pytest.fixture
    def path(self, tmp_path):
        return tmp_path / "learned.bin"

    def test_what_is_saved_is_loaded(self, path):
        for payload in (OLD, NEW, OLD):
            assert make_store(FileStorage(path)).save(payload)
        assert loaded(FileStorage(path)) == (codes.LOADED, OLD)

    def test_a_missing_file_is_empty(self, path):
        assert loaded(FileStorage(path)) == (codes.EMPTY, BLANK)

    def test_a_file_cut_short_at_any_byte_is_never_wrong(self, path):
        store = make_store(FileStorage(path))
        store.save(OLD)
        store.save(NEW)
        whole = path.read_bytes()
        for length in range(len(whole)):
            path.write_bytes(whole[:length])
            reason, payload = loaded(FileStorage(path))
            if length >= store.slot_bytes:
                assert (reason, payload) == (codes.LOADED, OLD)
            else:
                assert reason in (codes.EMPTY, codes.DAMAGED) and payload == BLANK

    def test_a_folder_in_its_place_is_a_reason(self, tmp_path):
        assert loaded(FileStorage(tmp_path)) == (codes.UNREADABLE, BLANK)
        assert not make_store(FileStorage(tmp_path)).save(OLD)

    @pytest.mark.parametrize("size", [1, 3, 5, 7, 16])
    def test_pieces_joined_are_the_file_and_then_erased(self, path, size):
        path.write_bytes(bytes(range(40)))
        there = bytes(range(40)) + b"\xff" * 60
        for offset in (0, 1, 13, 39, 40, 45):
            for length in range(1, 50):
                pieces = FileStorage(path).read_pieces(offset, length, bytearray(size))
                found = [bytes(piece) for piece in pieces]
                assert b"".join(found) == there[offset : offset + length]
                assert {len(piece) for piece in found[:-1]} <= {size}

    @pytest.mark.parametrize("synced", [True, False])
    def test_what_is_written_is_there_and_what_was_there_stays(self, path, monkeypatch, synced):
        told = []
        if synced:
            monkeypatch.setattr(os, "fsync", lambda number: told.append(path.read_bytes()))
        else:
            monkeypatch.delattr(os, "fsync")
        storage, writes = FileStorage(path), [(5, b"abc"), (0, b"xy"), (6, b"BCD"), (20, b"!")]
        for offset, data in writes:
            storage.writeblock(offset, data)
        there = [
            b"\xff\xff\xff\xff\xffabc",
            b"xy\xff\xff\xffabc",
            b"xy\xff\xff\xffaBCD",
            b"xy\xff\xff\xffaBCD" + bytes(11) + b"!",
        ]
        assert path.read_bytes() == there[-1]
        assert told == (there if synced else [])


class FakeFlash:
    """A block device whose writes can only clear bits of what was erased."""

    BLOCK = 256

    def __init__(self, blocks):
        self.bytes = bytearray(self.BLOCK * blocks)
        self.erased = []

    def readblocks(self, block, buf, offset):
        start = block * self.BLOCK + offset
        buf[:] = self.bytes[start : start + len(buf)]

    def writeblocks(self, block, buf, offset):
        start = block * self.BLOCK + offset
        for i, byte in enumerate(buf):
            self.bytes[start + i] &= byte

    def ioctl(self, operation, block):
        assert operation == 6
        self.erased.append(block)
        start = block * self.BLOCK
        self.bytes[start : start + self.BLOCK] = b"\xff" * self.BLOCK


def test_on_flash_each_slot_has_an_erase_block_of_its_own():
    flash = FakeFlash(8)
    for payload in (OLD, NEW, OLD):
        storage = BlockDeviceStorage(flash, 5, FakeFlash.BLOCK)
        assert make_store(storage, pitch=FakeFlash.BLOCK).save(payload)
    storage = BlockDeviceStorage(flash, 5, FakeFlash.BLOCK)
    assert loaded(storage, pitch=FakeFlash.BLOCK) == (codes.LOADED, OLD)
    assert flash.erased == [5, 6, 5]


@pytest.mark.parametrize(
    ("offset", "length", "erased"),
    [
        (0, 1, [5]),
        (0, 256, [5]),
        (0, 257, [5, 6]),
        (255, 1, [5]),
        (255, 2, [5, 6]),
        (256, 256, [6]),
        (300, 10, [6]),
        (100, 600, [5, 6, 7]),
        (513, 255, [7]),
    ],
)
def test_every_block_that_is_written_is_erased_first_and_no_other(offset, length, erased):
    flash = FakeFlash(9)
    storage = BlockDeviceStorage(flash, 5, FakeFlash.BLOCK)
    data = bytes(i % 251 for i in range(length))
    storage.writeblock(offset, data)
    assert flash.erased == erased
    at = 5 * 256 + offset
    assert flash.bytes[at : at + length] == data
    assert set(flash.bytes[5 * 256 : at]) <= {0xFF, 0} and not any(flash.bytes[: 5 * 256])
    buf = bytearray(length)
    storage.readblock(offset, buf)
    assert buf == data
