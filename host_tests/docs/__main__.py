"""`make docs`: writes what in docs/ is made by a command: tables, pictures, console output."""

import shutil
import sys
import tempfile
from pathlib import Path

from .outputs import blocks, pages, refreshed, with_tables


def main(repository, only=()):
    """Write the pages anew; only: names of those whose commands are run, `none`, all by default."""
    docs = repository / "docs"
    for page in pages(repository):
        if blocks(page, "console") and (not only or page.name in only):
            print(page.relative_to(repository), flush=True)
            with tempfile.TemporaryDirectory() as folder:
                page.write_text(refreshed(page, folder), encoding="utf-8")
                for picture in ("shown/demo.png", "watch.png"):
                    if (Path(folder) / picture).exists():
                        shutil.copy(Path(folder) / picture, docs)
        page.write_text(with_tables(page.read_text(encoding="utf-8"), docs), encoding="utf-8")


if __name__ == "__main__":
    main(Path(__file__).resolve().parents[2], sys.argv[1:])
