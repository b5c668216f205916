"""Commands with odd files, names and numbers:

    python -m host_tests.hostile.odd_commands [COMMAND...] [--times N] [--seed N]

Each has up to three odd words, and runs in a fork, in a folder of its own, which may be full, or
may not be written. A fault is a traceback, a signal, more than a line of complaint, 20 s of
processor, three minutes, a file that is another afterwards without being named, a draft that is
left, a failure that changed something, and an exit code of 0 without what was to be written.
"""

import argparse
import ctypes
import hashlib
import os
import random
import re
import resource
import signal
import stat
import subprocess
import sys
import tempfile
import traceback
from collections import Counter
from pathlib import Path

from zerorate_tools import cli
from zerorate_tools.replay.engines import compiled

from .odd_files import DRAWN, drawn, make

TIMES = 3000
_MOST_S, _SERVES_S = 20, 2
_HANGS_S = 180  # by the clock: a cluster of `fleet` begins slowly beside other work
_ENDLESS, _ALIVE = ("run", "record"), "alive"
_CAPABILITIES = 0x20080522  # the version of the call that gives them up
_SOUND = {
    "LOG": ("run.csv", "run.parquet"),
    "OUT": ("o.parquet",),
    "MODEL": ("model.bin", "model.json"),
    "STATE": ("state.bin",),
    "NUMBER": ("2",),
    "WORD": ("show",),
    "DEVICE": ("dev.toml",),
}
_NUMBERS = (
    *("0", "-1", "-0.0", "1e400", "nan", "inf", "-inf", "1e-320", "1e308", "1e18", "1e-9", "", "x"),
    *("1_000", "\u0663", "0x10", "1/0", "1/15", "0/1", " 1", "1e", "--", "\x1b[31m", "9" * 5000),
    *(str(2**31), str(2**63), str(-(2**63)), str(10**30), "65536", "100000000", "0.5", "3"),
)
_WORDS = ("a=b", "=", "gx=", "gx=gx", "bins=8", "\n", "\udcff", "x" * 300, "é", "*", "[", "(")
_WORDS += ("gx=-gy", "gx=--gy", "gx=gx:", "gx=:lsb", "gx=gx:rad/s", "gx=temp:x1e400", "vdd=gx:xnan")
_WORDS += ("t_us=gx", "t_us=t_us:us+gx:ns", "t_us=none", "gz=none", "ax=gx:g", "qw=gx", "a=gx:x0")
_ELSEWHERE = (
    *("/dev/null", "/dev/zero", "/dev/full", "/dev/stdin", "/proc/self/mem", "/proc/self/fd"),
    *("", ".", "..", "-", "~", "run.csv/x", "nowhere", "x" * 300 + ".csv", "d/" * 2500 + "x.csv"),
    *("C:\\x.csv", "file:///x.csv", "s3://x/y.parquet", "http://localhost:1/x.csv", "\udcff"),
)
_OUTS = (
    *("o", "o.csv", "o.csv.gz", "o.txt", ".parquet", "o.parquet/", "nowhere/o.parquet", "o/o/o"),
    *("shut/o.parquet", "n" * 247 + ".parquet", "a\nb.parquet", "\x1b[31m.parquet"),
)
# a command's words; those in brackets are there sometimes; capitals, what is drawn, with what is
# sound there if it is not what is sound anywhere
FORMS = {
    "import": "import --out OUT LOG [--hz NUMBER:50] [--map WORD:temp=none] [--sensor WORD] [LOG] "
    "[--gyro-lsb-per-dps NUMBER] [--temp-offset-degc NUMBER] [--instance NUMBER:0] [--json]",
    "cut": "cut LOG --at-row NUMBER:9 --out OUT:parts [--at-row NUMBER]",
    "simulate": "simulate DEVICE --out OUT [--truth OUT:t.parquet] [--session NUMBER:1] "
    "[--seed NUMBER]",
    "replay": "replay LOG --out OUT [--state OUT:s.bin] [--from-state STATE] [--resume] [--json] "
    "[--set WORD:short=30] [--set bins=NUMBER:8] [--set step_degc=NUMBER] [--document] [--every] "
    "[--model MODEL] [--no-motion] [--no-gravity] [--runtime WORD:native]",
    "close": "close --out OUT:c LOG [LOG] [--holdout LOG] [--online] [--json]",
    "compare": "compare LOG [LOG] [--out OUT:c.html] [--json]",
    "allan": "allan LOG",
    "model": "model WORD MODEL [MODEL] [--log LOG] [--chip-id NUMBER:0x68] [--filter NUMBER:3]",
    "state": "state show STATE [--set WORD:short=30] [--set bins=NUMBER:8] [--find WORD]",
    "flash": "flash LOG:nowhere --dry-run [--with WORD:rest] [--main LOG:run.csv] [--only] "
    "[--model MODEL]",
    "record": "record fake: --seconds NUMBER --out OUT [--hz NUMBER:50] [--dps NUMBER:500] "
    "[--part WORD:MPU-6050]",
    "recover": "record --recover LOG:left.partial.csv [--out OUT]",
    "run": "run LOG:fake: [--state STATE:learned.bin] [--socket OUT:s] [--hz NUMBER:50] "
    "[--udp WORD:127.0.0.1:9] [--model MODEL]",
    "watch": "watch LOG:run.csv --once [--model MODEL] [--every NUMBER] [--for NUMBER]",
    "fleet": "fleet --out OUT:f LOG [--device-from WORD:(.*)] [--model MODEL] [--minutes NUMBER] "
    "[--workers NUMBER] [--keep] [--json]",
    "export": "export c OUT:ex [--model MODEL] [--odr-hz NUMBER] [--gyro-lsb-per-dps NUMBER]",
}


