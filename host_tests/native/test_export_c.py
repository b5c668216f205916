"""The exported C is the firmware: it compiles alone, and gives the golden numbers."""

import ctypes
import random
import shutil
import subprocess
from array import array

import numpy as np
import pytest
from zerorate import Corrector, Sensor
from zerorate.model import EffectModel
from zerorate.storage import codes
from zerorate.storage.crc32 import checksum
from zerorate.storage.learned_store import LearnedStore
from zerorate_fakes.memory import FakeMemory, PowerCut
from zerorate_tools import layout
from zerorate_tools.cli import main
from zerorate_tools.kernels.export import export_c
from zerorate_tools.model import read_model, write_model
from zerorate_tools.model.files import sensor_for

from ..firmware import trace
from ..firmware.trace_on_host import checksums, corrector_for, frames, golden

pytestmark = pytest.mark.skipif(not shutil.which("cc"), reason="no C compiler (cc) here")
WARNINGS = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]


def sources_in(folder):
    """The firmware and its test program, as a compiler takes them."""
    return ["-I", folder, folder / "zerorate.c", folder / "test" / "zerorate_test.c"]


def test_the_test_program_says_that_the_state_is_equal(tmp_path, capsys):
    assert main(["export", "c", str(tmp_path / "c")]) == 0
    names = {line.rpartition("/c/")[2] for line in capsys.readouterr().out.splitlines()}
    assert {"zerorate.h", "zerorate.c", "zerorate_units.h", "test/zerorate_test.c"} <= names
    sources, program = sources_in(tmp_path / "c"), tmp_path / "program"
    subprocess.run(["cc", *WARNINGS, "-O1", *sources, "-o", program], check=True)
    assert subprocess.run([program], check=True, capture_output=True).stdout.startswith(b"equal")


def test_it_ends_the_golden_trace_in_the_golden_state(tmp_path):
    export_c(tmp_path, Sensor(*trace.SENSOR))
    library = tmp_path / "zerorate.so"
    subprocess.run(
        ["cc", "-O1", "-shared", "-fPIC", tmp_path / "zerorate.c", "-o", library], check=True
    )
    made, corrector = ctypes.CDLL(str(library)), corrector_for("default")
    z = (ctypes.c_int32 * (len(corrector.state) + len(corrector.settings)))()
    made.zerorate_begin(z)
    z[len(corrector.state) :] = list(corrector.settings)  # the trace has limits of its own
    rows, dt_us = frames(trace.UPDATES["default"])
    for row, dt in zip(rows, dt_us.tolist()):
        made.zerorate_update(z, (ctypes.c_int32 * 7)(*row.tolist()), dt)
    state = array("i", z[: len(corrector.state)])
    assert checksums(state.tobytes(), b"")["state"] == golden("default")["state"]


def test_a_model_may_be_named_by_its_readable_twin(tmp_path, matrix_model):
    model = read_model(matrix_model.path)
    write_model(model, tmp_path)
    for kind in ("bin", "json"):
        export_c(tmp_path / kind, model=tmp_path / f"model.{kind}")
    of_bin, of_json = ((tmp_path / kind / "zerorate.c").read_text() for kind in ("bin", "json"))
    assert of_bin == of_json


def test_a_model_is_applied_to_every_sample_as_on_a_board(tmp_path, matrix_model):
    assert main(["export", "c", str(tmp_path / "c"), "--model", str(matrix_model.path)]) == 0
    sources = sources_in(tmp_path / "c")
    subprocess.run(["cc", *WARNINGS, *sources, "-o", tmp_path / "program"], check=True)
    subprocess.run([tmp_path / "program"], check=True, capture_output=True)
    library = tmp_path / "zerorate.so"
    subprocess.run(["cc", "-shared", "-fPIC", *sources[:3], "-o", library], check=True)
    made, z = ctypes.CDLL(str(library)), (ctypes.c_int32 * 4096)()
    made.zerorate_begin(z)
    lsb, left = matrix_model.lsb_per_dps, []
    for rate in matrix_model.rates_dps:
        words = [round(v * lsb) for v in rate]
        sample = (ctypes.c_int32 * 7)(0, 0, 16384, 0, *words)
        made.zerorate_update(z, sample, 10000)
        left.append([(sample[4 + i] - words[i]) / lsb for i in range(3)])
    # each rate is rounded to an LSB on its way in and out, and what that leaves over is carried
    wanted = -matrix_model.rates_dps @ matrix_model.error.T
    np.testing.assert_allclose(left, wanted, atol=1.1 / lsb)


