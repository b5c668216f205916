"""The documented program goes on through resets and a sensor pulled out (`make day`: all day)."""

from zerorate_i2c.mpu6050 import MPU6050

from .day import Day, passed


def seven_minutes():
    """What came of a reset or an unplugging every quarter of a minute, while the bias drifts."""
    return Day(hours=0.12, resets=14, unplugs=14, odr_hz=10, seed=1, drift_dps_per_h=2.0).run()


def test_rates_are_corrected_again_within_three_seconds_of_each_reset_and_unplugging():
    found = seven_minutes()
    assert found["resets"] == found["unplugs"] == 14
    assert found["lines"] > 400
    assert passed(found), found


def test_the_judge_notices_a_driver_that_never_looks_whether_the_chip_was_reset(monkeypatch):
    monkeypatch.setattr(MPU6050, "doubt", lambda self, frozen: None)
    monkeypatch.setattr(MPU6050, "check", lambda self: True)
    assert not passed(seven_minutes())
