"""Every log of the corpus, imported in this process as a user does who knows nothing of it."""

import re
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest import mock

import numpy as np
from zerorate_bench.foreign_logs import CORPUS, World
from zerorate_tools.errors import ZerorateError
from zerorate_tools.importers import read_foreign
from zerorate_tools.importers.logs import apart

from host_tests.hostile.many_logs import in_this_process

_TOLD = re.compile(r"--[a-z-]+(?: [^\s,;()]+)?|-?\d+\.?\d*")
_SCALES = ("odr_hz", "gyro_lsb_per_dps", "accel_lsb_per_g", "temp_lsb_per_degc", "temp_offset_degc")


def told(said):
    """Figures, and what a user is told to type: the words about them are free."""
    return _TOLD.findall(re.sub(r"/\S+", "", said))


def _figures(recording, report):
    """[samples, scales and each column's mean and root mean square], and what is said of them."""
    columns = [np.asarray(of, float) for of in recording.columns.values()]
    sizes = [size for of in columns for size in (of.mean(), np.sqrt((of**2).mean()))]
    scales = [getattr(recording.scales, name) or 0.0 for name in _SCALES]
    numbers = [float(f"{v:.6g}") for v in (len(recording), *scales, *sizes)]
    return numbers, told(" ".join(report.lines()))


def _imported(log, folder):
    path = log.write(folder, World(1000))
    try:
        return _figures(*read_foreign(path))
    except ZerorateError as error:
        return [], told(str(error))


def imported(module):
    """{log: [numbers], log and told: [what is said]} of the logs that a module writes."""
    found = {}
    here = mock.patch.object(apart, "table_apart", in_this_process)
    with here, mock.patch("resource.setrlimit"):  # no limit of a child's for this process
        for log in CORPUS:
            if log.write.__module__.endswith(f".{module}"):
                with TemporaryDirectory() as folder:
                    found[log.what], told = _imported(log, Path(folder))
                found[f"{log.what}: told"] = [" ".join(told)]
    return found


MODULES = sorted({log.write.__module__.rpartition(".")[2] for log in CORPUS})
LOGS_OF_OTHERS = {f"imported {module}": partial(imported, module) for module in MODULES}
