"""Pieces of one recording judged by the firmware itself, beside devices run one by one."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from zerorate_tools.loop.fit.single import PiecesByLine
from zerorate_tools.loop.search.steps import Step
from zerorate_tools.loop.verify import power_on as module
from zerorate_tools.loop.verify.by_kernels import PiecesByKernels
from zerorate_tools.loop.verify.firmware import Firmware
from zerorate_tools.model.term import Term
from zerorate_tools.replay.samples import frames_in_batches

from .power_ons import MPU, PER, powered_on, with_volts

VOLTS = Term("volt", 4000.0, 6000.0, 5000.0)
LAGGED = replace(VOLTS, lag_mode="lag", lag_s=20.0)
PLAY = replace(VOLTS, memory="play", width=100.0)
BLOCKS = 60


@pytest.fixture(scope="module")
def power_on(tmp_path_factory):
    """A minute of blocks whose bias follows a voltage that switches."""
    columns = with_volts(3, BLOCKS)
    columns["volt"] = np.where(np.arange(BLOCKS * PER) % 400 > 200, 5200, 4900).astype(np.int32)
    columns["gx"] = columns["gx"] + np.rint((columns["volt"] - 5000) * 0.1).astype(np.int32)
    return powered_on(tmp_path_factory.mktemp("one"), columns, ("volt",))


def one_by_one(pieces, models, whole=None):
    """(n, 3) dps left by the device of each turn, which has learned what is not left out in it."""
    p = pieces.power_on
    (frames,) = p.frames()
    blocks = p.blocks(frames)
    out = np.full((len(blocks), 3), np.nan)
    for k, (part, model) in enumerate(zip(pieces.parts, models)):
        device = Firmware(MPU, model, p.channels)
        device.power_on()
        device.run(frames, part.available[blocks])
        device.power_on()
        device.set_offset((0, 0, 0))
        bias = device.run(frames, learn=False) / 256 / 131
        own = pieces.fold[blocks] == k
        out[own] = bias[own]
    means = out.reshape(-1, PER, 3).mean(axis=1)
    return p.rate_dps - means


def test_a_piece_s_error_is_that_of_a_device_that_has_not_learned_it(power_on):
    pieces = PiecesByKernels(power_on, MPU)
    left = pieces.residual([], [])
    assert left == pytest.approx(one_by_one(pieces, [None] * 10), abs=0.1 / 131)
    assert pieces.residual([], []) is left  # not run again
    scored = replace(power_on, scored=np.arange(BLOCKS) % 7 > 0)
    some = PiecesByKernels(scored, MPU).residual([], [])
    assert np.isnan(some[::7]).all() and some[1] == pytest.approx(left[1])


@pytest.mark.parametrize("term", [VOLTS, LAGGED, PLAY])
def test_a_piece_s_model_is_fitted_to_the_others_and_run_by_its_device(power_on, term):
    pieces = PiecesByKernels(power_on, MPU)
    models = pieces.models([], [term])
    for model, part in zip(models, pieces.parts):
        [slot] = model.slots
        kept, told = PiecesByLine(power_on.session).fitted_to(part, [], [term])
        assert slot.coefficient_dps == pytest.approx(told[0], abs=1e-6)
        assert (slot.term.lo, slot.term.hi) == pytest.approx((kept[0].lo, kept[0].hi), abs=1)
    left = pieces.residual([], [term])
    assert left == pytest.approx(one_by_one(pieces, models), abs=0.15 / 131)
    gained = pieces([], [], [term]).sum()
    assert (gained > 5) if term is VOLTS else np.isfinite(gained)
    spared = pieces.residual([], [term], np.array([[0.0, 1.0, 1.0]]))
    assert spared[:, 0] == pytest.approx(pieces.residual([], [])[:, 0], abs=0.15 / 131)
    assert not np.allclose(spared, left)


def test_what_the_firmware_cannot_hold_has_no_error_and_gains_nothing(power_on):
    pieces = PiecesByKernels(power_on, MPU)
    beyond = replace(VOLTS, lag_mode="lag", lag_s=1e9)
    assert np.isnan(pieces.residual([], [beyond])).all()
    assert pieces.residual([], [beyond]).shape == (BLOCKS, 3)


@pytest.mark.parametrize("terms", [[], [VOLTS], [LAGGED]])
def test_a_recording_read_in_parts_gives_what_it_gives_at_once(power_on, monkeypatch, terms):
    whole = PiecesByKernels(power_on, MPU).residual([], terms)
    monkeypatch.setattr(module, "frames_in_batches", partial(frames_in_batches, rows=170))
    parts = PiecesByKernels(power_on, MPU).residual([], terms)
    assert parts == pytest.approx(whole, abs=0.3 / 131)


def test_a_stretch_behind_a_step_is_judged_about_its_own_mean(power_on):
    session = replace(power_on.session, steps=(Step(0, 30, np.full(3, 0.5), 100.0, 0.0),))
    stepped = PiecesByKernels(replace(power_on, session=session), MPU)
    left = stepped.residual([], [])
    plain = PiecesByKernels(power_on, MPU).residual([], [])
    assert left == pytest.approx(stepped.about_stretches(plain), abs=0.1 / 131)
    assert not np.allclose(left, plain)
