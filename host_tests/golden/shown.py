"""What is shown beside others: a comparison's page, the demo's chapters and pictures, BROAD's bias.

A figure of matplotlib is taken as it is closed; a MicroPython's script runs in this process.
"""

import io
import os
import re
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, redirect_stdout
from dataclasses import asdict, replace
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Lock
from types import SimpleNamespace
from unittest import mock

import matplotlib.pyplot as plt
import numpy as np
from scipy.io import savemat
from scipy.spatial.transform import Rotation
from zerorate_tools import peers
from zerorate_tools.compare import Won, compare
from zerorate_tools.compare.show import in_motion, write_page
from zerorate_tools.demo import broad, job, picture, story
from zerorate_tools.demo.broad import real
from zerorate_tools.loop.report.report import report
from zerorate_tools.loop.verify.analysis import model_of
from zerorate_tools.model import write_model
from zerorate_tools.recordings import open_recording, read_recording, write_recording

from . import reported

_APART = "<svg.*?</svg>|<style>.*?</style>"
_TWO_POWER_ONS = """
name = "two"
seed = 6
sessions = 2
[sensor]
odr_hz = 10.0
[bias]
b0 = [4.0, -3.0, 1.5]
b2 = [4e-3, -3e-3, 2e-3]
[every_session]
start_degc = 22.0
temperature = [{ to = 32.0, minutes = 1 }]
motion = [{ kind = "rest", s = 14 }, { kind = "hand", s = 5 }]
[[effect]]
kind = "hysteresis"
width_degc = 4.0
dps = [0.06, -0.04, 0.05]
"""


def compared_on_a_page(logs, folder):
    """The pages and words of a comparison, with and without acceleration, and of all that moves."""
    bare = read_recording(logs[0], keep_gaps=True)
    columns = {n: of for n, of in bare.columns.items() if n not in ("ax", "ay", "az")}
    write_recording(replace(bare, columns=columns), folder / "bare.parquet")
    won = [
        None,
        Won((2.1, 1.2), heading=(3.4, 0.5), deployed=True),
        Won((2.1, 2.1)),
        Won(refused="of <two>"),
    ]
    with mock.patch.object(peers, "_ROWS", 700), _closed() as figures:
        every = [compare(logs), compare([folder / "bare.parquet"]), None, None]
        found = {}
        for number, (one, of) in enumerate(zip(every, won)):
            write_page(one, folder / "page.html", of, ["a.csv", "<b>.csv"])
            page = (folder / "page.html").read_text(encoding="utf-8")
            found[f"page {number}"] = re.sub(_APART, "", page, flags=re.DOTALL)
            found[f"words {number}"] = in_motion(of) if of else ""
    ways = [(one, way, other) for one in every[:2] for way, other in pairwise(one.error_dps)]
    verdicts = [[*vars(one.verdict(*of)).values()] for one, *of in ways]
    return {**found, "verdicts": verdicts, **_drawings(figures)}


def demonstrated():
    """The demo on a device of two short power-ons, a real trial, and how each is told."""
    with ExitStack() as stack:
        folder = Path(stack.enter_context(TemporaryDirectory()))
        Path(folder, "two.toml").write_text(_TWO_POWER_ONS, encoding="utf-8")
        stack.enter_context(mock.patch.object(job, "DESCRIPTION", folder / "two.toml"))
        stack.enter_context(mock.patch.object(job, "find", lambda name: InThisProcess()))
        device = job.make_device(folder)
        analysis = reported.analysed(["temperature-polynomial", "thermal-hysteresis"])
        write_model(model_of(analysis, open_recording(device.logs[0]).scales), folder)
        first = job.first_power_on(device)
        before, after = job.back_on_the_chip(device, folder / "model.bin")
        figures = stack.enter_context(_closed())
        stack.enter_context(mock.patch.object(sys, "executable", str(folder / "python")))
        picture.draw_job(first, before, after, folder / "demo.png")
        told = [
            *(story.opening(device, folder), story.chapter_one(first)),
            *(story.chapter_two(device, report(analysis)), story.ending([(folder / "x", "y")])),
            story.chapter_three(before, after, folder / "model.bin"),
            story.chapter_three(after, replace(before, same_state=False), folder / "model.bin"),
            *story.played(replace(first, runtime="wasm", same_state=False)),
            *(*story._found([]), story.compared(SimpleNamespace(headline=lambda: 30 * "a word "))),
        ]
        words = "\n".join(told).replace(str(folder), "FOLDER").splitlines()
        size = (folder / "demo.png").read_bytes()[16:24].hex()
    runs = {f"run {n}": _of_demo(one) for n, one in enumerate((first, before, after))}
    return {"words": words, "png": size, **runs, **_drawings(figures), **_by_optics()}


def _of_demo(one):
    columns = {n: list(getattr(one, n).ravel()) for n in ("bias_dps", "corrected_dps", "truth_dps")}
    return {**columns, "score": asdict(one.score), "same": one.same_state}


