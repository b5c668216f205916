"""Writes what `mip` installs from: a package.json a folder for the rest path, PART.json for more.

python -m zerorate_bench.native.manifests, in a checkout; a test fails while one is stale.
"""

import json
import sys
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from zerorate_tools import __version__
from zerorate_tools.boards.parts import PACKAGES, PARTS, REST, part_files

FOLDERS = dict(zip(PACKAGES, ("firmware", "drivers"), strict=True))


def manifests() -> Iterator[tuple[PurePosixPath, str]]:
    """(path below a checkout, text) of every file that mip installs from."""
    rest = part_files([REST])
    for part in PARTS:
        files = rest if part == REST else part_files([REST, part])
        for package, folder in FOLDERS.items():
            names = [str(name) for name in files if name.parts[0] == package]
            if part != REST:
                names = [name for name in names if PurePosixPath(name) not in rest]
            if names:
                name = "package.json" if part == REST else f"{part}.json"
                yield PurePosixPath(folder, name), _text(names)


def _text(names: list[str]) -> str:
    """Each file from beside it to the same path in lib."""
    lines = ",\n".join("    " + json.dumps([name, name]) for name in names)
    return f'{{\n  "version": "{__version__}",\n  "deps": [],\n  "urls": [\n{lines}\n  ]\n}}\n'


def main(root: Path) -> None:
    """Write them below root, a checkout."""
    for name, text in manifests():
        (root / name).write_text(text, encoding="utf-8")
        print(root / name)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path.cwd())
