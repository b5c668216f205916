"""Reads the kernels of the firmware: which files hold them, what each calls, which constants.

A kernel is a function of any file below the package with bare annotations, int or ptr32. A
file is known by its stem, wherever it lies, so that `from ..fit.line import draw_line` and
`from .line import draw_line` are the same.
"""

import ast
from dataclasses import dataclass
from functools import cached_property
from importlib.util import find_spec
from pathlib import Path

from ..errors import InFile

# generated from the kernels, and read by nobody as such
_GENERATED = "native"


class NotKernel(InFile):
    """Text that the kernel subset does not have, or a kernel that is not there."""


@dataclass(frozen=True)
class KernelFile:
    path: Path

    @property
    def name(self) -> str:
        return self.path.stem

    @cached_property
    def tree(self) -> ast.Module:
        return ast.parse(self.path.read_text(encoding="utf-8"), str(self.path))

    @cached_property
    def kernels(self) -> dict[str, ast.FunctionDef]:
        """Name -> annotated function, in the file's order."""
        return {n.name: n for n in self.tree.body if isinstance(n, ast.FunctionDef) and _kernel(n)}

    @cached_property
    def homes(self) -> dict[str, tuple[str, str]]:
        """Name as this file says it -> file and function that it is."""
        found = {name: (self.name, name) for name in self.kernels}
        for node in self.tree.body:
            if isinstance(node, ast.ImportFrom) and node.level and node.module:
                stem = node.module.rpartition(".")[2]
                found.update(
                    (alias.asname or alias.name, (stem, alias.name)) for alias in node.names
                )
        return found

    @cached_property
    def constants(self) -> dict[str, int]:
        """The names that `const(...)` gives to numbers."""
        found = {}
        for node in self.tree.body:
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call):
                target, value = node.targets[0], node.value
                if isinstance(target, ast.Name) and value.args:
                    found[target.id] = ast.literal_eval(value.args[0])
        return found

    def calls(self, name: str) -> list[tuple[str, str]]:
        """File and function of each kernel that the kernel calls."""
        calls = [n for n in ast.walk(self.kernels[name]) if isinstance(n, ast.Call)]
        names = [n.func.id for n in calls if isinstance(n.func, ast.Name)]
        return [self.homes[n] for n in dict.fromkeys(names) if n in self.homes]


class Kernels:
    """All kernel files below `package`, the firmware's folder, by their stem."""

    def __init__(self, package: Path | None = None) -> None:
        self.package = package or firmware_package()
        self.files = {path.stem: KernelFile(path) for path in kernel_files(self.package)}

    def kernel(self, file: str, name: str) -> ast.FunctionDef:
        """The function. Raises NotKernel where there is none of that name."""
        if file not in self.files or name not in self.files[file].kernels:
            raise NotKernel(self.package, f"has no kernel {name} in a file {file}.py")
        return self.files[file].kernels[name]

    def behind(self, *entries: tuple[str, str]) -> list[tuple[str, str]]:
        """The entries (file, function) and all that they call, each behind what it calls."""
        order: dict[tuple[str, str], None] = {}

        def visit(one: tuple[str, str]) -> None:
            if one not in order:
                self.kernel(*one)
                for called in self.files[one[0]].calls(one[1]):
                    visit(called)
                order[one] = None

        for entry in entries:
            visit(entry)
        return list(order)


def firmware_package() -> Path:
    spec = find_spec("zerorate")
    assert spec is not None and spec.origin is not None
    return Path(spec.origin).parent


def kernel_files(package: Path) -> list[Path]:
    """The files below `package` with kernels in them. Raises NotKernel for two of one name."""
    files = sorted(package.rglob("*.py"))
    files = [p for p in files if _GENERATED not in p.relative_to(package).parts]
    found = [path for path in files if KernelFile(path).kernels]
    for path in found:
        if sum(other.stem == path.stem for other in found) > 1:
            raise NotKernel(path, "has the name of another file with kernels")
    return found


def _kernel(function: ast.FunctionDef) -> bool:
    given = [function.returns, *(a.annotation for a in function.args.args)]
    return any(isinstance(one, ast.Name) for one in given)
