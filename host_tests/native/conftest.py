"""What the tests of machine code stand on."""

import json

import pytest

from ..firmware.trace_on_host import GOLDEN


@pytest.fixture(scope="session")
def golden():
    """Mode -> checksums that were committed."""
    return json.loads(GOLDEN.read_text(encoding="utf-8"))
