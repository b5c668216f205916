"""What the subset of kernels lacks is refused with its row. (What it has, bits of kernels show.)"""

import pytest
from zerorate_tools.kernels.c_functions import kernels_in_c
from zerorate_tools.kernels.reading import Kernels, NotKernel


def package(folder, **files):
    """Kernels of files by their path, its folders parted by __."""
    for name, text in files.items():
        path = folder / f"{name.replace('__', '/')}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return Kernels(folder)


@pytest.mark.parametrize(
    ("statement", "what"),
    {
        "return 1.5": "Constant",
        "return True": "Constant",
        "return a / 2": "BinOp",
        "return +a": "UnaryOp",
        "return a is s": "Compare",
        "a **= 2": "AugAssign",
        "a = s = 1": "Assign",
        "s.a = 1": "Attribute",
        "s.f()": "Call",
        "g(a=1)": "Call",
        "pass": "Pass",
        "while a: a = 0\n    else: a = 1": "While",
        "for i in range(3): a = 0\n    else: a = 1": "For",
        "for i in s: a = 0": "For",
        "for i in list(a): a = 0": "For",
        "for i in s.f(a): a = 0": "For",
        "for s[0] in range(a): a = 0": "For",
        "for i in range(): a = 0": "For",
        "for i in range(1, 2, 3, 4): a = 0": "For",
    }.items(),
)
def test_what_the_subset_does_not_have_is_refused_with_its_row(tmp_path, statement, what):
    kernels = package(tmp_path, a=f"ptr32 = 0\ndef f(s: ptr32, a: int):\n    {statement}\n")
    with pytest.raises(NotKernel, match=f"a.py: row 3: {what} is not in the kernel subset"):
        kernels_in_c(kernels, ("a", "f"))


def test_what_is_no_kernel_is_not_called_and_none_that_is_missing_is_begun_with(tmp_path):
    kernels = package(tmp_path, a="def f(a: int):\n    g(a)\ndef g(a):\n    pass\n")
    with pytest.raises(NotKernel, match="a.py: calls g, which is no kernel"):
        kernels_in_c(kernels, ("a", "f"))
    for file, name in (("a", "g"), ("b", "f")):
        with pytest.raises(NotKernel, match=f"has no kernel {name} in a file {file}.py"):
            kernels_in_c(kernels, (file, name))
