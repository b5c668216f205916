"""An update allocates nothing, whatever happens in it.

The trace runs under a locked heap in test_equal_to_the_last_bit.py, where every interpreter gives
the same state; so what happens in it here happens there.
"""

import re
from collections import Counter

import pytest
from zerorate import Corrector
from zerorate.rest import bias, estimators, fit, guard, histogram, recent
from zerorate_bench.cost_report import import_heap_bytes
from zerorate_tools.layout import AXIS, MARKS, SETTINGS, STATE, STILLNESS, axis_at

from . import trace
from .played import IMPORT_BYTES, STATE_BYTES
from .trace_on_host import on_cpython

_FREE = -1048576


class Events:
    """Counts what the kernels do in this process; equal states mean equal events elsewhere."""

    def __init__(self, patch):
        self.patch = patch
        self.seen = Counter()
        for kernel in ("merge", "open_gap", "share_evenly", "share_by_mean", "halve"):
            self.count(histogram, kernel)
        self.count(histogram, "recentre", lambda args, result: result)
        self.count(histogram, "place", lambda args, result: "outside" if result < 0 else "")
        self.count(estimators, "halve")
        self.count(estimators, "age")
        self.count(estimators, "make_room", before=self.of_the_oldest)
        self.count(estimators, "copy", before=lambda s, c, to, e: s[to] != MARKS.FREE)
        self.count(fit, "settle")
        self.count(recent, "plausible", lambda args, result: result)

    @staticmethod
    def of_the_oldest(s, c, a, temp):
        return s[s[a + AXIS.ORDER - 1 + c[SETTINGS.SHORT]]] != MARKS.FREE

    def count(self, module, name, after=None, before=None):
        plain = getattr(module, name)

        def counting(*args):
            found = before(*args) if before else ""
            result = plain(*args)
            self.seen[name, after(args, result) if after else found] += 1
            return result

        self.patch.setattr(module, name, counting)

    def look(self, corrector, verdict):
        """Count what the state shows after an update."""
        s, c = corrector.state, corrector.settings
        self.seen["verdict", verdict] += 1
        self.seen["stillness", s[STATE.STILLNESS]] += 1
        for axis in range(3):
            a = axis_at(c, axis)
            self.seen["source", s[STATE.SOURCE + axis]] += 1
            self.seen["beyond", s[a + AXIS.BEYOND]] += 1
            self.seen["suspect", min(1, max(0, s[a + AXIS.SUSPECT]))] += 1


@pytest.fixture(scope="module", params=sorted(trace.MODES))
def events(request):
    with pytest.MonkeyPatch.context() as patch:
        counted = Events(patch)
        on_cpython(request.param, counted.look)
        yield request.param, counted.seen


ALWAYS = {
    "eviction": ("make_room", True),
    "halving": ("halve", ""),
    "periodic halving": ("age", ""),
    "refit": ("settle", ""),
    "no bias yet": ("source", bias.NONE),
    "fallback": ("source", bias.ANY_TEMPERATURE),
    "good": ("verdict", guard.GOOD),
    "repeat": ("verdict", guard.REPEAT),
    "rail": ("verdict", guard.RAIL),
    "all zero": ("verdict", guard.ALL_ZERO),
    "all ones": ("verdict", guard.ALL_ONES),
    "temperature jump": ("verdict", guard.TEMPERATURE_JUMP),
    "time stood still": ("verdict", guard.TIME_STOOD_STILL),
    "time leapt": ("verdict", guard.TIME_LEAPT),
    "unknown": ("stillness", STILLNESS.UNKNOWN),
    "still": ("stillness", STILLNESS.STILL),
    "moving": ("stillness", STILLNESS.MOVING),
    "turning": ("stillness", STILLNESS.TURNING),
    "shaken": ("stillness", STILLNESS.SHAKEN),
    "shifted": ("stillness", STILLNESS.SHIFTED),
}
LINE = {"promotion": ("copy", False), "line": ("source", bias.FIT), "beyond": ("beyond", 1)}
# One bin, which is the default, is never split.
BINS = {"merge": ("merge", ""), "split": ("open_gap", "")}
IN_MODE = {
    "default": {
        **LINE,
        "replacement": ("copy", True),
        "held back": ("plausible", 0),
        "insisted": ("plausible", 2),
        "suspect": ("suspect", 1),
    },
    "every": {**LINE, **BINS, "recentre": ("recentre", 1), "share by mean": ("share_by_mean", "")},
    "document": {
        **LINE,
        **BINS,
        "the temperature's own": ("source", bias.HERE),
        "replacement": ("copy", True),
        "share evenly": ("share_evenly", ""),
    },
    "ignoring": {**BINS, "ignored": ("place", "outside")},
}


def test_the_trace_covers_every_event(events):
    mode, seen = events
    missing = [name for name, event in {**ALWAYS, **IN_MODE[mode]}.items() if not seen[event]]
    assert missing == [], f"{mode}: {dict(seen)}"


def test_the_state_of_three_axes_stays_within_its_limit(capsys):
    size = len(Corrector().state) * 4
    with capsys.disabled():
        print(f"\nstate of three axes: {size} bytes")
    assert 0 < size <= STATE_BYTES


def test_importing_the_firmware_takes_no_more_heap_than_it_may(find_runtime, repository, capsys):
    find_runtime("wasm")
    taken = import_heap_bytes(repository / "firmware")
    source = (repository / "firmware" / "zerorate" / "corrector.py").read_text()
    held = int(re.search(r"^_held = \[bytearray\((\d+)\)\]$", source, re.MULTILINE)[1])
    with capsys.disabled():
        print(f"\nheap of `import zerorate` on wasm: {taken} bytes, {held} of them held")
    assert 8192 < taken - held <= IMPORT_BYTES
