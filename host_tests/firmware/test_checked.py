"""What was learned since the chip was last known to be configured right can be taken back."""

from array import array
from pathlib import Path

import numpy as np
import pytest
from zerorate import checked
from zerorate.checked import CheckedCorrector
from zerorate.corrector import Corrector, Sensor
from zerorate_tools.layout import AXIS, SETTINGS, STATE

from .played import LSB, rest


class Feed:
    """A corrector at rest, fed from outside."""

    def __init__(self):
        self.checked = CheckedCorrector(Corrector(Sensor(odr_hz=100.0)))
        self.seed = 3
        self.sample = array("i", [0] * 7)

    def rest(self, count, bias_lsb, status=checked.FRESH):
        self.seed += 1
        frames = rest(count / 100, self.seed, np.full(3, bias_lsb / LSB), temp=-3000)
        for frame in np.rint(frames).astype(int).tolist():
            self.sample[:] = array("i", frame)
            self.checked.update(self.sample, 10000, status)

    def bias_lsb(self):
        return self.checked.corrector.bias_lsb(0)


@pytest.fixture(scope="module")
def rested():
    """A minute of rest, once for all."""
    feed = Feed()
    feed.rest(6000, 100)
    return feed


@pytest.fixture
def feed(rested):
    feed = Feed()
    feed.checked.corrector.state[:] = rested.checked.corrector.state
    feed.sample[:] = rested.sample
    return feed


def test_what_came_after_the_last_read_back_is_forgotten_to_the_last_bit(feed):
    feed.rest(1, 100, checked.VERIFIED)
    feed.checked.keep()
    kept = array("i", feed.checked.corrector.state)
    feed.rest(6000, 900)
    assert feed.checked.corrector.state != kept
    feed.checked.take_back()
    assert feed.checked.corrector.state[STATE.ELAPSED_US :] == kept[STATE.ELAPSED_US :]
    assert feed.checked.taken_back == 1


def test_a_verified_sample_keeps_what_came_before_it_and_not_itself(feed):
    before = array("i", feed.checked.corrector.state)
    feed.rest(1, 100, checked.VERIFIED)
    assert feed.checked.corrector.state != before
    feed.checked.take_back()
    assert feed.checked.corrector.state[STATE.ELAPSED_US :] == before[STATE.ELAPSED_US :]


def test_a_restart_takes_back_and_begins_a_new_power_on(feed):
    feed.checked.keep()
    feed.rest(3000, 900)
    assert not feed.checked.update(feed.sample, 10000, checked.RESTARTED)
    feed.rest(3000, 100)
    assert feed.bias_lsb() == pytest.approx(100, abs=1)


def test_a_restart_brings_back_what_is_known_and_no_other_word(feed, monkeypatch):
    corrector = feed.checked.corrector
    state, settings = corrector.state, corrector.settings
    state[:] = array("i", range(1000, 1000 + len(state)))
    axes, usual = settings[SETTINGS.AXES], settings[SETTINGS.TURN_ON_VARIANCE_Q8]
    first, second, third = (
        axes + axis * settings[SETTINGS.AXIS_WORDS] + AXIS.OFFSET_VARIANCE_Q8 for axis in range(3)
    )
    # an offset is no surer than one of a turn-on
    unsure = {first: usual + 1, second: usual, third: usual}
    feed.checked.keep()
    said = []

    def power_on(same):
        said.append(same)
        state[:] = array("i", [-5] * len(state))
        state[first], state[second] = usual + 1, usual - 1

    monkeypatch.setattr(corrector, "power_on", power_on)
    assert feed.checked.update(feed.sample, 10000, checked.RESTARTED) is False
    known = {*range(STATE.RESTS, STATE.SOURCE + 3), axes - 3, axes - 2, axes - 1}
    for word, value in enumerate(state):
        assert value == unsure.get(word, 1000 + word if word in known else -5), word
    assert (said, feed.checked.taken_back, feed.checked.refused) == ([True], 1, 1)


def test_all_that_is_learned_is_kept_and_taken_back_in_motion_too():
    watched = CheckedCorrector(Corrector(Sensor(odr_hz=100.0), motion=True))
    state, motion = watched.corrector.state, watched.corrector.motion
    for words in (state, motion):
        words[:] = array("i", range(len(words)))
    watched.keep()
    for words in (state, motion):
        words[:] = array("i", [-7] * len(words))
    watched.take_back()
    first = STATE.ELAPSED_US
    assert list(state) == [-7] * first + list(range(first, len(state)))
    assert list(motion) == list(range(len(motion)))
    assert (watched.taken_back, watched._first) == (1, [first, 0])  # never from a word before 0


@pytest.mark.parametrize(
    ("status", "verdict", "reading"),
    [
        (checked.FRESH, 0, True),
        (checked.VERIFIED, 0, True),
        (checked.FRESH, 1, False),
        (checked.VERIFIED, 7, False),
        (checked.SUSPECT, 0, False),
        (checked.RESTARTED, 0, False),
    ],
)
def test_a_reading_is_told_from_what_is_none(feed, monkeypatch, status, verdict, reading):
    monkeypatch.setattr(feed.checked.corrector, "update", lambda sample, dt_us: verdict)
    assert feed.checked.update(feed.sample, 10000, status) is reading
    assert feed.checked.refused == (not reading)
    assert feed.checked.taken_back == (status == checked.RESTARTED)


def test_the_time_of_refused_samples_goes_to_the_next(feed):
    passed_us = []
    feed.checked.corrector.update = lambda sample, dt_us: passed_us.append(dt_us)
    for status in (checked.FRESH, checked.SUSPECT, checked.SUSPECT, checked.FRESH):
        feed.checked.update(feed.sample, 10000, status)
    feed.checked.update(feed.sample, 0x20000000)
    feed.checked.update(feed.sample, 0x20000001)
    assert passed_us == [10000, 30000, 0x20000000, 0x20000000]


def test_checkpoints_take_nothing_from_the_heap(micropython, repository):
    script = Path(__file__).parent / "on_micropython" / "parts_without_heap.py"
    said = micropython.run(script, ["checkpoints"], modules=[repository / "firmware"], check=True)
    assert said.stdout.strip() == "True 1"


def test_an_hour_of_doubt_leaves_its_time_within_31_bits():
    doubting = CheckedCorrector(Corrector())
    for _ in range(3600):
        doubting.update(array("i", [0] * 7), 1000000, checked.SUSPECT)
        assert doubting._passed_us < 1 << 30
