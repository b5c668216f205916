"""All figures of imports: of logs of others as a user imports them, and of single steps."""

from .import_corpus import LOGS_OF_OTHERS
from .import_logs import LOGS
from .import_spools import SPOOLS, parts
from .import_steps import STEPS
from .import_texts import TEXTS

IMPORTED = dict(sorted({**LOGS_OF_OTHERS, **STEPS, **SPOOLS, **TEXTS, **LOGS}.items()))
IMPORTED["imported parts"] = parts
