"""The effect slots of a model."""

from . import machine_code

run = machine_code("effects")

if run:

    def sense(s, e, x, dt_us, good):
        run(s, e, x if good else 0, dt_us)

else:
    from ..effects.effects import sense  # noqa: F401
