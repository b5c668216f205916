"""Every fault of a bus and every cut of a write, injected: what was detected, what was learned."""

from array import array

from zerorate.corrector import Corrector
from zerorate.storage.codes import LOADED
from zerorate.storage.store import Store
from zerorate_fakes.memory import FakeMemory, PowerCut

from .bus_faults import FAULTS, run_fault
from .tables import table

_BINDING = bytes([0x68, 0, 0, 3])
_ROUNDS = 3


def run() -> dict:
    """Inject everything and return both tables.

    faults: name -> injected, detected, learned_from (false samples that what was learned holds),
    false_samples (those that the driver handed out as good). store: cuts, flips, wrong_loads,
    exceptions.
    """
    return {"faults": {name: run_fault(name) for name in FAULTS}, "store": run_store()}


def passed(found: dict) -> bool:
    """Every fault detected and nothing learned from any, no wrong load and no exception."""
    store = found["store"]
    return (
        all(
            row["injected"] > 0 and row["detected"] == row["injected"] and row["learned_from"] == 0
            for row in found["faults"].values()
        )
        and store["cuts"] > 0
        and store["flips"] > 0
        and store["wrong_loads"] == store["exceptions"] == 0
    )


def in_markdown(found: dict) -> str:
    rows = [[name, *row.values()] for name, row in found["faults"].items()]
    store = found["store"]
    counts = [store[name] for name in ("cuts", "flips", "wrong_loads", "exceptions")]
    faults = table(["fault", "injected", "detected", "learned from", "false handed out"], rows)
    head = ["store", "cuts", "flips", "wrong loads", "exceptions"]
    return faults + "\n" + table(head, [[f"{store['bytes']} bytes a slot", *counts]])


def run_store() -> dict[str, int]:
    """Counts of cuts, flips, wrong loads and exceptions, over the state as a board stores it."""
    store = StoreUnderFaults(len(Corrector().state))
    for round_ in range(_ROUNDS):
        store.cut_every_byte(round_)
    store.flip_every_bit()
    return store.counts


class StoreUnderFaults:
    """A memory with a store of some words, and the counts of what became of it."""

    def __init__(self, words: int) -> None:
        self._words = words
        slot_bytes = Store(FakeMemory(0), _BINDING, 4 * words).slot_bytes
        self._slot_bytes = slot_bytes
        self._memory = FakeMemory(2 * slot_bytes)
        names = ("cuts", "flips", "wrong_loads", "exceptions")
        self.counts = {**dict.fromkeys(names, 0), "bytes": slot_bytes}
        self._save(self._payload(0))

    def cut_every_byte(self, round_: int) -> None:
        """Cut the next save at each of its bytes; then let it through."""
        before, after = self._payload(round_), self._payload(round_ + 1)
        image = bytes(self._memory.bytes)
        for cut in range(self._slot_bytes):
            self._memory.bytes[:] = image
            self._memory.cut_after = cut
            try:
                self._save(after)
            except PowerCut:
                self.counts["cuts"] += 1
            self._memory.cut_after = None
            self._judge([before])
        self._memory.bytes[:] = image
        self._save(after)

    def flip_every_bit(self) -> None:
        """Turn each bit of both slots: the other slot is loaded, or the newest when it is whole."""
        allowed = [self._payload(_ROUNDS), self._payload(_ROUNDS - 1)]
        newest_slot = _ROUNDS % 2
        for bit in range(8 * 2 * self._slot_bytes):
            self._memory.flip(bit)
            in_newest = bit // (8 * self._slot_bytes) == newest_slot
            self.counts["flips"] += 1
            self._judge([allowed[1 if in_newest else 0]])
            self._memory.flip(bit)

    def _store(self) -> Store:
        return Store(self._memory, _BINDING, 4 * self._words)

    def _save(self, payload: array) -> None:
        self._store().save(payload)

    def _judge(self, allowed: list[array]) -> None:
        payload = array("i", bytes(4 * self._words))
        try:
            reason = self._store().load(payload)
        except Exception:
            self.counts["exceptions"] += 1
            return
        if reason != LOADED or payload not in allowed:
            self.counts["wrong_loads"] += 1

    def _payload(self, round_: int) -> array:
        return array(
            "i", [(word * 40503 + round_ * 977) % 100000 - 50000 for word in range(self._words)]
        )
