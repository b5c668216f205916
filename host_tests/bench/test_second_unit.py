"""A model of one unit, refined on another one of the same part."""

from zerorate_bench.second_unit import WAYS, SecondUnit, device, errors_mdps
from zerorate_tools.layout import SLOT, slot_at
from zerorate_tools.loop.verify.firmware import rows
from zerorate_tools.replay.engines import InterpreterEngine, NativeEngine
from zerorate_tools.replay.samples import Frames

NONE, AS_IT_IS, REFINED = WAYS


def copied(frames):
    return Frames(frames.t_us, frames.frames.copy(), frames.dt_us, frames.extra)


def test_the_second_unit_is_left_less_than_half_when_it_refines_the_firsts_model():
    errors = errors_mdps(seed=1)
    assert errors[AS_IT_IS] < errors[NONE]
    assert errors[REFINED] < 0.5 * errors[AS_IT_IS]


def test_its_coefficients_move_towards_its_own():
    unit, corrector = SecondUnit(seed=2), device(REFINED)
    frames, _ = unit.power_on()
    next(iter(NativeEngine().run(corrector, [frames])))
    e = corrector.effects.e
    for slot, axis in ((0, 0), (0, 1), (1, 0)):
        at = slot_at(slot) + axis
        moved = e[at + SLOT.SLOT_COEFFICIENT] / e[at + SLOT.SLOT_OWN]
        own = unit.share[slot, axis]
        assert abs(moved - own) < 0.7 * abs(1.0 - own), (slot, axis, moved, own)


def test_a_board_refines_as_this_computer_does(micropython):
    unit = SecondUnit(seed=3)
    frames, _ = unit.power_on()
    part = rows(frames, 0, 6000)
    here, there = device(REFINED), device(REFINED)
    expected = next(iter(NativeEngine().run(here, [copied(part)])))
    found = next(iter(InterpreterEngine(micropython).run(there, [copied(part)])))
    assert (found.bias_q8 == expected.bias_q8).all()
    assert there.effects.e == here.effects.e
