"""The guard alone, for who asks it before other sources take the sample."""

from . import machine_code

examine = machine_code("guard")

if not examine:
    from ..rest.guard import check as examine  # type: ignore[assignment]  # noqa: F401
