"""Power cuts at every byte and bits turned in both slots: prints what was loaded how often."""

from array import array

from zerorate.storage.crc32 import checksum
from zerorate.storage.places import FileStorage
from zerorate.storage.plain_crc32 import plain_crc32
from zerorate.storage.store import Store
from zerorate_fakes.memory import FakeMemory, PowerCut

BINDING = b"\x68\x00\x00\x03"
OLD = array("i", [7, -8, 2**29, -(2**30), 2**30 - 1, 0, -1])
NEW = array("i", [value // 3 for value in OLD])


def load(storage):
    payload = array("i", [99] * 7)
    reason = Store(storage, BINDING, 28).load(payload)
    return reason, list(payload)


memory = FakeMemory(256)
Store(memory, BINDING, 28).save(OLD)
image = bytes(memory.bytes)
found = {}
for cut in range(52):
    memory.bytes[:] = image
    memory.cut_after = cut
    try:
        Store(memory, BINDING, 28).save(NEW)
    except PowerCut:
        pass
    memory.cut_after = None
    assert load(memory) == (0, list(OLD)), cut
memory.bytes[:] = image
assert Store(memory, BINDING, 28).save(NEW)
for bit in range(2 * 52 * 8):
    memory.flip(bit)
    assert load(memory) == (0, list(OLD if bit >= 52 * 8 else NEW)), bit
    memory.flip(bit)

for payload in (OLD, NEW):
    assert Store(FileStorage("learned.bin"), BINDING, 28).save(payload)
assert load(FileStorage("learned.bin")) == (0, list(NEW))
assert load(FileStorage("missing.bin"))[0] == 1

plain, own = bytearray(4), bytearray(4)
plain_crc32(b"12345", plain)
plain_crc32(b"6789", plain)
checksum(b"12345", own)
checksum(b"6789", own)
assert plain == own
with open("learned.bin", "rb") as file:
    print(file.read().hex(), plain.hex())
