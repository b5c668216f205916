"""Every kernel of the firmware, called as traces call it and with words beside those, and its
integer arithmetic with numbers of all sizes: checksums.

A kernel is given the arguments of its first, fourth, sixteenth ... call. Then single words
that it reads are changed: by one, in sign, or to what it may compare them with, or one beside.
"""

import ast
import importlib
import inspect
import random
import sys
import zlib
from array import array
from contextlib import ExitStack
from functools import cache, partial
from unittest import mock

import numpy as np
from zerorate import Corrector, Sensor
from zerorate.arithmetic import atan2, fixed, real
from zerorate.effects import effect_refine, effects
from zerorate.rest import block
from zerorate_tools.kernels.reading import Kernels
from zerorate_tools.layout import SETTINGS, STATE, STILLNESS

from ..firmware import swung, trace
from ..firmware.checked import OutOf31Bits, checked
from ..firmware.simulated_sources import every_slot
from ..firmware.trace_on_host import corrector_for, frames

_PLACES = {*"adefhpqwz", "at", "to", "ring"}  # parameters that say where in an array
_MOST_READS = 3_000  # of one call: a changed word may ask for more rounds than there are words
_READS, _VARIANTS = 2_000, 40  # of one recorded call's variants together
_MOST, _MOST_OF_LITTLE = 1 << 29, 1 << 11  # what a word is changed to at most


class Noted(list):
    """Words that note what is read and written. Raises OutOf31Bits where there is no end."""

    def __init__(self, words):
        super().__init__(words)
        self.read, self.written = [], {}

    def __getitem__(self, at):
        self.read.append(at)
        if len(self.read) > _MOST_READS:
            raise OutOf31Bits
        return checked(super().__getitem__(at))

    def __setitem__(self, at, value):
        super().__setitem__(at, value)
        self.written[at] = int(checked(value))


@cache
def _homes():
    """{kernel: (its folder, its file and name)} of all kernels of the firmware."""
    found, kernels = {}, Kernels()
    for file in kernels.files.values():
        parts = file.path.relative_to(kernels.package).with_suffix("").parts
        module = importlib.import_module(".".join(("zerorate", *parts)))
        found |= {getattr(module, n): (parts[0], f"{file.name}.{n}") for n in file.kernels}
    return found


def _recorded(folder, drive):
    """{kernel: arguments of some of its calls} of a folder's kernels while `drive` runs."""
    calls = {kernel: [] for kernel, (home, _) in _homes().items() if home == folder}
    noting = {kernel: _noting(kernel, calls[kernel]) for kernel in calls}
    with ExitStack() as patches:
        for module in [m for name, m in sys.modules.items() if name.startswith("zerorate.")]:
            names = [n for n, v in vars(module).items() if callable(v) and v in noting]
            of_module = {name: noting[getattr(module, name)] for name in names}
            if of_module:
                patches.enter_context(mock.patch.multiple(module, **of_module))
        drive()
    return calls


def _noting(kernel, calls):
    """The kernel, which from now on adds the arguments of some calls to `calls`."""
    count = 0

    def noted(*args):
        nonlocal count
        count += 1
        if count & (count - 1) == 0 and count.bit_length() % 2:
            copies = {id(a): list(a) for a in args if not isinstance(a, int)}
            calls.append([copies.get(id(a), a) for a in args])
        return kernel(*args)

    return noted


def _called(kernel, args):
    """(what it returns or raises and writes, {(argument, word or None): value} that it reads)."""
    watched = {id(a): Noted(a) for a in args if isinstance(a, list)}
    given = [watched.get(id(a)) or checked(a) for a in args]
    try:
        returned = kernel(*given)
    except (OutOf31Bits, IndexError, ValueError) as error:
        returned = type(error).__name__
    names, reads = kernel.__code__.co_varnames, {}
    for n, (name, words, before) in enumerate(zip(names, given, args)):
        if isinstance(words, Noted) and name != "c":
            reads |= {(n, at): before[at] for at in words.read if -1 < at < len(before)}
        elif name not in _PLACES and not isinstance(words, Noted):
            reads[n, None] = before
    written = [words.written for words in watched.values()]
    return repr((returned, written)).encode(), reads


def _numbers_in(kernel):
    """The numbers that stand in a kernel, by themselves or by name."""
    nodes = list(ast.walk(ast.parse(inspect.getsource(kernel))))
    found = [node.value for node in nodes if isinstance(node, ast.Constant)]
    found += [kernel.__globals__.get(node.id) for node in nodes if isinstance(node, ast.Name)]
    return [number for number in found if type(number) is int]


def _beside(value, others, luck):
    """Another value of a word, near to its own or to one of the others."""
    near = int(luck.random() * 3) - 1
    other = others[int(luck.random() * len(others))] + near
    choices = (value + 1, value - 1, -value, other, other, -other, other << 4, other >> 4)
    found = choices[int(luck.random() * len(choices))]
    most = min(max(_MOST_OF_LITTLE, abs(value) << 6), _MOST)
    return max(-most, min(found, most))


def _changed(args, changes):
    """The arguments, arrays copied, with {(argument, word or None): value} put in."""
    copies = {id(a): list(a) for a in args if isinstance(a, list)}
    found = [copies.get(id(a), a) for a in args]
    for (n, at), value in changes.items():
        if at is None:
            found[n] = value
        else:
            found[n][at] = value
    return found


