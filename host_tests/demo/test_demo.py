"""The whole job: chip, bus, driver and firmware inside MicroPython."""

import pytest
from zerorate_tools.cli import main
from zerorate_tools.demo import demo
from zerorate_tools.importers import import_recording
from zerorate_tools.recordings import read_recording, write_recording
from zerorate_tools.simulate import simulate

DESCRIPTION = {
    "name": "on the table",
    "seed": 8,
    "sensor": {"odr_hz": 50.0, "gyro_noise_dps": 0.05},
    "bias": {"b0": [5.0, -2.0, 0.5], "b1": [0.05, -0.03, 0.02]},
    "session": [{"start_degc": 22.0, "temperature": [{"to": 24.0, "minutes": 1}]}],
}


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    path = tmp_path_factory.mktemp("demo") / "table.parquet"
    write_recording(simulate(DESCRIPTION)[0], path)
    return path


def test_the_bias_is_gone_at_the_end_of_the_chain(micropython, log):
    shown = demo(log, micropython.name)
    assert shown.same_state
    assert "MPU-6050 at 0x68" in shown.said
    assert shown.score.firmware_mdps < shown.score.first_ten_s_mdps / 5
    assert shown.score.first_ten_s_mdps < shown.score.uncorrected_mdps
    last = shown.corrected_dps[-500:]
    # 0.05 dps of noise over 500 samples leaves 2 mdps
    assert abs(last.mean(axis=0)).max() < 0.010


def test_a_real_recording_goes_the_same_way(find_runtime, real_data, tmp_path):
    find_runtime("wasm")
    source = real_data / "mpu6050-unmoved" / "set-1_unmoved-x-pointing-up.csv.gz"
    log = tmp_path / "up.parquet"
    import_recording(source, log)
    shown = demo(log)
    assert shown.same_state
    assert shown.truth_dps is None
    assert len(shown.bias_dps) == len(read_recording(log).columns["t_us"])
    assert shown.score.uncorrected_mdps > 2000
    assert shown.score.firmware_mdps < 10


def test_the_command_prints_the_error_before_and_after_and_draws(
    find_runtime, log, tmp_path, capsys
):
    find_runtime("wasm")
    assert main(["demo", str(log), "--out", str(tmp_path / "out")]) == 0
    said = capsys.readouterr().out
    assert "uncorrected" in said and "equal to the last bit" in said
    assert f"{tmp_path / 'out' / 'demo.png'}" in said
    assert (tmp_path / "out" / "demo.png").read_bytes().startswith(b"\x89PNG")


def test_a_scale_that_no_chip_has_is_refused_in_one_line(find_runtime, log, tmp_path, capsys):
    find_runtime("wasm")
    recording = read_recording(log)
    other = {**recording.scales.to_json(), "gyro_lsb_per_dps": 1000.0}
    scales = type(recording.scales)(**other)
    odd = tmp_path / "odd.parquet"
    write_recording(type(recording)(recording.columns, scales, "odd"), odd)
    assert main(["demo", str(odd), "--out", str(tmp_path / "out")]) == 2
    assert "zerorate replay" in capsys.readouterr().err


def test_a_recording_shorter_than_its_score_is_refused_in_one_line(micropython, tmp_path, capsys):
    short = simulate(
        {
            "name": "short",
            "session": [{"start_degc": 25, "temperature": [{"to": 25.0, "minutes": 0.1}]}],
        }
    )[0]
    write_recording(short, tmp_path / "short.parquet")
    words = ["demo", str(tmp_path / "short.parquet"), "--out", str(tmp_path / "shown")]
    assert main([*words, "--runtime", micropython.name]) == 2
    said = capsys.readouterr().err
    assert "6.0 s are too short" in said and said.count("\n") == 1
    assert not (tmp_path / "shown").exists()
