"""Names, numbers and files that are none: one printable line, exit code 2, no traceback."""

import contextlib
import hashlib
import os
import random
import re
import signal
import stat
import subprocess
import sys
import traceback
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from zerorate_tools.cli import main
from zerorate_tools.model import write_model
from zerorate_tools.simulate import simulate_to_files

from ..tools.killed_writers import model
from .many_logs import mutant
from .test_any_bytes import EXAMPLES

_LOG = "t_us,gx,gy,gz\n" + "".join(f"{i * 10000},{i % 7},{i % 5},{i % 3}\n" for i in range(500))
_NOT_UTF8 = os.fsdecode(b"a\xff.csv")
_LOOP = ["import", "loop", "--out", "o.parquet"]


@pytest.fixture
def folder(tmp_path):
    tmp_path = tmp_path / "in"
    tmp_path.mkdir()
    (tmp_path / "loop").symlink_to("loop")
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "link").symlink_to("fifo")
    (tmp_path / "folder").mkdir()
    for name in ("folder/gyro.csv", "piped.json"):
        os.mkfifo(tmp_path / name)
    (tmp_path / "piped.csv").write_text(_LOG)
    (tmp_path / _NOT_UTF8).write_text(_LOG)
    (tmp_path / "run.csv").write_text(_LOG)
    (tmp_path / "log.csv").write_text(_LOG.replace("gx,gy,gz", "gx_dps,gy_dps,gz_dps"))
    (tmp_path / "run.json").write_text('{"sensor":"x","odr_hz":100,"gyro_lsb_per_dps":131.0}')
    (tmp_path / "dev.toml").write_text("[every_session]\nminutes = 0.1\n")
    (tmp_path / "deep.toml").write_text("a=" + "[" * 5000 + "]" * 5000)
    (tmp_path / "deep.yaml").write_text("[" * 5000 + "]" * 5000)
    return tmp_path


def ended(words, folder, most_s=60):
    """(exit code, standard error) of a command in a fork, which alone waits for a pipe for ever."""
    said = folder.with_name("said.txt")
    if (child := os.fork()) == 0:
        code = 99
        try:
            signal.alarm(most_s)
            os.chdir(folder)
            sys.stdout, sys.stderr = open(os.devnull, "w"), open(said, "w", errors="strict")
            code = main(words)
        except SystemExit as end:
            code = end.code
        except BaseException:
            traceback.print_exc()
        finally:
            sys.stderr.flush()
            os._exit(code)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    return code, said.read_text()


def ended_alone(words, folder):
    """The same of a process of its own: workers of a fleet are no children of this one's fork."""
    command = [sys.executable, "-m", "zerorate_tools.cli", *words]
    done = subprocess.run(command, cwd=folder, capture_output=True, timeout=60)
    return done.returncode, done.stderr.decode()


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        (["import", _NOT_UTF8, "--out", "o.parquet"], r"a\udcff.csv: its name is not UTF-8"),
        (["allan", _NOT_UTF8], r"a\udcff.csv: its name is not UTF-8"),
        (["replay", _NOT_UTF8, "--out", "o.parquet"], r"a\udcff.csv: its name is not UTF-8"),
        (["allan", "\x1b[31mx\u202e.csv"], r"\x1b[31mx\u202e.csv: no such file"),
        (_LOOP, "loop: Too many levels of symbolic links"),
        (["import", "fifo", "--out", "o.parquet"], "fifo: neither a file nor a folder"),
        (["simulate", "hysteresis", "--seed", "-1"], "-1 is below 0"),
        (["simulate", "deep.toml", "--out", "s.parquet"], "deep.toml: nested too deeply"),
        (["simulate", "deep.yaml", "--out", "s.parquet"], "deep.yaml: nested too deeply"),
        (["replay", "run.csv", "--out", "o.parquet", "--set", "bins=1e400"], "bins=1e400: not of"),
        (["replay", "run.csv", "--out", "o.parquet", "--model", "/dev/zero"], "zero: is no file"),
        (["replay", "run.csv", "--out", "o.parquet", "--from-state", "fifo"], "fifo: is no file"),
        (["record", "--recover", "."], ".: nothing that `zerorate record` leaves behind"),
        (["import", "loop", "--out", "folder"], "loop: Too many levels of symbolic links"),
        (["state", "show", "run.csv", "--set", "\x1b[31m"], r"\x1b[31m: not of the form"),
        (["import", "folder", "--out", "o.parquet"], "folder: no table with rates in it"),
        (["allan", "piped.csv"], "piped.json: is no file; write there"),
        (["simulate", "fifo", "--out", "s.parquet"], "fifo: is no file"),
        (["state", "show", "/dev/zero"], "zero: is no file"),
        (["flash", "none", "--dry-run", "--main", "/dev/zero"], "zero: is no file"),
        (["flash", "file:///x", "--with", "rest"], "file:///x: is not there"),
        (["watch", "fake:", "--own"], "fake: is an emulated chip without a board; name a board's"),
        (["record", "none", "--out", "o.csv", "--setup", "fifo"], "fifo: is no file"),
        (["record", "fake:", "--out", "o.csv", "--seconds", "nan"], "nan is no finite number"),
        (["record", "fake:", "--out", "o.csv", "--seconds", "0"], "0 is not above 0"),
        (["fleet", "run.csv", "--out", "loop"], "loop/parts: Too many levels of symbolic links"),
        (["run", "none", "--socket", "o.parquet", "--udp", "x"], "--udp x: write ADDRESS:PORT"),
        (["replay", "run.csv", "--out", "o.parquet", "--state", "fifo"], "fifo: cannot be written"),
        (["simulate", "dev.toml", "--out", "o.parquet", "--truth", "fifo"], "fifo: cannot be"),
        (["simulate", "dev.toml", "--out", "o.parquet", "--truth", "link"], "link: cannot be"),
        (["record", "/dev/i2c-77", "--out", "o.csv", "--setup", "\n"], "no such file"),
        (["import", "run.csv", "--out", "o.parquet", "--hz", "inf"], "inf is no finite number"),
        (["import", "log.csv", "--out", "o.parquet", "--hz", "1e-300"], "the time stamp is 1e+306"),
    ],
    ids=str,
)
def test_it_is_one_printable_line_that_says_what_to_do(folder, words, problem):
    code, said = (ended_alone if words[0] == "fleet" else ended)(words, folder)
    assert code == 2 and problem in said and "Traceback" not in said
    assert "\x1b" not in said and "\u202e" not in said
    assert said.startswith("usage") or len(said.splitlines()) == 1
    assert not list(Path(folder).glob("[os].parquet")) and (folder / "fifo").is_fifo()


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
#: A command's words; those in brackets are there sometimes; capitals, what is drawn, with what is
#: sound there if it is not what is sound anywhere.
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


