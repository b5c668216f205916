"""One trial of the public BROAD data set, fetched once.

D. Laidig, M. Caruso, A. Cereatti, T. Seel: BROAD, a benchmark for robust inertial orientation
estimation, Data 6(7):72, 2021; github.com/dlaidig/broad, CC BY 4.0.
"""

import time
from pathlib import Path

from ..errors import CannotFetch
from ..runtimes.cache import cache_folder
from .broad import Trial, trials

CREDIT = "BROAD, D. Laidig et al., Data 6(7):72, 2021, CC BY 4.0, github.com/dlaidig/broad"
NAME = "02_undisturbed_slow_rotation_B"
COMMIT = "7e2f8189bb4a3ac91eae32c69b6bc87f08a6e2ad"
FOLDER_URL = f"https://raw.githubusercontent.com/dlaidig/broad/{COMMIT}/data_mat/"
SHA256 = "2ab69f86aab5fcc018399068baaabc725bb4b53862aefbef70eaf0256da1930a"
#: Without a byte, and for all of it.
_SILENT_S, _LIMIT_S = 15, 120


def broad_trial(folder_url: str | None = None) -> Trial:
    """The trial, fetched into the cache where it is not there yet (3.6 MB). Raises CannotFetch.

    folder_url: a mirror's folder instead of FOLDER_URL.
    """
    path = _fetched(folder_url or FOLDER_URL)
    return next(trial for trial in trials(path.parent) if trial.name == NAME)


def kept_in() -> Path:
    """The folder of the cache that holds the trial."""
    return cache_folder() / "broad"


def _fetched(folder_url: str) -> Path:
    import pooch

    pooch.get_logger().setLevel("WARNING")
    file = f"{NAME}.mat"
    try:
        path = pooch.retrieve(
            folder_url + file,
            known_hash=f"sha256:{SHA256}",
            fname=file,
            path=kept_in(),
            downloader=_downloaded,
        )
    except OSError as error:  # of requests, too: its errors are OSErrors
        do = f"try again with a network, or put that file into {kept_in()}"
        raise CannotFetch(
            f"{folder_url}{file} cannot be fetched, is there a network? {do}"
        ) from error
    except ValueError as error:
        raise CannotFetch(f"{folder_url}{file} is not the file with SHA-256 {SHA256}") from error
    return Path(path)


def _downloaded(url: str, output_file: str, pooch: object) -> None:
    """A downloader of pooch that gives up on a network that brings next to nothing."""
    import requests

    until = time.monotonic() + _LIMIT_S
    answer = requests.get(url, timeout=_SILENT_S, stream=True)  # type: ignore[no-untyped-call]
    with answer, open(output_file, "wb") as out:
        answer.raise_for_status()
        for chunk in answer.iter_content(1 << 16):
            out.write(chunk)
            if time.monotonic() > until:
                raise TimeoutError
