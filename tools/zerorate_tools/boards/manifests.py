"""Writes firmware/package.json and drivers/package.json, from which `mip` installs, from the tree.

python -m zerorate_tools.boards.manifests, in a checkout; a test fails while either is stale.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from .. import __version__
from .flashing import package_files

FOLDERS = {"zerorate": "firmware", "zerorate_i2c": "drivers"}


def package_json(package: str) -> str:
    """The text of a package's package.json: each file from beside it to the same path in lib."""
    urls = [[str(name), str(name)] for name in package_files(package)]
    lines = ",\n".join("    " + json.dumps(url) for url in urls)
    return f'{{\n  "version": "{__version__}",\n  "deps": [],\n  "urls": [\n{lines}\n  ]\n}}\n'


def main(root: Path) -> None:
    """Write both below root, a checkout."""
    for package, folder in FOLDERS.items():
        path = root / folder / "package.json"
        path.write_text(package_json(package), encoding="utf-8")
        print(path)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path.cwd())
