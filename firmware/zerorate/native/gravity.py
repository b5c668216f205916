"""The source that learns against gravity."""

from . import machine_code

_CLEAR = -0x40000000

update = machine_code("gravity")

if update:

    def clear(s, c):
        update(s, c, 0, _CLEAR)

else:
    from ..gravity.gravity import clear, update  # type: ignore[assignment]  # noqa: F401
