"""The one entry point, `zerorate`: sub-commands are thin calls of public functions."""

# PYTHON_ARGCOMPLETE_OK
import argparse
import difflib
import io
import os
import re
import signal
import sys
from collections.abc import Sequence
from importlib import import_module
from types import FrameType
from typing import Any, NoReturn, TextIO

from . import __version__
from .commands.options import add_command
from .errors import MissingLibrary, ZerorateError, os_error_in_words, printable

#: Each command, in the order of the help -> the file of commands/ that holds it.
COMMANDS = {
    "demo": "demo", "import": "make", "cut": "make", "record": "chip", "simulate": "make",
    "replay": "learn", "close": "learn", "compare": "learn", "allan": "learn", "model": "use",
    "state": "use", "flash": "use", "fleet": "learn", "run": "chip", "watch": "chip",
    "bench": "demo", "runtimes": "demo", "export": "use",
}  # fmt: skip
_INTERRUPTED = 130
_BROKEN_PIPE = 141


def main(argv: Sequence[str] | None = None) -> int:
    """Run one sub-command and return its exit code.

    0 is well done, 2 bad input (one line on standard error), 130 interrupted.
    """
    given = sys.argv[1:] if argv is None else argv
    if argv is None:  # a program of its own: a half-written file goes before it ends
        for name in {"SIGTERM", "SIGHUP"} & set(dir(signal)):
            number = getattr(signal, name)
            if signal.getsignal(number) != signal.SIG_IGN:  # by nohup
                signal.signal(number, _end)
        if isinstance(sys.stdout, io.TextIOWrapper):  # of Latin-1, which has no bars
            sys.stdout.reconfigure(errors="replace")
        sys.stdout = _Printable(sys.stdout)
    try:
        found = parser()
        if "_ARGCOMPLETE" in os.environ:  # a shell asks what may come next
            import argcomplete

            argcomplete.autocomplete(found)
        arguments = found.parse_args(given or ["--help"])
        return arguments.run(arguments) or 0
    except ZerorateError as error:
        return _complain(str(error), error.exit_code)
    except ModuleNotFoundError as error:
        return _complain(_what_to_install(error), ZerorateError.exit_code)
    except UnicodeEncodeError as error:
        name = error.object[max(0, error.start - 40) : error.end + 40]
        problem = "not UTF-8; rename the file or folder of that name"
        return _complain(f"{' '.join(name.split())}: {problem}", ZerorateError.exit_code)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return _BROKEN_PIPE
    except OSError as error:
        return _complain(os_error_in_words(error), ZerorateError.exit_code)
    except KeyboardInterrupt:
        _drop_drafts()
        return _complain("interrupted; nothing half-written was left", _INTERRUPTED)


class _Printable:
    """A text stream that writes only what a terminal may have."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        return self._stream.write(printable(text))

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


def _end(number: int, frame: FrameType | None) -> None:
    # no exception: one that is raised while a library's C calls back is lost in there
    _drop_drafts()
    signal.signal(number, signal.SIG_DFL)
    os.kill(os.getpid(), number)


def _drop_drafts() -> None:
    # nothing is imported here: where it was not, nothing is half-written
    if drafts := sys.modules.get(f"{__package__}.recordings.drafts"):
        drafts.drop_all()


class _Parser(argparse.ArgumentParser):
    """Says what was probably meant where a word is none of those that there are."""

    #: The parser entered last: that of the command that was typed.
    entered: "argparse.ArgumentParser"

    def __init__(self, *args: Any, **keywords: Any) -> None:
        super().__init__(*args, **keywords)
        self.color = False  # which Python 3.14 has, and _Printable would write as letters

    def parse_known_args(self, *args: Any, **keywords: Any) -> Any:
        """As argparse's, whose top parser reports the words that a command's own left over."""
        _Parser.entered = self
        return super().parse_known_args(*args, **keywords)

    def error(self, message: str) -> NoReturn:
        """Print usage and the message, and exit with 2."""
        wrong = re.search(r"invalid choice: '(.*?)'|unrecognized arguments: (\S+)", message)
        if wrong:
            word = (wrong[1] or wrong[2] or "").partition("=")[0]
            near = difflib.get_close_matches(word, sorted(_words_of(_Parser.entered)), 1)
            if wrong[2] and (others := _commands_with(word, self)):
                near, message = [], f"{message}: it is an option of {', '.join(others)}"
            message += f"; did you mean {near[0]}?" if near else ""
        super().error(printable(message))


def _words_of(parser: argparse.ArgumentParser) -> set[str]:
    """Commands, choices and options of a parser and of those below it."""
    words: set[str] = set()
    for action in parser._actions:
        words.update(action.option_strings, map(str, action.choices or ()))
        if isinstance(action, argparse._SubParsersAction):
            words.update(*(_words_of(below) for below in action.choices.values()))
    return words


def _commands_with(word: str, parser: argparse.ArgumentParser) -> list[str]:
    """The commands of a parser that have an option, or one below them has."""
    subparsers = [a for a in parser._actions if isinstance(a, argparse._SubParsersAction)]
    commands = [named for action in subparsers for named in action.choices.items()]
    return [name for name, below in commands if word in _words_of(below)]


def parser() -> argparse.ArgumentParser:
    top = _Parser(
        prog="zerorate",
        description="Keeps a MEMS gyroscope's zero-rate output at zero.",
        epilog="Begin with `zerorate demo`; `zerorate COMMAND --help` explains each command.",
    )
    top.add_argument("--version", action="version", version=f"zerorate {__version__}")
    subparsers = top.add_subparsers(metavar="COMMAND", required=True)
    for name, file in COMMANDS.items():
        import_module(f"{__package__}.commands.{file}")
        add_command(subparsers, name)
    return top


def _complain(message: str, exit_code: int) -> int:
    print(printable(f"zerorate: {' '.join(message.splitlines())}"), file=sys.stderr)
    return exit_code


def _what_to_install(error: ModuleNotFoundError) -> str:
    """The extra that brings a missing library; a module of this project is a defect. Re-raises."""
    library = (error.name or "").partition(".")[0]
    if not library or library.startswith("zerorate"):
        raise error
    return str(MissingLibrary(library))


if __name__ == "__main__":
    sys.exit(main())
