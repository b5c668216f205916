"""A device with hysteresis, closed once for all who look at what came out."""

import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.closing import close, load
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.recordings import Recording

from . import dense
from .power_ons import MPU, recording, written


@pytest.fixture(scope="session")
def logs(tmp_path_factory):
    sessions = simulate(7, [("thermal-hysteresis", 5.0)]).sessions
    return written(tmp_path_factory.mktemp("device"), map(recording, sessions))


@pytest.fixture(scope="session")
def closed(logs, tmp_path_factory):
    folder = tmp_path_factory.mktemp("closed")
    return close(logs, folder, online=True), folder


@pytest.fixture
def closing(tmp_path):
    """closing(columns of each, *scales): the analysis of recordings, of an MPU-6050 by default."""

    def run(every, *scales):
        of = scales or [MPU] * len(every)
        made = [Recording(one, s, f"s{i}") for i, (one, s) in enumerate(zip(every, of))]
        return load(written(tmp_path, made))

    return run


@pytest.fixture
def sessions():
    """Three, of noise alone."""
    return [dense.made(seed, 17 + 3 * seed) for seed in (1, 2, 3)]


@pytest.fixture
def answers(monkeypatch):
    """answers(module, name=value, ...): its functions give these values, whatever is asked."""

    def answer(of, **values):
        for name, value in values.items():
            monkeypatch.setattr(of, name, lambda *asked, value=value: value)

    return answer


@pytest.fixture(scope="module")
def supplied():
    """Four power-ons whose bias follows a supply."""
    made = [dense.made(seed, 24, names=("temp", "vdd_mv", "a")) for seed in (1, 2, 3, 4)]
    for s in made:
        s.sources["vdd_mv"] = 5000 + 10 * s.sources["vdd_mv"]
        s.rate_dps += 0.01 * (s.sources["vdd_mv"] - 5000)[:, None] * [1, 2, 3]
    return made


@pytest.fixture(scope="module")
def with_gap():
    """Two whole ones, and one with a gap too long to be bridged."""
    return [dense.made(1, 18), dense.made(2, 21), dense.made(3, 24, gap=range(5, 17))]


@pytest.fixture
def regression(with_gap):
    """Of these, each axis of each with a noise of its own."""
    made = Regression(with_gap)
    made.scale = dense.SCALE
    return made
