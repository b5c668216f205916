"""CI runs what the README tells a person to run, with every interpreter and a browser required."""

import subprocess
import sys

from zerorate_tools.runtimes import NAMES


def test_ci_runs_the_readmes_test_command_with_every_interpreter_and_a_browser(repository):
    script = (repository / ".ci" / "run").read_text(encoding="utf-8")
    assert script.rstrip().endswith("exec make test")
    assert f"ZERORATE_REQUIRE={','.join(NAMES)},chromium\n" in script
    assert "`make test`" in (repository / "README.md").read_text(encoding="utf-8")


def test_the_spelling_of_what_the_demo_and_close_write_is_nobodys_business(tmp_path, repository):
    for folder in ("zerorate-demo", "closed"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "report.html").write_text("yrabil"[::-1])
    settings = ["--toml", str(repository / "pyproject.toml")]
    words = [sys.executable, "-m", "codespell_lib", *settings, str(tmp_path)]
    checked = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path)
    assert (checked.returncode, checked.stdout) == (0, "")


def test_ci_is_executable(repository):
    assert (repository / ".ci" / "run").stat().st_mode & 0o111
