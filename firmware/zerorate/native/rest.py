"""The way of a sample at rest: examined, learned from, corrected."""

from . import machine_code

const = int  # on a board the compiler itself reads const(...)

# what stands in the fourth argument's upper half word (tools/zerorate_tools/kernels/parts.py)
_ADMIT = const(-0x40000000)
_FINISH = const(-0x3FFF0000)
_CONSIDER = const(-0x3FFE0000)
_RESET = const(-0x3FFD0000)
_COPY = const(-0x3FFC0000)
_ADDRESS = const(-0x3FFB0000)

step = machine_code("rest")
is_machine_code = bool(step)

if step:

    def admit(s, c, x, kind):
        return step(s, c, x, _ADMIT + kind)

    def finish(s, c, x, kind):
        return step(s, c, x, _FINISH + kind)

    def consider(s, c, m, w, source):
        step(s, c, m, _CONSIDER + (source << 8) + w)

    def reset(s, c, a):
        step(s, c, 0, _RESET + a)

    def copy(source, target, first, end):
        step(source, target, end, _COPY + first)

    def address(words):
        return step(words, 0, 0, _ADDRESS)

    def bound(s, c):
        """step(x, dt_us) of these two arrays: to look up where they lie takes as long as it."""
        run = step
        s_at = address(s)
        c_at = address(c)

        def update(x, dt_us, kept=(s, c)):
            return run(s_at, c_at, x, dt_us)

        return update

    def examined(c):
        """(examine, settings that it wants): the guard alone, for who asks others as well."""
        return step, address(c) + 1

else:
    from ..rest import guard
    from ..rest.copying import copy  # type: ignore[assignment]  # noqa: F401
    from ..rest.estimators import reset  # type: ignore[assignment]  # noqa: F401
    from ..rest.step import admit, consider, finish, step  # type: ignore[assignment]  # noqa: F401

    def examined(c):  # type: ignore[misc]
        return guard.check, c
