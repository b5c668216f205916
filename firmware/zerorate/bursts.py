"""A FIFO's burst in one call. It takes memory of those alone who import it."""

from array import array

from .native import rest

TYPE_CHECKING = False
if TYPE_CHECKING:
    from .corrector import Corrector

# layout: names that a board's own compiler reads
const = int
# layout: end
# what the number of samples is added to (tools/zerorate_bench/native/parts.py)
_BURST = const(-0x3FFA0000)


class Bursts:
    """Gives `corrector` (a Corrector) many samples a call, which machine code does faster."""

    def __init__(self, corrector: "Corrector") -> None:
        self.corrector = corrector
        self._frame = array("i", [0] * 7)
        if rest.run and corrector.alone:
            self.update = self._bound()  # type: ignore[method-assign]

    def _bound(self):
        # to look up where they lie takes as long as two samples, an attribute as long as one
        # of more than eleven words in `update` each call would take heap
        run = rest.step
        state = rest.address(self.corrector.state)
        settings = rest.address(self.corrector.settings)

        def update(frames, count):
            run(state, settings, frames, _BURST + count)

        def one_by_one(_state, _settings, frames, what):
            self._one_by_one(frames, what - _BURST)

        def leave():
            nonlocal run
            run = one_by_one

        self.corrector.leave_bursts = leave
        return update

    def update(self, frames: "array[int]", count: int) -> None:
        """Do what `Corrector.update` does with each of `count` samples; allocates nothing.

        frames: array('i') of eight words a sample: dt_us, then ax ay az temp gx gy gz. Rates are
        corrected in place, and each first word becomes what `Corrector.update` returns.
        """
        self._one_by_one(frames, count)

    def _one_by_one(self, frames, count):
        for i in range(count):
            self._update_at(frames, 8 * i)

    def _update_at(self, frames, at):
        frame = self._frame
        for k in range(7):
            frame[k] = frames[at + 1 + k]
        frames[at] = self.corrector.update(frame, frames[at])
        for k in range(7):
            frames[at + 1 + k] = frame[k]
