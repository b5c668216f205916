"""How a segment moves the offset of an axis, and what it teaches of this part, beside floats."""

import math

import pytest
from zerorate import Corrector
from zerorate.rest import recent
from zerorate_tools.layout import AXIS, ESTIMATOR, SETTINGS, STATE, axis_at

SEGMENT = 8 * 32  # readings of a whole segment
NO_VALUE = -0x3FFFFFFF


class Axis:
    """One axis of a new corrector; its words by name, in floats where they are set."""

    def __init__(self, axis=1):
        corrector = Corrector(motion=False, gravity=False)
        self.s, self.c, self.axis = corrector.state, corrector.settings, axis
        self.a = axis_at(self.c, axis)

    def put(self, **words):
        for name, value in words.items():
            at = getattr(STATE, name, None) if name in OF_ALL else self.a + getattr(AXIS, name)
            self.s[at] = round(value)
        return self

    def __getattr__(self, name):
        if name in OF_ALL:
            return self.s[getattr(STATE, name)]
        return self.s[self.a + getattr(AXIS, name)]


OF_ALL = {"TEMP", "NOISE_Q8", "GROWN_Q8", "MEAN_NOISE_Q8", "LEARN_TEMP", "RESTS", "REST", "TIP_Q8"}


@pytest.fixture
def axis():
    return Axis()


@pytest.mark.parametrize("age_s", [0, 1, 60, 1000, 2043, 2044, 2045, 60000])
def test_an_offset_grows_less_sure_by_its_walk_for_half_an_hour(axis, draw, age_s):
    variance, walk = draw.uniform(0, 1e5), draw.uniform(100, 1e5)
    axis.put(OFFSET_VARIANCE_Q8=variance, WALK_Q16=walk, OFFSET_AGE_MS=1024 * age_s)
    expected = variance + walk / 256 * min(age_s + 3, 2047)
    assert recent.grown_q8(axis.s, axis.a) == pytest.approx(expected, rel=0.01, abs=2100)
    steps = [axis.put(WALK_Q16=w) and recent.grown_q8(axis.s, axis.a) for w in (0, 1 << 12)]
    assert steps[1] - steps[0] == 16 * min(age_s + 3, 2047)