class InThisProcess:
    """An interpreter that runs a script here, in a folder of its own; one at a time."""

    name, _one = "cpython", Lock()

    def run(self, script, args, *, files_in, files_out, **how):
        with self._one, TemporaryDirectory() as folder, redirect_stdout(io.StringIO()) as said:
            for name, content in files_in.items():
                data = content if isinstance(content, bytes) else content.read_bytes()
                Path(folder, name).write_bytes(data)
            own = Path.cwd()
            os.chdir(folder)
            try:
                with mock.patch.object(sys, "argv", [script.name, *map(str, args)]):
                    exec(compile(script.read_text(encoding="utf-8"), str(script), "exec"), {})
            finally:
                os.chdir(own)
            files = {name: Path(folder, name).read_bytes() for name in files_out}
        return SimpleNamespace(files=files, stdout=said.getvalue())


def _by_optics():
    """A trial like BROAD's: its bias by the cameras, and what the firmware has of it."""
    with TemporaryDirectory() as folder:
        _write_trial(Path(folder, "trial.mat"))
        [trial] = broad.trials(Path(folder))
    bias, sigma = broad.bias_in_motion(trial)
    steps = []
    shown = real(trial, "native", steps.append)
    shown = replace(shown, said=shown.said.rpartition("\n")[0])  # how the kernels ran
    lines = story.real_trial(shown, "native").splitlines()
    less = {way: of for way, of in shown.whole_mdps.items() if way != "vqf"}
    lines += story.real_trial(replace(shown, whole_mdps=less), "native").splitlines()
    led = {
        str(n): np.nan_to_num(broad._led(trial, n).attitude.ravel()).tolist() for n in (-3, 0, 2)
    }
    columns = {n: [*map(float, of)] for n, of in trial.recording().columns.items()}
    told = {"real": lines, "of trial": columns, "led": led, "truth": _listed(vars(shown.truth))}
    return {"in motion": _listed({"bias": bias, "sigma": sigma}), **told, "steps": steps}


def _write_trial(path, hz=25, fine=5, lead_s=0.168):
    """A hand's turns between two rests, as a gyroscope and late cameras that slip see them."""
    rng, at_s = np.random.default_rng(4), np.arange(100 * hz * fine) / (hz * fine)
    moves = (at_s > 14) & (at_s < 86)
    phase = 2 * np.pi * (np.outer(at_s, [0.31, 0.23, 0.41, 0.9]) + rng.random(4))
    rate = 60 * moves[:, None] * np.sin(phase)[:, :3] * (1 + 0.5 * np.sin(phase)[:, 3:])
    turns = Rotation.from_rotvec(np.radians(rate) / (hz * fine))
    attitudes = [Rotation.identity()]
    for turn in turns:
        attitudes.append(attitudes[-1] * turn)
    ahead = attitudes[round(lead_s * hz * fine) :: fine]  # the device rests at the end
    seen = Rotation.concatenate([*ahead, *attitudes[-1:] * len(at_s)])[: len(at_s) // fine]
    rate = rate.reshape(-1, fine, 3).mean(axis=1)
    down = Rotation.concatenate(attitudes[:-1:fine]).inv().apply([0, 0, 9.81])
    optics = (seen * Rotation.from_rotvec(rng.normal(0, 2e-4, (len(rate), 3)))).as_quat()
    optics[700] = optics[100]
    optics = optics[:, [3, 0, 1, 2]]
    optics[1200:1230] = np.nan
    gyro = rate @ np.array([[1.01, 0.01, 0], [0, 0.99, 0.02], [-0.01, 0, 1.0]])
    gyro += [0.3, -0.2, 0.5] + rng.normal(0, 0.05, rate.shape)
    savemat(path, {
        "sampling_rate": float(hz), "imu_gyr": np.radians(gyro), "opt_quat": optics,
        "imu_acc": down + rng.normal(0, 0.02, rate.shape), "movement": moves[::fine],
    })  # fmt: skip


def _listed(fields):
    return {name: [[v] for v in np.ravel(of).tolist()] for name, of in fields.items()}


@contextmanager
def _closed() -> Iterator[list]:
    """The figures that are closed meanwhile."""
    figures, close = [], plt.close
    with mock.patch.object(plt, "close", figures.append):
        yield figures
    for figure in figures:
        close(figure)


def _drawings(figures):
    """Of each axes of each figure: its words, its limits and its lines."""
    every = [(f"{n} {k}", of) for n, one in enumerate(figures) for k, of in enumerate(one.axes)]
    return {f"drawing {name}": _axes(of) for name, of in every} | {
        f"size {n}": [*one.get_size_inches()] for n, one in enumerate(figures)
    }


def _axes(of):
    legends = [one for one in (of.get_legend(), *of.figure.legends) if one]
    words = [of.get_title("left"), of.get_xlabel(), of.get_ylabel(), of.get_yscale()]
    words += [of.yaxis.label.get_color(), str([one._ncols for one in legends])]
    words += [tick.get_text() for tick in of.get_yticklabels(minor=True)]
    words += [str((line.get_visible(), line.get_alpha())) for line in of.get_xgridlines()[:1]]
    return {"words": words, "limits": [*of.get_xlim(), *of.get_ylim()], "lines": [
        [line.get_label(), line.get_color(), line.get_linestyle(), line.get_marker(),
         line.get_linewidth(), line.get_markersize(), line.get_zorder(),
         *(np.asarray(values, float).tolist() for values in line.get_data())]
        for line in of.lines
    ]}  # fmt: skip
