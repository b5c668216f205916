"""The sources that need no rest, and the effects: a sample's way through them, and their start."""

from .native import rest, rest_pieces

TYPE_CHECKING = False
if TYPE_CHECKING:
    from array import array
    from typing import Any

# layout: names that a board's own compiler reads
const = int
# layout: The corrector's state
_STILLNESS = const(19)
# layout: The state of the source in motion
_MOTION_BIAS_Q8 = const(73)
_LATE_US = const(442)
# layout: The state of the source against gravity
_GRAVITY_BIAS_Q8 = const(28)
_GRAVITY_LATE_US = const(58)
# layout: What a window was
_SILENT = const(6)
# layout: Where a bias comes from
_IN_MOTION = const(4)
_GRAVITY = const(5)
# layout: end
_MOST_US = const(0x1FFFFFFF)  # two of them fit 31 bits


class Fusion:
    """What `corrector`, a Corrector, has besides learning at rest."""

    def __init__(self, corrector: "Any") -> None:
        self._of = corrector
        c = corrector.settings
        # an odd address asks the guard alone
        self._guard = rest.address(c) + 1 if rest.run else c

    # small frames: one of more than eleven words would take heap at every call
    def update(self, sample: "array[int]", dt_us: int) -> int:
        """As Corrector.update."""
        kind = rest_pieces.check(self._of.state, self._guard, sample, dt_us)
        self._sense_effects(sample, dt_us, kind)
        rest_pieces.admit(self._of.state, self._of.settings, sample, kind)
        if kind == 0 and self._of.state[_STILLNESS] != _SILENT:
            self._ask_others(sample, dt_us)
        else:
            self._pass_over(dt_us)
        return rest_pieces.finish(self._of.state, self._of.settings, sample, kind)

    def _sense_effects(self, sample, dt_us, kind):
        if self._of.effects is not None:
            kind = 0 if kind else 1
            self._of._sense(self._of.state, self._of.effects.e, sample, dt_us, kind)

    def _ask_others(self, sample, dt_us):
        owner = self._of
        if owner.effects is not None:
            sample = owner.effects.e  # its first words are the frame less the effects
        if owner.motion is not None:
            if owner._observe_motion(owner.motion, owner.motion_settings, sample, dt_us):
                self._consider(owner.motion, _MOTION_BIAS_Q8, _IN_MOTION)
        if owner.gravity is not None:
            if owner._observe_gravity(owner.gravity, owner.gravity_settings, sample, dt_us):
                self._consider(owner.gravity, _GRAVITY_BIAS_Q8, _GRAVITY)
        effects = owner.effects
        if effects is not None and effects.attend:
            effects.attend(owner.state, owner.settings, effects.e)

    def _pass_over(self, dt_us):
        # the next good frame tells how it turned in this one's time, too
        dt_us = min(max(dt_us, 0), _MOST_US)
        owner = self._of
        if owner.motion is not None:
            owner.motion[_LATE_US] = min(owner.motion[_LATE_US] + dt_us, _MOST_US)
        if owner.gravity is not None:
            owner.gravity[_GRAVITY_LATE_US] = min(owner.gravity[_GRAVITY_LATE_US] + dt_us, _MOST_US)

    def _consider(self, found, bias_at, source):
        rest_pieces.consider(self._of.state, self._of.settings, found, bias_at, source)


def join(corrector):
    """Let its samples go by what it has besides learning at rest."""
    if corrector.alone:
        corrector._with_others = Fusion(corrector).update
        corrector.alone = False
        if "update" in corrector.__dict__:
            del corrector.update
        if corrector.leave_bursts:
            corrector.leave_bursts()


def forget(corrector):
    """Make the state of each source as new: its window holds what was before a power-on."""
    if corrector.motion is not None:
        from .native import motion

        clear(corrector.motion, motion.clear, corrector.motion_settings)
    if corrector.gravity is not None:
        from .native import gravity

        clear(corrector.gravity, gravity.clear, corrector.gravity_settings)


def clear(state, begin, settings):
    """Make a source's state as new, in place: a copy of it would want as much heap again."""
    for i in range(len(state)):
        state[i] = 0
    begin(state, settings)
