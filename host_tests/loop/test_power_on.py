"""A session as the firmware meets it, sample by sample, and the offset that it takes at turn-on."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_tools.loop.motion.scales_and_timing import InMotion
from zerorate_tools.loop.read.earth import Earth
from zerorate_tools.loop.verify.firmware import Firmware, Refused
from zerorate_tools.loop.verify.power_on import ideal_dps, turn_on
from zerorate_tools.model import Slot, drafted
from zerorate_tools.model.term import Term
from zerorate_tools.replay.engines import CPythonEngine
from zerorate_tools.replay.samples import Frames

from .power_ons import MPU, PER, TICKS, powered_on, with_volts

HZ = 5  # samples a tick


def test_every_sample_has_its_tick_and_block(tmp_path):
    columns = {name: values[:-3] for name, values in with_volts(blocks=6).items()}
    p = powered_on(tmp_path, columns, ("volt",))
    (frames,) = p.frames()
    at = np.arange(6 * PER - 3)
    assert p.ticks(frames).tolist() == (at // HZ).tolist()
    assert p.blocks(frames).tolist() == (at // PER).tolist()
    short = replace(p, session=replace(p.session, rate_dps=p.session.rate_dps[:5]))
    assert short.blocks(frames).max() == 4  # what is left over goes with the last block
    assert frames.extra[:, 0].tolist() == columns["volt"].tolist()
    pieces = [(block, len(part)) for block, part in p.by_blocks()]
    assert pieces == [(0, 20), (1, 20), (2, 20), (3, 20), (4, 20), (5, 17)]
    joined = np.vstack([part.frames for _, part in p.by_blocks()])
    assert (joined == frames.frames).all()


def test_steps_are_taken_out_of_the_samples_in_whole_counts(tmp_path):
    plain = powered_on(tmp_path, with_volts(blocks=6))
    level = np.zeros((6 * TICKS - 1, 3))  # the last goes on
    level[10:] = np.array([3.7, -2.25, 5.0]) / 131.0
    level[22:] = np.array([1.0, 2.0, -3.0]) / 131.0
    stepped = replace(plain, session=replace(plain.session, level_dps=level))
    (frames,), (less,) = plain.frames(), stepped.frames()
    taken = (frames.frames - less.frames)[:, 4:]
    assert (taken[: 10 * HZ] == 0).all()
    assert (taken[22 * HZ :] == [1, 2, -3]).all()
    after = taken[10 * HZ : 22 * HZ]
    for axis, counts in enumerate((3.7, -2.25, 5.0)):
        assert set(after[:, axis]) <= {np.floor(counts), np.ceil(counts)}
        assert after[:, axis].mean() == pytest.approx(counts, abs=0.02)
    assert (frames.frames[:, :4] == less.frames[:, :4]).all()


def test_what_an_ideal_bias_would_be_has_earth_s_rate_at_the_first_rest_in_it(tmp_path):
    session = powered_on(tmp_path, with_volts(blocks=20)).session
    assert (ideal_dps(session, InMotion()) == session.rate_dps).all()
    turning = np.outer(np.arange(22 * TICKS), [1.0, 2.0, 3.0])
    earth = replace(session, earth=Earth(turning, 0.0, ""))
    first = turning[: 15 * TICKS].mean(axis=0)  # of a minute in blocks of 4 s
    assert ideal_dps(earth, InMotion()) == pytest.approx(session.rate_dps + first)


class Scripted:
    """A device that knows its offset, on two axes or all, after so many samples.

    Its target is how many samples it has learned.
    """

    offset = 0, 0, 0

    def __init__(self, known_after, third=True):
        self.known_after, self.third = known_after, third
        self.seen = self.taught = 0

    def copy(self):
        return Scripted(self.known_after, self.third)

    def power_on(self):
        self.seen = 0

    def set_offset(self, offset):
        self.offset = offset

    def run(self, frames, learn=True):
        self.seen += len(frames)
        self.taught += len(frames) * learn
        return np.repeat([np.add(self.offset, [256, 0, 0])], len(frames), axis=0)

    @property
    def offset_is_known(self):
        known = self.seen >= self.known_after
        return np.array([known, known, known and self.third])

    @property
    def target_q8(self):
        return np.array([self.taught, 2 * self.taught, -self.taught])


@pytest.mark.parametrize(
    ("known_after", "third", "blocks"),
    # at once; within the first still minute; at its end; behind it; never; and not on one axis
    [
        *((0, True, 15), (5 * PER, True, 19), (14 * PER, True, 28), (16 * PER, True, 29)),
        *((10**9, True, 29), (0, False, 29)),
    ],
)
def test_the_offset_is_told_by_the_first_still_minute_or_as_much_again_where_there_is_doubt(
    tmp_path, known_after, third, blocks
):
    p = powered_on(tmp_path, with_volts(blocks=60))
    told = turn_on(Scripted(known_after, third), p)
    assert told.blocks == blocks
    # what a learning copy asks for, less what a frozen one does; or what the truth asks for
    taught = blocks * PER * np.array([1, 2, -1])
    beside = np.round((p.rate_dps[:15].mean(axis=0) - [1 / 131, 0, 0]) * 131 * 256)
    known = np.array([True, True, third]) & (known_after < 10**9)
    assert told.offset_q8.tolist() == np.where(known, taught, beside).tolist()
    rest_later = replace(p, session=replace(p.session, weight=(np.arange(60) > 4).astype(float)))
    assert turn_on(Scripted(0), rest_later).blocks == 20


# --- the firmware itself ---


def test_a_device_at_rest_knows_its_offset_and_it_is_what_differs_from_the_learned_curve(tmp_path):
    taught = powered_on(tmp_path, with_volts(0, 60), name="a")
    again = powered_on(tmp_path, with_volts(1, 60, (55, -20, -15)), name="b")
    device = Firmware(MPU, None)
    device.power_on()
    for frames in taught.frames():
        device.run(frames)
    told = turn_on(device, again)
    assert told.offset_q8 / 256 == pytest.approx([25, 0, -25], abs=2.5)
    ready = device.copy()
    ready.power_on()
    ready.set_offset(told.offset_q8)
    (frames,) = again.frames()
    frozen = ready.run(frames, learn=False)
    assert frozen[-1] / 256 == pytest.approx([55, -20, -15], abs=2)
    assert ready.offset_is_known.tolist() == [False] * 3
    ready.run(frames)
    assert ready.offset_is_known.tolist() == [True] * 3
    assert ready.target_q8 / 256 == pytest.approx([55, -20, -15], abs=2)


def test_the_compiled_device_and_the_plain_one_learn_the_same_parts(tmp_path):
    (frames,) = powered_on(tmp_path, with_volts(0, 12)).frames()
    given, may = frames.frames.copy(), (np.arange(len(frames)) // 60) % 2 == 0
    compiled, plain = Firmware(MPU, None), Firmware(MPU, None)
    plain._engine = CPythonEngine()
    assert (compiled.run(frames, may) == plain.run(frames, may)).all()
    assert (frames.frames == given).all()


SLOT = Slot(Term("volt", 4000.0, 6000.0, 5000.0), (0.001, 0.0, -0.002), "supply-voltage")


def test_a_model_is_subtracted_by_the_device_that_holds_it_channel_by_channel(tmp_path):
    (frames,) = powered_on(tmp_path, with_volts(0, 12), ("volt",)).frames()
    volts = frames.extra
    both = Frames(frames.t_us, frames.frames, frames.dt_us, np.hstack([0 * volts, volts]))
    model = drafted([SLOT], MPU, tick_s=1.0)
    bias = Firmware(MPU, model, ("other", "volt")).run(both, learn=False)
    expected = (volts[-1, 0] - 5000) * np.array([0.001, 0.0, -0.002]) * 131
    assert bias[-1] / 256 == pytest.approx(expected, abs=0.5)
    with pytest.raises(Refused, match="refuses the model"):
        Firmware(replace(MPU, gyro_lsb_per_dps=65.5), model, ("volt",))
    with pytest.raises(Refused, match="cannot run at these scales"):
        Firmware(replace(MPU, odr_hz=1e9), None)
