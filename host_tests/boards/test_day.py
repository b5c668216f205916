"""The documented program goes on through resets and a sensor pulled out (`make day`: all day)."""

from .day import Day, passed


def test_rates_are_corrected_again_within_three_seconds_of_each_reset_and_unplugging():
    found = Day(hours=0.04, resets=3, unplugs=3, odr_hz=50, seed=1).run()
    assert found["resets"] == found["unplugs"] == 3
    assert found["lines"] > 60
    assert passed(found), found
