"""`zerorate bench faults`: every fault is detected and none is learned from; no load is wrong."""

import pytest
from zerorate_bench import faults
from zerorate_bench.bus_faults import FAULTS, run_fault
from zerorate_bench.faults import StoreUnderFaults


@pytest.mark.parametrize("name", sorted(FAULTS))
def test_a_fault_is_detected_every_time_and_never_learned_from(name):
    row = run_fault(name)
    assert row["detected"] == row["injected"] > 0
    assert row["learned_from"] == 0


@pytest.mark.parametrize("name", ["frozen-data", "brown-out-awake", "chip-swapped"])
def test_the_faults_that_look_like_data_do_hand_out_false_samples(name):
    assert run_fault(name)["false_samples"] > 0


def test_a_corrector_that_takes_nothing_back_would_learn_from_them(monkeypatch):
    monkeypatch.setattr("zerorate_bench.bus_faults.Watch.take_back", lambda self: None)
    assert run_fault("brown-out-awake")["learned_from"] > 0


def test_no_cut_and_no_turned_bit_loads_anything_wrong():
    store = StoreUnderFaults(words=20)
    for round_ in range(3):
        store.cut_every_byte(round_)
    store.flip_every_bit()
    assert store.counts["cuts"] == 3 * store.counts["bytes"]
    assert store.counts["flips"] == 2 * 8 * store.counts["bytes"]
    assert store.counts["wrong_loads"] == store.counts["exceptions"] == 0


def test_a_store_without_a_checksum_would_be_found_out(monkeypatch):
    monkeypatch.setattr("zerorate.storage.store.Store._is_whole", lambda *arguments: True)
    store = StoreUnderFaults(words=20)
    store.cut_every_byte(0)
    store.flip_every_bit()
    assert store.counts["wrong_loads"] > 0


def test_one_miss_fails_the_verdict():
    row = {"injected": 2, "detected": 2, "learned_from": 0, "false_samples": 0}
    store = {"bytes": 5, "cuts": 5, "flips": 5, "wrong_loads": 0, "exceptions": 0}
    assert faults.passed({"faults": {"nack": row}, "store": store})
    assert not faults.passed({"faults": {"nack": {**row, "detected": 1}}, "store": store})
    assert not faults.passed({"faults": {"nack": {**row, "learned_from": 1}}, "store": store})
    assert not faults.passed({"faults": {"nack": row}, "store": {**store, "wrong_loads": 1}})
