"""A FIFO's burst in one call. It takes memory of those alone who import it."""

from array import array

from .native import rest

# layout: names that a board's own compiler reads
const = int
# layout: end
# what the number of samples is added to (tools/zerorate_tools/kernels/parts.py)
_BURST = const(-0x3FFA0000)


class Bursts:
    """Gives `corrector` (a Corrector) many samples a call, which machine code does faster."""

    def __init__(self, corrector):
        self.corrector = corrector
        self._frame = array("i", [0] * 7)
        self._run = None
        if rest.run:
            self._run = rest.step
            # to look up where they lie takes as long as two samples
            self._state = rest.address(corrector.state)
            self._settings = rest.address(corrector.settings)

    def update(self, frames, count):
        """Do what `Corrector.update` does with each of `count` samples; allocates nothing.

        frames: array('i') of eight words a sample: dt_us, then ax ay az temp gx gy gz. Rates are
        corrected in place, and each first word becomes what `Corrector.update` returns.
        """
        run = self._run
        if run and self.corrector.alone:
            run(self._state, self._settings, frames, _BURST + count)
        else:
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
