"""A chip of one's own as a table: a BMI270, simulated at rest and corrected by the firmware."""

from zerorate import Corrector, Sensor
from zerorate_tools import Scales, replay_recording, simulate_sessions

BMI270 = {  # of its data sheet, at +-250 dps and +-2 g
    "odr_hz": 100.0,
    "gyro_lsb_per_dps": 131.072,
    "accel_lsb_per_g": 16384.0,
    "temp_lsb_per_degc": 512.0,
    "temp_offset_degc": 23.0,
}
corrector = Corrector(Sensor(**BMI270))  # on a board, and on Linux
scales = Scales("BMI270", **BMI270)  # of a recording; beside a CSV, as JSON
description = {  # of a simulated device; as a file, it is what `zerorate simulate` takes
    "sensor": {"name": "BMI270", **BMI270, "gyro_noise_dps_rt_hz": 0.007},
    "bias": {"b0": [0.5, -0.3, 0.1]},
    "session": [{"minutes": 1}],
}
recording, truth = next(simulate_sessions(description))
assert recording.scales.to_json() == scales.to_json()
lsb = replay_recording(recording).to_frame().filter(like="bias_").iloc[-1]
print("bias, dps:", (lsb / scales.gyro_lsb_per_dps).round(3).tolist())
