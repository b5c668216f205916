"""The generated files are those that the kernels give."""

import pytest
from zerorate_bench.native.native_files import stale


def test_the_committed_machine_code_is_what_the_kernels_give_byte_for_byte(repository):
    pytest.importorskip("ziglang")
    assert stale(repository / "firmware" / "zerorate") == [], "make native"
