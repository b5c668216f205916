"""One interpreter, and what running a script on it gives."""

import os
import shutil
import subprocess
import sys
import tempfile
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from zerorate_tools.errors import ZerorateError


@dataclass(frozen=True)
class Result:
    """What a script left behind: `files` holds those of `files_out` that it wrote."""

    stdout: str
    stderr: str
    returncode: int
    files: dict[str, bytes] = field(default_factory=dict)


@dataclass(frozen=True)
class Job:
    """One run: a scratch folder with the script and its files, and what goes with it."""

    folder: Path
    script: str
    args: tuple[str, ...]
    modules: tuple[Path, ...]
    files_out: tuple[str, ...]
    heap_bytes: int | None
    stdin: bytes


class Runtime(ABC):
    """An interpreter; sub-classes say by which command a job is run on it.

    name: as given to `find`.
    """

    name: str

    @abstractmethod
    def command(self, job: Job) -> list[str]:
        """The command line that runs `job`, to be started in `job.folder`."""

    def environment(self, job: Job) -> dict[str, str] | None:
        """The environment of that command; None is this process's own."""
        return None

    def run(
        self,
        script: Path | str,
        args: Sequence[object] = (),
        *,
        modules: Sequence[Path] = (),
        files_in: Mapping[str, bytes | Path] | None = None,
        files_out: Sequence[str] = (),
        heap: int | None = None,
        stdin: bytes = b"",
        timeout: float | None = None,
        check: bool = False,
    ) -> Result:
        """Run `script` in a scratch folder of its own.

        script: a file, or source text with a line break in it; args: become sys.argv[1:];
        modules: folders put on sys.path; files_in: relative name -> content or file, there before
        the script starts; files_out: relative names read back afterwards; heap: bytes (None is the
        interpreter's own default, 1 MiB on MicroPython; cpython has no limit, and wasm grows
        beyond it by itself); timeout: seconds.

        Raises ZerorateError on a time-out, and with check=True when the script fails.
        """
        with tempfile.TemporaryDirectory(prefix="zerorate-run-") as scratch:
            folder = Path(scratch)
            _stage_files(folder, files_in or {})
            job = Job(
                folder=folder,
                script=_stage_script(folder, script),
                args=tuple(str(a) for a in args),
                modules=tuple(Path(m).absolute() for m in modules),
                files_out=tuple(_inside(name) for name in files_out),
                heap_bytes=heap,
                stdin=stdin,
            )
            result = self._start(job, timeout)
        if check and result.returncode:
            said = (result.stderr or result.stdout).strip().splitlines() or ["no message"]
            how = f"{job.script} failed on {self.name} with exit code {result.returncode}"
            raise ZerorateError(f"{how}: {said[-1]}")
        return result

    def _start(self, job: Job, timeout: float | None) -> Result:
        try:
            done = subprocess.run(
                self.command(job),
                cwd=job.folder,
                env=self.environment(job),
                input=job.stdin,
                capture_output=True,
                timeout=timeout,
            )
        except subprocess.TimeoutExpired as late:
            raise ZerorateError(
                f"{job.script} on {self.name} was stopped after {timeout} s"
            ) from late
        return Result(
            stdout=done.stdout.decode("utf-8", "replace"),
            stderr=done.stderr.decode("utf-8", "replace"),
            returncode=done.returncode,
            files=_read_back(job),
        )


def _inside(name: str) -> str:
    path = PurePosixPath(name)
    if path.is_absolute() or ".." in path.parts:
        raise ValueError(f"{name!r} must be a relative name inside the scratch folder")
    return str(path)


def _stage_script(folder: Path, script: Path | str) -> str:
    if isinstance(script, str) and "\n" in script:
        (folder / "main.py").write_text(script, encoding="utf-8")
        return "main.py"
    source = Path(script)
    shutil.copyfile(source, folder / source.name)
    return source.name


def _stage_files(folder: Path, files_in: Mapping[str, bytes | Path]) -> None:
    for name, content in files_in.items():
        target = folder / _inside(name)
        target.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, Path):
            shutil.copyfile(content, target)
        else:
            target.write_bytes(content)


def _read_back(job: Job) -> dict[str, bytes]:
    written = {name: job.folder / name for name in job.files_out}
    return {name: path.read_bytes() for name, path in written.items() if path.is_file()}


class CPython(Runtime):
    """The Python that runs these tools."""

    name = "cpython"

    def command(self, job: Job) -> list[str]:
        return [sys.executable, "-B", job.script, *job.args]

    def environment(self, job: Job) -> dict[str, str]:
        return {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, job.modules))}


class UnixPort(Runtime):
    """MicroPython's unix port, started by `launcher` (a loader, an emulator, or nothing)."""

    def __init__(self, name: str, executable: Path, launcher: tuple[str, ...] = ()) -> None:
        self.name = name
        self.executable = executable
        self.launcher = launcher

    def command(self, job: Job) -> list[str]:
        heap = [] if job.heap_bytes is None else ["-X", f"heapsize={job.heap_bytes}"]
        return [*self.launcher, str(self.executable), *heap, job.script, *job.args]

    def environment(self, job: Job) -> dict[str, str]:
        return {**os.environ, "MICROPYPATH": ":".join([".frozen", *map(str, job.modules)])}


def cache_folder() -> Path:
    """The folder of everything fetched: $ZERORATE_CACHE, else zerorate in the XDG cache."""
    own = os.environ.get("ZERORATE_CACHE")
    if own:
        return Path(own).expanduser().absolute()
    xdg = os.environ.get("XDG_CACHE_HOME")
    return (Path(xdg) if xdg else Path.home() / ".cache") / "zerorate"


def runtime_folder(name: str) -> Path:
    """The folder of one fetched interpreter or tool, whether it is there or not."""
    return cache_folder() / "runtimes" / name


def fill(folder: Path, build: Callable[[Path], None]) -> Path:
    """Build `folder` beside its place and rename it there; one that is there is left alone."""
    if folder.is_dir():
        return folder
    folder.parent.mkdir(parents=True, exist_ok=True)
    # realpath-free and beside the target: a rename must not cross file systems.
    draft = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    try:
        build(draft)
        draft.chmod(0o755)
        _move_into_place(draft, folder)
    finally:
        shutil.rmtree(draft, ignore_errors=True)
    return folder


def _move_into_place(draft: Path, folder: Path) -> None:
    try:
        draft.rename(folder)
    except OSError:
        if not folder.is_dir():  # else another process was quicker: its copy is as good
            raise