@pytest.mark.parametrize("n", [8, 32, 64, 127, 128, 129, 255, 256])
def test_a_short_rest_hides_a_turn_beside_its_noise(axis, draw, n):
    noise, floor = draw.uniform(1e3, 1e5), draw.uniform(1e3, 1e6)
    axis.put(NOISE_Q8=noise, FLOOR_Q16=floor)
    shorter = SEGMENT // n
    hidden = shorter * (axis.c[SETTINGS.PROVISIONAL_Q8] // 16) // 10 if shorter > 1 else 0
    expected = noise / 3 / n + floor / 256 + hidden**2
    assert recent.mean_noise_q8(axis.s, axis.c, axis.a, n) == pytest.approx(expected, abs=2.5)


@pytest.mark.parametrize(
    ("temp", "beyond"), [(900, 100), (1000, 0), (1500, 0), (2000, 0), (2010, 10), (5000, 3000)]
)
def test_a_temperature_outside_the_fitted_range_adds_its_distance(axis, temp, beyond):
    axis.put(TEMP=temp, LINE_LOW_Q4=16000, LINE_HIGH_Q4=32000, LINE_POINTS=2, LEAVES_Q16=800)
    sigma = 16 * beyond * 800 // 65536
    assert recent.beyond_q8(axis.s, axis.c, axis.a) == sigma**2
    axis.put(LINE_POINTS=0)
    assert recent.beyond_q8(axis.s, axis.c, axis.a) == 0


def test_the_error_of_a_segment_is_its_mean_less_curve_and_offset(axis, draw):
    offset, total, n = (int(draw.integers(*r)) for r in ((-9999, 9999), (-40000, 40000), (8, 256)))
    axis.put(OFFSET_Q8=offset, WAITING_SUM=total, WAITING_N=n, LEARN_TEMP=1000)
    found = recent.error_q4(axis.s, axis.c, axis.a)
    assert axis.CURVE_BEFORE_Q8 == 0, "nothing is learned yet"
    assert found == pytest.approx((total / n - offset / 256) * 16, abs=1.1)


@pytest.mark.parametrize("by", [5, -5, 1 << 25, -(1 << 25)])
def test_an_offset_stays_within_24_bits(axis, by):
    recent.move_offset(axis.put(OFFSET_Q8=100).s, axis.a, by)
    assert axis.OFFSET_Q8 == max(-0xFFFFFF, min(100 + by, 0xFFFFFF))


# What may be a turn, and what is held back


def suspected(axis, error_lsb, up=(0, 0, 16384), known=True):
    """Whether segments that lie off by these errors may be of a turn, by each axis."""
    for i in range(3):
        a = axis_at(axis.c, i)
        axis.s[a + AXIS.WAITING_N], axis.s[a + AXIS.WAITING_SUM] = 100, round(100 * error_lsb[i])
        axis.s[a + AXIS.LEFT_Q4] = 0
        n = axis.c[SETTINGS.INSIST] * 8 * 32
        axis.s[a + AXIS.ESTIMATORS + ESTIMATOR.EST_READINGS] = n if known else n - 32
        axis.s[STATE.ANCHOR_Q4 + i] = 16 * up[i]
    axis.put(REST=40)
    recent.suspect_turn(axis.s, axis.c)
    offers = [axis.s[axis_at(axis.c, i) + AXIS.OFFER] for i in range(3)]
    hidden = [recent.hidden_q4(axis.s, axis.c, i) for i in range(3)]
    assert [-offer >> 2 for offer in offers] == hidden
    return [offer & 1 for offer in offers]


@pytest.mark.parametrize(
    ("error_lsb", "up", "known", "is_turn"),
    [
        ((0, 0, 200), (0, 0, 16384), True, 1),
        ((0, 0, -200), (0, 0, 16384), True, 1),
        ((0, 0, 200), (0, 0, 16384), False, 0),
        ((0, 200, 0), (0, 0, 16384), True, 0),
        ((200, 0, 0), (-16384, 0, 0), True, 1),
        ((70, 0, 200), (0, 0, 16384), True, 1),  # 19 degrees off gravity
        ((0, 95, 200), (0, 0, 16384), True, 0),  # 25 degrees
        ((140, 0, 140), (11585, 0, 11585), True, 1),
        ((140, 0, -140), (11585, 0, 11585), True, 0),
        ((0, 95, 200), (0, 0, 20000), True, 1),  # more than 1 g banks
        ((0, 0, 200), (0, 0, 0), True, 0),
    ],
)
def test_a_change_along_gravity_of_a_well_known_bias_may_be_a_turn(
    axis, error_lsb, up, known, is_turn
):
    assert suspected(axis, error_lsb, up, known) == [is_turn] * 3


@pytest.mark.parametrize(
    ("turn_lsb", "lean", "learned"),
    [(800, 0.02, 0), (800, -0.02, 0), (0, 0.02, 1), (30, 0.02, 1), (-800, 0.0, 0)],
)
def test_an_axis_learns_no_share_of_a_turn_that_is_seen_along_gravity(turn_lsb, lean, learned):
    axis = Axis(0)
    share_lsb = lean * turn_lsb
    for i in range(3):
        at = axis_at(axis.c, i)
        axis.s[at + AXIS.OFFSET_VARIANCE_Q8] = 256 * 16
        axis.s[at + AXIS.KIND] = 1
    suspected(axis, (share_lsb, 0, turn_lsb), (round(16384 * lean), 0, 16384))
    assert recent.update_offset(axis.s, axis.c, axis.a, round(16 * share_lsb)) == learned
    assert bool(axis.OFFSET_Q8) == bool(learned and share_lsb)


def test_another_source_moves_a_well_known_bias_by_more_than_three_sigma_once_it_has_lasted(axis):
    n = axis.c[SETTINGS.INSIST] * SEGMENT
    axis.s[axis.a + AXIS.ESTIMATORS + ESTIMATOR.EST_READINGS] = n
    axis.put(KIND=1, OFFER=8 * 16 + 4, OFFSET_VARIANCE_Q8=256, DOUBT_Q4=16, LEFT_Q4=0, FLOOR_Q16=0)
    offers = 10 * axis.c[SETTINGS.TURN_HALVES] // 4
    taken = [recent.take_over(axis.s, axis.c, axis.a, 2000) for _ in range(offers)]
    assert taken == [0] * (offers - 1) + [1] and axis.OFFSET_Q8 == 16 * 2000
    axis.put(OFFSET_VARIANCE_Q8=256 * 256, OFFSET_FROM=0)
    assert recent.take_over(axis.s, axis.c, axis.a, 200) == 1, "within three sigma"


def test_after_a_power_off_no_change_is_taken_for_a_turn(axis):
    suspected(axis, (0, 0, 200))
    for i in range(3):
        axis.s[axis_at(axis.c, i) + AXIS.LEFT_Q4] = NO_VALUE
    recent.note(axis.s, axis.c, 1, 1)
    assert not axis.OFFER & 1


@pytest.mark.parametrize(
    ("held", "error", "suspect", "agrees"),
    [
        *((800, error, 5, True) for error in (800, -800, 890, 720)),
        *((800, error, 5, False) for error in (930, 700, 0)),
    ],
)
def test_held_back_errors_agree_within_an_eighth(axis, held, error, suspect, agrees):
    axis.put(HELD_Q4=held, SUSPECT=suspect)
    assert recent.hold(axis.s, axis.a, error) == (suspect if agrees else 0)
    assert abs(error) == axis.HELD_Q4


@pytest.mark.parametrize(
    ("offer", "suspect", "rest", "after"),
    [(0, 0, 0, 1), (1, 0, 0, 0), (1, 3, 0, 4), (1, 0, 391, 1), (1, 0, 390, 0), (2, 7, 0, 8)],
)
def test_what_may_be_a_turn_does_not_begin_to_count_before_ten_halvings(
    axis, offer, suspect, rest, after
):
    axis.put(HELD_Q4=800, SUSPECT=suspect, OFFER=-offer, REST=rest)
    assert axis.c[SETTINGS.TURN_HALVES] == 39
    assert recent.insists(axis.s, axis.c, axis.a, 800) == 0
    assert after == axis.SUSPECT
    axis.put(SUSPECT=axis.c[SETTINGS.INSIST] - 2)
    assert recent.insists(axis.s, axis.c, axis.a, 800) == 0
    assert recent.insists(axis.s, axis.c, axis.a, 800) == 1


@pytest.mark.parametrize(
    ("readings", "offer", "sigmas"), [(SEGMENT, 0, 6), (SEGMENT, -1, 3), (SEGMENT - 1, 0, 2)]
)
@pytest.mark.parametrize("way", [1, -1])
def test_a_segment_is_plausible_within_so_many_sigma(axis, readings, offer, sigmas, way):
    sigma_q4 = 300
    axis.put(WAITING_N=readings, OFFER=offer, SUSPECT=4)
    axis.put(GROWN_Q8=sigma_q4**2 - 4000, MEAN_NOISE_Q8=4000)
    assert recent.plausible(axis.s, axis.c, axis.a, way * (sigmas * sigma_q4 + 1)) == 0
    axis.put(SUSPECT=4)
    assert recent.plausible(axis.s, axis.c, axis.a, way * sigmas * sigma_q4) == 1
    assert axis.SUSPECT == 0


@pytest.mark.parametrize("way", [1, -1])
def test_within_the_gate_a_whole_segment_is_plausible_however_sure_it_is(axis, way):
    gate = axis.c[SETTINGS.GATE_Q4]
    axis.put(WAITING_N=SEGMENT, GROWN_Q8=1, MEAN_NOISE_Q8=1)
    assert recent.plausible(axis.s, axis.c, axis.a, way * gate) == 1
    assert recent.plausible(axis.s, axis.c, axis.a, way * (gate + 1)) == 0


def test_what_has_insisted_moves_the_offset_and_the_turn_on_offset_with_it(axis):
    error = 5000
    axis.put(WAITING_N=SEGMENT, HELD_Q4=error, OFFSET_Q8=64)
    axis.put(SUSPECT=axis.c[SETTINGS.INSIST] - 1)
    before = list(axis.s)
    assert recent.plausible(axis.s, axis.c, axis.a, error) == 2
    assert axis.OFFSET_Q8 == 64 + 16 * error and axis.SUSPECT == 0
    moved = [n for n in range(len(before)) if axis.s[n] - before[n] == 16 * error]
    assert len(moved) == 2


# What a segment teaches of this part


def test_the_gain_is_the_share_of_the_offsets_variance(draw):
    for variance, noise in 10 ** draw.uniform(0, 8, (50, 2)):
        expected = variance / (variance + noise)
        assert recent.gain_q14(int(variance), int(noise)) / (1 << 14) == pytest.approx(
            expected, abs=0.002 if variance + noise > 2000 else 0.5
        )


def test_what_a_segment_leaves_is_its_noise_times_the_gain(axis, draw):
    noise, gain = int(draw.integers(0, 1 << 24)), int(draw.integers(0, 1 << 14))
    axis.put(MEAN_NOISE_Q8=noise)
    assert recent.left_q8(axis.s, gain) == pytest.approx(noise * gain / (1 << 14), abs=0.6)


@pytest.mark.parametrize("periods", [2, 63, 938, 1021, 1022, 1023, 1024, 9000])
def test_the_walk_follows_errors_that_noise_does_not_explain(axis, draw, periods):
    least, most = (axis.c[at] for at in (SETTINGS.WALK_LEAST_Q16, SETTINGS.WALK_MOST_Q16))
    for excess in (-50000, 0, 3000, int(draw.integers(0, 1 << 21)), 1 << 28):
        walk = int(draw.integers(least, most))
        axis.put(WALK_Q16=walk, OFFSET_AGE_MS=64 * periods - draw.integers(1, 64))
        recent.rewalk(axis.s, axis.c, axis.a, excess)
        speed = max(-0x1FFFFF, min(excess, 0x1FFFFF)) * 256 / periods
        speed = min(max(-0x17FFFFF, min(speed, 0x17FFFFF)) * 16, most)
        age = min(periods, 1023)
        share = max(age**2 // ((age**2 + 0x100000) // 1024), 24) / 4096
        expected = max(walk + (speed - walk) * share, least)
        assert expected - 24 < axis.WALK_Q16 < expected + 1


@pytest.mark.parametrize(
    ("beyond", "square", "slope"),
    [(900, 1 << 28, 800 + 51), (900, 0, 800 - 25), (0, 1 << 28, 800), (0, 0, 800)],
)
def test_a_slope_beyond_the_range_rises_by_twice_what_it_falls(axis, beyond, square, slope):
    axis.put(TEMP=2000 + beyond, LINE_LOW_Q4=16000, LINE_HIGH_Q4=32000, LINE_POINTS=2)
    axis.put(LEAVES_Q16=800, GROWN_Q8=100, MEAN_NOISE_Q8=100)
    recent.relearn_slope(axis.s, axis.c, axis.a, square)
    assert slope == axis.LEAVES_Q16
    axis.put(LEAVES_Q16=4090)
    recent.relearn_slope(axis.s, axis.c, axis.a, square)
    assert axis.LEAVES_Q16 <= 4095


@pytest.mark.parametrize("age_ms", [1000, 4000, 4001, 60000])
def test_the_floor_is_what_rests_differ_by_beyond_noise_and_walk(axis, draw, age_ms):
    floor, walk, noise, left, error = draw.uniform(
        [500, 256, 1e3, -200, -200], [9e4, 6e4, 1e5, 200, 200]
    ).astype(int)
    readings = int(draw.integers(0, 200)) * SEGMENT
    axis.put(FLOOR_Q16=floor, WALK_Q16=walk, NOISE_Q8=noise, LEFT_Q4=left, WAITING_N=SEGMENT)
    axis.put(OFFSET_AGE_MS=age_ms, GROWN_Q8=9000, MEAN_NOISE_Q8=5000)
    axis.s[axis.a + AXIS.ESTIMATORS + ESTIMATOR.EST_READINGS] = readings
    recent.relearn_floor(axis.s, axis.c, axis.a, int(error))
    least, weight = axis.c[SETTINGS.FLOOR_Q8], 1.0
    found = (error - left) ** 2 / 2 - walk / 256
    if age_ms > 4000:
        found = error**2 - 9000
        weight = (floor / 256 + least) / (floor / 256 + least + 14000)
    found = min(max(found - noise / (3 * SEGMENT), -64 * least), 64 * least)
    step = (found * 256 - floor) / min(readings / SEGMENT + 8, 128) * weight
    assert max(floor + step, 0x100) == pytest.approx(axis.FLOOR_Q16, abs=max(150, abs(step) * 0.02))


@pytest.mark.parametrize("error", [0, 100, 1000])
def test_the_spread_of_power_ons_moves_by_a_quarter(axis, error):
    at = axis.a + AXIS.ESTIMATORS + ESTIMATOR.EST_SPREAD_Q8
    axis.put(MEAN_NOISE_Q8=5000, LEARN_TEMP=1000)
    before = axis.s[at] = 40000
    recent.relearn_spread(axis.s, axis.c, axis.a, error**2)
    expected = before + (max(error**2 - 5000, 0) - before) / 4
    assert axis.s[at] == pytest.approx(expected, abs=1)


@pytest.mark.parametrize(
    ("error", "left", "before", "after"),
    [
        (10, 0, 900, 500),  # it agrees: no more than this rest hides
        (10, 0, 300, 300),
        (10, NO_VALUE, 900, 0),  # it agrees after a power-off
        (400, 0, 300, 400),  # it moves the bias, by no more than its error
        (-400, 0, 300, 400),
        (4000, 0, 300, 500),
        (4000, 0, 900, 900),
    ],
)
def test_a_doubt_is_what_a_rest_may_hide(axis, error, left, before, after):
    axis.put(OFFER=-2001, LEFT_Q4=left, DOUBT_Q4=before, GROWN_Q8=2000, MEAN_NOISE_Q8=2000)
    hidden = -axis.OFFER >> 2
    recent.doubt(axis.s, axis.a, error)
    assert hidden == 500 and after == axis.DOUBT_Q4


@pytest.mark.parametrize(
    ("points", "sigmas_beyond", "walks"),
    [(2, 0, True), (1, 4.1, True), (1, 3.0, False), (1, 0, True)],
)
def test_of_one_temperature_a_jump_to_another_is_no_walk(axis, points, sigmas_beyond, walks):
    axis.put(TEMP=5000, LINE_LOW_Q4=16000, LINE_HIGH_Q4=32000, LINE_POINTS=points)
    axis.put(LEAVES_Q16=2000, OFFSET_VARIANCE_Q8=1000, MEAN_NOISE_Q8=1000, WALK_Q16=100)
    axis.put(GROWN_Q8=3000, OFFSET_Q8=0)
    sigma = math.sqrt(recent.beyond_q8(axis.s, axis.c, axis.a))
    usual = axis.c[SETTINGS.TURN_ON_VARIANCE_Q8]
    assert (3 * sigma) ** 2 > 4 * usual
    error = round(sigmas_beyond * sigma) + 50
    recent.follow(axis.s, axis.c, axis.a, error)
    assert (axis.WALK_Q16 != 100) == walks
    assert axis.OFFSET_Q8 == pytest.approx(0.75 * 16 * error, rel=0.01)
    assert axis.LEFT_Q4 == pytest.approx(0.25 * error, rel=0.02, abs=1)
    assert axis.OFFSET_VARIANCE_Q8 == pytest.approx(750, rel=0.01)


# What the curve is taught of it


@pytest.mark.parametrize(
    ("noise", "source", "kind", "taken"),
    [
        *((4000, 3, 0, True), (250, 4, 1, True), (4000, 4, 1, False), (4000, 3, 1, True)),
        *((751, 4, 1, True), (752, 4, 1, False)),  # a quarter of the level's variance
    ],
)
def test_what_another_source_found_is_the_level_if_it_is_known_twice_as_well(
    axis, noise, source, kind, taken
):
    axis.put(KIND=kind, OFFER=8 * noise + source, FLOOR_Q16=0, OFFSET_FROM=3, OFFSET_Q8=640)
    axis.put(OFFSET_VARIANCE_Q8=3008, WALK_Q16=0, LEFT_Q4=9, OFFSET_AGE_MS=8, SUSPECT=0, RESTS=1)
    before = list(axis.s)
    assert bool(recent.take_over(axis.s, axis.c, axis.a, 50)) is taken
    if not taken:
        assert before == list(axis.s)
        return
    assert axis.OFFSET_Q8 == (640 + 16 * 50 if kind else 640)
    assert (axis.SUSPECT, axis.RESTS) == ((0, 1) if kind else (-1, axis.c[SETTINGS.INSIST]))
    assert (axis.OFFSET_FROM, axis.LEFT_Q4, axis.OFFSET_AGE_MS) == (source, 0, 0)
    assert axis.OFFSET_VARIANCE_Q8 == noise
    axis.put(KIND=0, OFFER=8 * noise + source, FLOOR_Q16=0x1280)
    recent.take_over(axis.s, axis.c, axis.a, 50)
    assert axis.OFFSET_VARIANCE_Q8 == noise + 0x1280 // 128


@pytest.mark.parametrize("rests", [0, 5])
@pytest.mark.parametrize("beyond", [0, 300])
def test_a_turn_on_offset_is_of_the_first_rests_less_the_curves_own_share(
    axis, draw, rests, beyond
):
    insist, usual = axis.c[SETTINGS.INSIST], axis.c[SETTINGS.TURN_ON_VARIANCE_Q8]
    kept = axis.c[SETTINGS.AXES] - 3 + axis.axis
    axis.put(TEMP=2000 + beyond, LINE_LOW_Q4=16000, LINE_HIGH_Q4=32000, LINE_POINTS=2)
    offset = int(draw.integers(-60000, 60000))
    axis.put(LEAVES_Q16=4000, OFFSET_Q8=offset, RESTS=rests)
    variance = recent.beyond_q8(axis.s, axis.c, axis.a)
    own = variance / (variance + max((offset / 16) ** 2, usual))
    assert recent.level_q8(axis.s, axis.c, axis.a) == pytest.approx(
        offset * (1 - own), abs=20 + abs(offset) * 0.001
    )
    axis.put(RESTS=insist)
    axis.s[kept] = 777
    assert recent.level_q8(axis.s, axis.c, axis.a) == 777 == axis.s[kept]
    axis.put(RESTS=insist - 1)
    assert recent.level_q8(axis.s, axis.c, axis.a) != 777 != axis.s[kept]


@pytest.mark.parametrize("which", [0, 1])
def test_a_turn_on_offset_leaves_what_the_estimators_learn(which, draw):
    axis = Axis(which)
    insist, n = axis.c[SETTINGS.INSIST], int(draw.integers(8, 257))
    for rests in (0, insist - 1, insist):
        offset, total = int(draw.integers(-99999, 99999)), int(draw.integers(-99999, 99999))
        axis.put(RESTS=rests, OFFSET_Q8=offset, WAITING_SUM=total, WAITING_N=n)
        axis.s[axis.c[SETTINGS.AXES] - 3 + which] = offset
        recent.remove_turn_on(axis.s, axis.c, axis.a)
        assert axis.WAITING_SUM == pytest.approx(total - offset / 256 * n, abs=0.51)
        assert axis.RESTS == min(rests + (which == 0), insist)


def segment(axis, mean_lsb, readings=SEGMENT, **words):
    """1 if the estimators may learn the segment; what is left of it waits for them."""
    axis.put(LEARN_TEMP=1000, WAITING_N=readings, WAITING_SUM=readings * mean_lsb, **words)
    return recent.absorb(axis.s, axis.c, axis.a)


def test_the_very_first_segment_is_all_curve_and_no_offset(axis):
    assert segment(axis, 200, 8, KIND=0) == 0 and segment(axis, 200, 9, KIND=0) == 1
    axis.put(OFFSET_Q8=99, RESTS=0, LEFT_Q4=5, OFFSET_FROM=3, OFFSET_AGE_MS=7, HELD_Q4=400)
    assert segment(axis, 200, OFFER=-4001, DOUBT_Q4=0) == 1
    assert (axis.OFFSET_Q8, axis.SUSPECT, axis.LEFT_Q4, axis.OFFSET_FROM) == (0, -1, 0, 0)
    assert axis.OFFSET_VARIANCE_Q8 == axis.MEAN_NOISE_Q8 and axis.OFFSET_AGE_MS == 0
    assert axis.RESTS == axis.c[SETTINGS.INSIST] and axis.WAITING_SUM == 200 * SEGMENT
    assert (axis.DOUBT_Q4, axis.HELD_Q4) == (1000, 0)  # by what the rest may hide
    segment(axis, 200, OFFER=-401, HELD_Q4=400)
    assert axis.DOUBT_Q4 == 300  # by three quarters of what was held back


def test_the_document_and_all_readings_leave_the_offset_alone():
    for mode in ({"document": True}, {"every": True}):
        axis = Axis()
        made = Corrector(motion=False, gravity=False, **mode)
        axis.s, axis.c, axis.a = made.state, made.settings, axis_at(made.settings, 1)
        before = list(axis.s)
        axis.put(WAITING_N=SEGMENT, WAITING_SUM=9000, OFFER=9)
        assert recent.update_offset(axis.s, axis.c, axis.a, 500) == 1
        changed = [n for n, was in enumerate(before) if axis.s[n] != was]
        assert changed == [axis.a + at for at in (AXIS.WAITING_SUM, AXIS.WAITING_N, AXIS.OFFER)]


def test_what_the_curve_has_just_learned_leaves_the_offset(axis):
    curve = axis.a + AXIS.ESTIMATORS
    axis.s[curve + ESTIMATOR.EST_READINGS], axis.s[curve + ESTIMATOR.EST_BIAS_Q8] = SEGMENT, 900
    axis.put(SUSPECT=0, OFFSET_Q8=500, CURVE_BEFORE_Q8=700, LEARN_TEMP=1000)
    recent.keep_level(axis.s, axis.c, axis.a)
    assert axis.OFFSET_Q8 == 300
    recent.keep_level(axis.put(SUSPECT=-1).s, axis.c, axis.a)
    assert (axis.OFFSET_Q8, axis.SUSPECT) == (300, 0)