BINDING = bytes([0x68, 0, 0, 3])
READ = ctypes.CFUNCTYPE(
    ctypes.c_int32, ctypes.c_void_p, ctypes.c_uint32, ctypes.c_void_p, ctypes.c_uint32
)


class CStore(ctypes.Structure):
    """zerorate_store_t, without the room at its end."""

    _fields_ = [
        ("read", READ),
        ("write", READ),
        ("context", ctypes.c_void_p),
        ("base", ctypes.c_uint32),
        ("pitch", ctypes.c_uint32),
        ("binding", ctypes.c_uint8 * 4),
        ("record", ctypes.c_uint8 * 4096),
    ]


def compiled(folder, **made):
    export_c(folder, **made)
    command = ["cc", "-O1", "-shared", "-fPIC", folder / "zerorate.c", "-o", folder / "z.so"]
    subprocess.run(command, check=True)
    return ctypes.CDLL(str(folder / "z.so"))


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return compiled(tmp_path_factory.mktemp("c"), sensor=Sensor())


class InC:
    """A zerorate_t whose store is a FakeMemory."""

    def __init__(self, library, memory, binding=BINDING):
        corrector = Corrector(Sensor(), motion=False, gravity=False)
        self.words, self.memory, self._c = len(corrector.state), memory, library
        kept = self.words + len(corrector.settings)
        self.z = (ctypes.c_int32 * (kept + layout.EFFECTS.size))()  # the last for a model
        size = 24 + 4 * kept
        self.size = size
        self.store = CStore(READ(self._read), READ(self._write), None, 0, size)
        self.store.binding[:] = binding
        self._c.zerorate_begin(self.z)

    @property
    def state(self):
        return array("i", self.z[: self.words])

    def _read(self, _, at, data, count):
        piece = bytearray(count)
        try:
            self.memory.readblock(at, piece)
        except OSError:
            return 1
        ctypes.memmove(data, bytes(piece), count)
        return 0

    def _write(self, _, at, data, count):
        try:
            self.memory.writeblock(at, ctypes.string_at(data, count))
        except (OSError, PowerCut):
            return 1
        return 0

    def update(self, sample, dt_us):
        self._c.zerorate_update(self.z, (ctypes.c_int32 * 7)(*sample), dt_us)

    def load(self, same=False):
        return self._c.zerorate_load(self.z, ctypes.byref(self.store), int(same))

    def save(self):
        return bool(self._c.zerorate_save(self.z, ctypes.byref(self.store)))


def in_python(memory, sensor=None, binding=BINDING):
    corrector = Corrector(sensor or Sensor(), motion=False, gravity=False)
    return LearnedStore(memory, binding, corrector)


def rested(seed, count=4000):
    """Frames of rests at changing temperatures, with a jump of the bias."""
    noise = random.Random(seed).gauss
    for i in range(count):
        bias = 400 + seed if i < count // 2 else 120
        accel = [round(noise(mean, 40)) for mean in (0, 0, 16384)]
        gyro = [round(noise(bias, 6.5)) for _ in range(3)]
        yield array("i", [*accel, round(-3000 + i / 2 + noise(0, 8)), *gyro])


@pytest.fixture
def both(library):
    """Python's store and C's after the same samples, each on its own memory."""
    python, c = in_python(FakeMemory(8192)), InC(library, FakeMemory(8192))
    for sample in rested(1):
        c.update(sample, 10000)
        python.corrector.update(sample, 10000)
    assert c.state == python.corrector.state
    return python, c


def alike(library, memory, same=False):
    """Load what a memory holds by both; the reason, once it was found to be one, and the state."""
    python, c = in_python(memory), InC(library, memory)
    reason = python.load(same)
    assert (c.load(same), c.state) == (reason, python.corrector.state)
    return reason


