"""How long the fuzz targets try: briefly among the tests, for hours by `make fuzz`.

What once failed is kept in seeds/ and tried first.
"""

import os
from pathlib import Path

from hypothesis import HealthCheck, settings
from hypothesis.database import DirectoryBasedExampleDatabase

EXAMPLES = int(os.environ.get("ZERORATE_FUZZ", "30"))
PATIENT = settings(
    max_examples=EXAMPLES,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
    database=DirectoryBasedExampleDatabase(Path(__file__).parent / "seeds"),
)