def _said(kernel, calls):
    """Checksum of what a kernel makes of the calls, and of what stands beside them."""
    luck, said = random.Random(4), 0
    for args in calls:
        result, reads = _called(kernel, args)
        said = zlib.crc32(result, said)
        places, others = list(reads), [*reads.values(), *_numbers_in(kernel)]
        for _ in range(min(_VARIANTS, _READS // (1 + len(reads))) if places else 0):
            chosen = (places[int(luck.random() * len(places))] for _ in range(2))
            changes = {place: _beside(reads[place], others, luck) for place in chosen}
            result, _ = _called(kernel, _changed(args, changes))
            said = zlib.crc32(result, said)
    return [f"{len(calls)} calls: {said:08x}"]


def _rest():
    """A trace in every mode, in bursts again after a power-on; and a device that swings."""
    for mode in trace.MODES:
        corrector = corrector_for(mode)
        rows, dt_us = frames(7000 if mode == "default" else 3000)
        for row, dt in zip(rows.tolist(), dt_us.tolist()):
            corrector.update(array("i", row), dt)
        corrector.power_on()
        burst = array("i", np.c_[dt_us, rows].astype(np.int32)[:1200].tobytes())
        block.block(corrector.state, burst, corrector.settings, array("i", [0] * 7), 1200)
    corrector = Corrector(Sensor(*trace.SENSOR), promote_s=4.0, fit_s=5.0)
    for frame, dt_us in swung.frames():
        corrector.update(array("i", frame), dt_us)


def _swung(source):
    """A device that swings, as a source in the forms of its settings sees it."""
    for name in (name for name in swung.SOURCES if name.startswith(source)):
        update, state, settings = swung.SOURCES[name]()
        for frame, dt_us in swung.frames():
            update(state, settings, frame, dt_us)


def _effects():
    """A model of every kind of slot, whose coefficients learn."""
    model = every_slot()
    model.refine()
    state, settings = array("i", [0] * STATE.FIT_WEIGHTS), array("i", [0] * SETTINGS.size)
    settings[SETTINGS.WINDOW_SHIFT], settings[SETTINGS.SEGMENT] = 3, 1
    state[STATE.STILLNESS] = STILLNESS.STILL
    for n in range(1200):
        frame = array("i", [(n * (i + 3) * 7919 >> 3) % 9001 - 4500 for i in range(7)])
        frame[3] = 6000 - abs(n * 20 - 12000)
        model.channel("vdd_mv", 5000 + n % 97)
        effects.sense(state, model.e, frame, 3000000 if n % 211 == 0 else 250000, int(n % 13 > 0))
        state[STATE.WINDOW_N] = n % 8
        for axis in range(3):
            state[STATE.SEGMENT_TOTAL + axis] = n * (axis + 5) * 104729 % 60013 - 20000
        effect_refine.attend(state, settings, model.e)


_DRIVES = {
    "rest": _rest,
    "motion": partial(_swung, "motion"),
    "gravity": partial(_swung, "gravity"),
}
_DRIVES["effects"] = _effects


def _figures(folder):
    """{file and name of a kernel: [checksum]}."""
    calls = _recorded(folder, _DRIVES[folder])
    return {_homes()[kernel][1]: _said(kernel, of) for kernel, of in calls.items()}


KERNELS = {f"kernels of {folder}": partial(_figures, folder) for folder in _DRIVES}


_TIMES = 1500
# function -> the bits of each number that it takes, negative where its sign is free
_OF_NUMBERS = {
    fixed.scaled: (-28, -28, range(15, 31)),
    fixed.fraction_q27: (19, 19),
    fixed.ratio_q26: (-28, 28),
    fixed.room: (-30,),
    fixed.floating_ratio_q26: (-30, -30, range(-40, 40)),
    fixed.clipped: (-29, 9),
    fixed.root: (30,),
    atan2.arc_q13: (16,),
    atan2.atan2_q13: (-30, -30),
    real.high_product: (-28, -28),
    real.quotient_q27: (28, 28),
}
_OF_WORDS = (real.multiply, real.add, real.subtract, real.divide, real.root_of, real.pack)


def _numbers(rng, bits):
    """Numbers of any size below 2^bits, every other one beside a power of two."""
    if isinstance(bits, range):
        return rng.choice(bits, _TIMES).tolist()
    powers = 1 << rng.integers(0, abs(bits), _TIMES)
    near = powers + rng.integers(-1, 2, _TIMES)
    any_size = rng.integers(0, 1 << 30, _TIMES) >> rng.integers(30 - abs(bits), 31, _TIMES)
    found = np.where(rng.random(_TIMES) < 0.5, near, any_size)
    return (found * rng.choice([-1, 1], _TIMES) if bits < 0 else found).tolist()


def _words(rng):
    """What each function of numbers in two words leaves of two of them."""
    parts = zip(
        _numbers(rng, -30), _numbers(rng, -30), *(_numbers(rng, range(-60, 60)) for _ in "mn")
    )
    for m, n, e, f in parts:
        s = [0] * 12
        real.put(s, 0, m, e)
        real.put(s, 2, n, f)
        for function in _OF_WORDS:
            s[0] = abs(s[0]) if function is real.root_of else s[0]
            function(s, 4, 0, *(2,) * (function.__code__.co_argcount - 3))
            yield s[4:6]
        real.unpack(s, 6, 4)
        real.copy(s, 9, 6, 3)
        yield [*s, real.whole(s, 2, f // 2)]


def arithmetic():
    """{function: checksum of what it returns}."""
    rng, found = np.random.default_rng(8), {}
    for function, sizes in _OF_NUMBERS.items():
        given = [_numbers(rng, bits) for bits in sizes]
        if function in (fixed.fraction_q27, real.quotient_q27):  # of a part, or of less than twice
            given = [[a % (b + 1) for a, b in zip(*given)], [b + 1 for b in given[1]]]
        found[function.__name__] = [function(*of) for of in zip(*given)]
    found["words"] = list(_words(rng))
    return {name: [f"{zlib.crc32(repr(of).encode()):x}"] for name, of in found.items()}
