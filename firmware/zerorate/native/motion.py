"""The source that learns in motion."""

from . import machine_code

_CLEAR = -0x40000000

update = machine_code("motion")

if update:

    def clear(s, c):
        update(s, c, 0, _CLEAR)

else:
    from ..motion.in_motion import update  # type: ignore[assignment]  # noqa: F401
    from ..motion.motion_verdict import clear  # noqa: F401
