"""CI runs what the README tells a person to run, with every interpreter and a browser required."""

from zerorate_tools.runtimes import NAMES


def test_ci_runs_the_readmes_test_command_with_every_interpreter_and_a_browser(repository):
    script = (repository / ".ci" / "run").read_text(encoding="utf-8")
    assert script.rstrip().endswith("exec make test")
    assert f"ZERORATE_REQUIRE={','.join(NAMES)},chromium\n" in script
    assert "`make test`" in (repository / "README.md").read_text(encoding="utf-8")


def test_ci_is_executable(repository):
    assert (repository / ".ci" / "run").stat().st_mode & 0o111
