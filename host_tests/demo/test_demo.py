"""The whole job: chip, bus, driver and firmware inside MicroPython."""

from zerorate_tools.demo import demo
from zerorate_tools.recordings import write_recording
from zerorate_tools.simulate import simulate

DESCRIPTION = {
    "name": "on the table",
    "seed": 8,
    "sensor": {"odr_hz": 50.0, "gyro_noise_dps": 0.05},
    "bias": {"b0": [5.0, -2.0, 0.5], "b1": [0.05, -0.03, 0.02]},
    "session": [{"start_degc": 22.0, "temperature": [{"to": 24.0, "minutes": 1}]}],
}


def test_the_bias_is_gone_at_the_end_of_the_chain(micropython, tmp_path):
    recording, truth = simulate(DESCRIPTION)
    write_recording(recording, tmp_path / "table.parquet")
    truth_dps = truth.bias_lsb / recording.scales.gyro_lsb_per_dps
    shown = demo(tmp_path / "table.parquet", micropython.name, truth_dps)
    assert shown.same_state
    assert "MPU-6050 at 0x68" in shown.said
    assert shown.score.firmware_mdps < shown.score.first_ten_s_mdps / 5
    assert shown.score.first_ten_s_mdps < shown.score.uncorrected_mdps
    last = shown.corrected_dps[-500:]
    # 0.05 dps of noise over 500 samples leaves 2 mdps
    assert abs(last.mean(axis=0)).max() < 0.010