def line(name, odd, draw):
    """The words of a command; odd: what is drawn of in the place of what is sound."""
    always, *options = re.split(r" ?\[|\] ?\[?", FORMS[name])
    some = [option for option in options if option and draw.random() < 0.2]
    words = " ".join([always, *some]).split()
    forms = (re.fullmatch(r"(.*?)([A-Z]+)(?::(.*))?", word) for word in words)
    kinds = {at: form.groups() for at, form in enumerate(forms) if form and form[2] in _SOUND}
    wrong = draw.sample([*kinds], min(len(kinds), draw.choice((0, 1, 1, 1, 1, 2, 3))))
    for at, (before, kind, sound) in kinds.items():
        one = draw.choice(odd[kind] if at in wrong else _SOUND[kind])
        words[at] = before + (sound if sound and at not in wrong else one)
    return words


class Trial:
    """Commands by number, each in a copy of the folder."""

    def __init__(self, seed, folder):
        self.seed, self.whole, self.copy = seed, folder / "whole", folder / "copy"
        self.whole.mkdir()
        make(self.whole, random.Random(seed))
        files = sorted(path.name for path in self.whole.iterdir())
        some = ("LOG", "MODEL", "STATE", "DEVICE")
        self.odd = {kind: (*files, *_ELSEWHERE, *DRAWN.get(kind, ()) * 100) for kind in some}
        self.odd["OUT"] = (*_OUTS, *files, *_ELSEWHERE)
        self.odd |= {"NUMBER": _NUMBERS, "WORD": (*_WORDS, *_NUMBERS, *files)}
        self.ends = Counter()

    def faults(self, name, number):
        """(words of a command, how long its files may be, what was wrong with how it ended)."""
        draw = random.Random(f"{self.seed} {name} {number}")
        words, most = (
            line(name, self.odd, draw),
            draw.choice((None, None, None, None, 0, 1000, 20_000)),
        )
        subprocess.run(["rm", "-rf", self.copy], check=True)
        subprocess.run(["cp", "-a", self.whole, self.copy], check=True)
        drawn(self.copy, draw)
        before = contents(self.copy)
        self.copy.chmod(0o555 if draw.random() < 0.05 else 0o755)
        code, said = self._run(words, most)
        self.copy.chmod(0o755)
        after = contents(self.copy)
        self.ends[code] += 1
        changed = {name for name in before if after.get(name) != before[name]}
        new = set(after) - set(before)
        return words, most, [*ended_badly(code, said), *left_badly(code, words, changed, new)]

    def _run(self, words, most):
        ours, theirs = os.pipe()
        if (child := os.fork()) == 0:
            code = 99
            try:
                self._begin(most, theirs)
                signal.alarm(_SERVES_S if words[0] in _ENDLESS else _HANGS_S)
                try:
                    code = cli.main(words)
                except SystemExit as end:
                    code = end.code or 0
                except BaseException:
                    traceback.print_exc()
                sys.stderr.flush()
            finally:
                os._exit(code)
        os.close(theirs)
        with os.fdopen(ours, errors="surrogateescape") as pipe:
            said = pipe.read()
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        return (_ALIVE if words[0] in _ENDLESS and code == -signal.SIGALRM else code), said

    def _begin(self, most, said):
        os.setsid()
        os.chdir(self.copy)
        for descriptor, to in ((0, os.open(os.devnull, 0)), (1, os.open(os.devnull, 1)), (2, said)):
            os.dup2(to, descriptor)
        if os.getuid() == 0:  # whom no mode stops, where it may do all
            nothing = ctypes.create_string_buffer(24)
            ctypes.CDLL(None).capset(ctypes.byref(ctypes.c_uint64(_CAPABILITIES)), nothing)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_CPU, (_MOST_S, _MOST_S))
        if most is not None:  # as where a disk is full; Python keeps what it compiled, cut short
            sys.dont_write_bytecode, os.environ["PYTHONDONTWRITEBYTECODE"] = True, "1"
            resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))


