"""Many samples in one call."""

from . import machine_code

# the word of the room in which the burst's end stands
_END = 8

run = machine_code("bursts")

if run:

    def block(s, f, c, r, n):
        r[_END] = n << 3
        run(s, c, f, r)