def test_records_are_the_same_to_the_byte(both):
    python, c = both
    for _ in range(3):
        assert python.save() and c.save()
        assert python.state.storage.bytes == c.memory.bytes


@pytest.mark.parametrize("same", [False, True])
def test_a_power_on_begins_with_the_same_state_and_goes_on_alike(library, both, same):
    _, c = both
    assert c.save()
    assert alike(library, c.memory, same) == codes.LOADED
    python, again = in_python(c.memory), InC(library, c.memory)
    assert python.load(same) == again.load(same) == codes.LOADED
    for sample in rested(2, 500):
        again.update(sample, 10000)
        python.corrector.update(sample, 10000)
    assert again.state == python.corrector.state


def test_beside_a_model_the_record_is_that_of_python_beside_it(tmp_path, matrix_model, both):
    with_model = compiled(tmp_path, model=matrix_model.path)
    effects, sensor = EffectModel(), sensor_for(read_model(matrix_model.path).scales)
    python, plain = in_python(FakeMemory(8192), sensor), both[1]
    assert effects.load(matrix_model.path.read_bytes(), sensor) == codes.LOADED
    python.corrector.use_model(effects)
    c = InC(with_model, FakeMemory(8192))
    assert python.save() and c.save() and plain.save()
    assert python.state.storage.bytes == c.memory.bytes
    assert c.load() == python.load() == codes.LOADED
    assert InC(with_model, plain.memory).load() == codes.OTHER_BINDING


def test_a_cut_at_any_byte_leaves_what_was_stored_before(library, both):
    _, c = both
    assert c.save()
    for cut in [*range(0, c.size, 53), *range(c.size - 6, c.size)]:
        memory = FakeMemory(8192)
        memory.bytes[:] = c.memory.bytes
        writer = InC(library, memory)
        writer.z[: c.words] = c.z[: c.words]
        memory.cut_after = cut
        assert not writer.save()
        memory.cut_after = None
        assert alike(library, memory) == codes.LOADED


def test_any_bit_turned_is_said_as_by_python(library, both):
    _, c = both
    assert c.save()
    luck = random.Random(3)
    bits = [*range(24 * 8), *(luck.randrange(8 * c.size) for _ in range(150))]
    for _ in range(2):
        for bit in bits:
            c.memory.flip(bit)
            alike(library, c.memory)
            c.memory.flip(bit)
        assert c.save()


def test_a_turned_word_with_a_right_checksum_is_refused_where_python_refuses(library, both):
    _, c = both
    assert c.save()
    luck, seen = random.Random(4), set()
    for _ in range(400):
        memory = FakeMemory(8192)
        memory.bytes[:] = c.memory.bytes
        at = 20 + 4 * luck.randrange(c.words)
        word = luck.choice([luck.randrange(-(2**31), 2**31), luck.randrange(-300, 300)])
        memory.bytes[at : at + 4] = word.to_bytes(4, "little", signed=True)
        check = bytearray(4)
        checksum(bytes(memory.bytes[: c.size - 4]), check)
        memory.bytes[c.size - 4 : c.size] = check
        seen.add(alike(library, memory))
    assert seen == {codes.LOADED, codes.OUT_OF_RANGE}


def test_each_reason_is_said_as_by_python(library, both):
    _, c = both
    assert alike(library, FakeMemory(8192)) == codes.EMPTY
    assert c.save()
    other = InC(library, c.memory, bytes([0x70, 0, 0, 3]))
    assert other.load() == codes.OTHER_BINDING
    for at, reason in ((4, codes.OTHER_VERSION), (3, codes.OTHER_VERSION)):
        memory = FakeMemory(8192)
        memory.bytes[:] = c.memory.bytes
        memory.bytes[at] ^= 4
        check = bytearray(4)
        checksum(bytes(memory.bytes[: c.size - 4]), check)
        memory.bytes[c.size - 4 : c.size] = check
        assert alike(library, memory) == reason
    c.memory.broken = True
    assert (c.load(), c.save()) == (codes.UNREADABLE, False)
