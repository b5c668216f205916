"""The way of a sample at rest: examined, learned from, corrected."""

from .choosing import machine_code

step = machine_code("rest")

if step:
    from .stages import admit, consider, copy, finish, reset
else:
    from ..rest.copying import copy  # type: ignore[assignment]  # noqa: F401
    from ..rest.estimators import reset  # type: ignore[assignment]  # noqa: F401
    from ..rest.step import admit, consider, finish, step  # type: ignore[assignment]  # noqa: F401