def contents(folder):
    """Kind and content of all that is in a folder."""
    found = {}
    for path in folder.rglob("*"):
        mode = path.lstat().st_mode
        whole = hashlib.sha1(path.read_bytes()).hexdigest() if stat.S_ISREG(mode) else ""
        found[str(path.relative_to(folder))] = (stat.S_IFMT(mode), whole)
    return found


def ended_badly(code, said):
    """What is wrong with how a command ended."""
    lines = said.strip().splitlines()
    if "Traceback" in said:
        yield lines[-1]
    elif code not in (0, 1, 2, _ALIVE):
        yield f"ended with {code}"
    elif code == 2 and not said.startswith("usage") and len(lines) != 1:
        yield f"{len(lines)} lines: {said[:200]}"
    if any(mark in said for mark in ("\x1b", "\u202e")):
        yield "what is not printable reached the terminal"


def left_badly(code, words, changed, new):
    """What is wrong with the files that a command left."""
    keeps = words[0] in ("fleet", "record")  # what they have so far
    if code != _ALIVE and not keeps and (drafts := [name for name in new if ".partial" in name]):
        yield f"left {drafts[0]}"
    named = {os.path.normpath(word) for word in words}
    named |= {name.removesuffix(".gz").removesuffix(".csv") + ".json" for name in named}
    strange = [name for name in changed if not named & {name, *map(str, Path(name).parents)}]
    if strange and "." not in named:
        yield f"changed {strange}"
    if code == 2 and not keeps and (changed or new):
        yield f"failed, and changed {sorted(changed)[:3]}, made {sorted(new)[:3]}"
    if code == 0 and "--out" in words and ".." not in words and not changed and not new:
        yield "wrote nothing"


def main():
    """Print what fell, and a line of how many did; 1 if any."""
    parser = argparse.ArgumentParser(description=__doc__.partition(":")[0])
    parser.add_argument("commands", nargs="*", choices=[*FORMS, []], help="default: all")
    parser.add_argument("--times", type=int, default=TIMES)
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(1 << 31))
    chosen = parser.parse_args()
    names, fallen = chosen.commands or [*FORMS], 0
    compiled()
    with tempfile.TemporaryDirectory() as folder:
        trial = Trial(chosen.seed, Path(folder))
        for number in range(chosen.times):
            words, most, faults = trial.faults(names[number % len(names)], number)
            if faults:
                fallen += 1
                print(number, words, f"most {most}", *faults, sep="\n  ", flush=True)
    ends = ", ".join(f"{n} with {code}" for code, n in trial.ends.most_common())
    print(f"{fallen} failed of {chosen.times} commands ({ends}), seed {chosen.seed}")
    return 1 if fallen else 0


if __name__ == "__main__":
    sys.exit(main())
