"""The kinds of outcome that a page must tell, from closed loops, and a browser to look with."""

import json
from dataclasses import replace
from functools import cache, partial

import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.closing import load
from zerorate_tools.loop.report.report import as_json, report
from zerorate_tools.loop.verify.analysis import model_of
from zerorate_tools.loop.verify.run_kernels import run_kernels
from zerorate_tools.model import write_model
from zerorate_tools.recordings import Scales, open_recording
from zerorate_tools.report import write_report
from zerorate_tools.simulate import load_description, simulate_to_files

from host_tests.loop.power_ons import recording, written

SCALES = Scales("MPU-6050", 1.0, 5000.0, 16384.0, 340.0, 36.53)
WITHOUT_TEMP = Scales("MPU-6050", 1.0, 5000.0, 16384.0)
HOSTILE = "<script>"
HOSTILE_FILE = '<img src=x onerror=alert(1)> & "quo\'te" \u202eltr $x$ {{7*7}}'


def device(folder, seed, effects=(), names=None, channel="load", temp=True):
    """Recordings of a device: their paths, one a name."""
    scales = SCALES if temp else WITHOUT_TEMP
    made = zip(names or ("a", "b", "c", "d"), simulate(seed, list(effects)).sessions)
    return written(folder, [replace(recording(s, scales, channel), name=n) for n, s in made])


def bundled(folder, scenario):
    """Recordings of one of the bundled scenarios: their paths."""
    return simulate_to_files(load_description(scenario), folder / "warm.parquet")


class Closed:
    """A closed loop: its recordings, what was found, and the folder with its model."""

    def __init__(self, folder, logs):
        self.folder, self.logs = folder, logs
        found, self.scales = load(logs), open_recording(logs[0]).scales
        model = model_of(found, self.scales)
        self.analysis = run_kernels(found, logs, model, folder / "corrected.parquet", False)
        write_model(model, folder)
        self.result = json.loads(json.dumps(report(self.analysis), default=as_json))


HYSTERESIS = [("thermal-hysteresis", 5.0)]
LOAD = [("load-squared-delayed", 5.0)]
HOSTILE_FILES = [f"{HOSTILE_FILE} {i}" for i in range(4)]
#: A step in a recording whose name has no place to break at.
LONG_STEP = {
    "kind": "step",
    "t_us": 38_000_000,
    "recording": "21_undisturbed_fast_combined_" * 2,
    "size_mdps": [-33.26, 196.33, 2078.44],
    "p_value": 1e-9,
}
#: Outcome -> what makes recordings with it in a folder.
OUTCOMES = {
    "an effect": partial(device, seed=7, effects=HYSTERESIS),
    "nothing": partial(device, seed=3),
    "unexplained": partial(bundled, scenario="unrecorded"),
    "one recording": partial(device, seed=7, effects=HYSTERESIS, names=["alone"]),
    "no temperature": partial(device, seed=7, temp=False),
    "hostile names": partial(device, seed=7, effects=LOAD, channel=HOSTILE, names=HOSTILE_FILES),
}


@pytest.fixture(scope="session")
def outcome(tmp_path_factory):
    """outcome(name) -> a Closed, its report written, made once."""

    @cache
    def make(name):
        folder = tmp_path_factory.mktemp("closed")
        closed = Closed(folder, OUTCOMES[name](folder))
        if name == "hostile names":
            closed.result["events"].append(LONG_STEP)
        closed.page = write_report(closed.analysis, closed.result, closed.logs, closed.folder)
        return closed

    return make


@pytest.fixture(scope="session", params=OUTCOMES)
def closed(request, outcome):
    """Each kind of outcome."""
    return outcome(request.param)


# Ends a hang; a busy machine may take its time.
_PATIENCE_MS = 600_000


class Shown:
    """A page that is open and drawn: `tab`, and what went wrong on the way there."""

    def __init__(self, context, path):
        self.address = path.as_uri()
        self.complaints, self.requests = [], []
        self.tab = context.new_page()
        self.tab.set_default_timeout(_PATIENCE_MS)
        self.tab.on("console", lambda message: self.complaints.append(message.text))
        self.tab.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.tab.on("dialog", lambda dialog: self.complaints.append(dialog.message))
        self.tab.on("request", lambda request: self.requests.append(request.url))
        self.tab.add_init_script(SHIFTS)
        self.tab.goto(self.address)
        self.tab.wait_for_selector("html[data-drawn=all]", state="attached")


SHIFTS = """
window.shifted = 0;
new PerformanceObserver((list) => {
  for (const entry of list.getEntries()) if (!entry.hadRecentInput) window.shifted += entry.value;
}).observe({ type: "layout-shift", buffered: true });
"""
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}
DESK = {"viewport": {"width": 1440, "height": 900}}


@pytest.fixture(scope="session")
def show(browser):
    """show(closed, phone, theme) -> its page as Shown, in a window of its own."""

    def show(closed, phone=False, theme="light"):
        context = browser.new_context(**(PHONE if phone else DESK), color_scheme=theme)
        return Shown(context, closed.page)

    return show


#: What a wide window and dark colours change does not depend on the outcome: one is enough.
SHOWN = [*((name, "phone") for name in OUTCOMES), ("hostile names", "desk")]


@pytest.fixture(scope="session", params=SHOWN, ids=" on a ".join)
def shown(request, outcome, show):
    """Each outcome's page on a phone, and one on a desk in the dark, only to be looked at."""
    name, device = request.param
    phone = device == "phone"
    page = show(outcome(name), phone=phone, theme="light" if phone else "dark")
    yield page
    page.tab.context.close()


@pytest.fixture(scope="session")
def tab(outcome, show):
    """The page of a device with an effect: whoever uses a plot leaves it so that others can."""
    page = show(outcome("an effect"))
    yield page.tab
    page.tab.context.close()