_TURNED = [
    f"turned{n}.{kind}" for n in range(4) for kind in ("csv", "json", "bin", "parquet", "toml")
]
_FILES = ["loop", "fifo", "link", "folder", "piped.csv", "log.csv", "shut", "deep.toml", *_TURNED]
_ODD = dict.fromkeys(("LOG", "MODEL", "STATE", "DEVICE"), [*_FILES, *_ELSEWHERE])
_ODD |= {"OUT": [*_OUTS, *_FILES, *_ELSEWHERE], "NUMBER": _NUMBERS}
_ODD["WORD"] = [*_WORDS, *_NUMBERS, *_FILES]


@st.composite
def commands(draw):
    """The words of a command, up to three of them odd."""
    always, *options = re.split(r" ?\[|\] ?\[?", FORMS[draw(st.sampled_from(sorted(FORMS)))])
    some = [option for option in options if option and not draw(st.integers(0, 4))]
    words = " ".join([always, *some]).split()
    forms = (re.fullmatch(r"(.*?)([A-Z]+)(?::(.*))?", word) for word in words)
    kinds = {at: form.groups() for at, form in enumerate(forms) if form and form[2] in _SOUND}
    wrong = draw(st.sets(st.sampled_from(sorted(kinds)), max_size=3))
    for at, (before, kind, sound) in kinds.items():
        one = draw(st.sampled_from(_ODD[kind] if at in wrong else _SOUND[kind]))
        words[at] = before + (sound if sound and at not in wrong else one)
    return words


@pytest.fixture
def whole(folder):
    """The folder, with sound files of each kind, and such of which some bytes are others."""
    (folder / "shut").mkdir(mode=0o555)
    (folder / "left.partial.csv").write_text(_LOG)
    simulate_to_files({"every_session": {"minutes": 1}}, folder / "run.parquet", seed=1)
    with contextlib.redirect_stdout(None), pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        main(["replay", "run.parquet", "--out", "bias.parquet", "--state", "state.bin"])
        write_model(model(1), ".")
    draw = random.Random(1)
    sound = ("run.csv", "model.json", "model.bin", "run.parquet", "dev.toml")
    for name, odd in zip(sound * 4, _TURNED):
        (folder / odd).write_bytes(mutant((folder / name).read_bytes(), draw))
    return folder


#: A draw for `make fuzz`, always the same among the tests.
SOME = settings(
    max_examples=max(10, EXAMPLES // 3),
    deadline=None,
    derandomize="ZERORATE_FUZZ" not in os.environ,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)


@SOME
@given(words=commands())
def test_any_command_ends_in_words_and_harms_no_file(whole, words):
    copy, endless = whole.with_name("copy"), words[0] in ("run", "record")
    subprocess.run(["rm", "-rf", copy], check=True)
    subprocess.run(["cp", "-a", whole, copy], check=True)
    before = contents(copy)
    if words[0] == "fleet":
        code, said = ended_alone(words, copy)
    else:
        code, said = ended(words, copy, 2 if endless else 60)
    alive = endless and code == -signal.SIGALRM
    after = contents(copy)
    changed = {name for name in before if after.get(name) != before[name]}
    faults = [] if alive else list(ended_badly(code, said))
    faults += left_badly(code, words, changed, after.keys() - before.keys())
    assert faults == []


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
    elif code not in (0, 1, 2):
        yield f"ended with {code}"
    elif code == 2 and not said.startswith("usage") and len(lines) != 1:
        yield f"{len(lines)} lines: {said[:200]}"
    if any(mark in said for mark in ("\x1b", "\u202e")):
        yield "what is not printable reached the terminal"


def left_badly(code, words, changed, new):
    """What is wrong with the files that a command left."""
    keeps = words[0] in ("fleet", "record", "run")  # what they have so far, and what is locked
    if code >= 0 and not keeps and (drafts := [name for name in new if ".partial" in name]):
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
