"""What loading from a store says, as numbers: boards have them in place of these names."""

# layout: names that a board's own compiler reads
const = int
# layout: What a store says
LOADED = const(0)
EMPTY = const(1)
DAMAGED = const(2)
OTHER_BINDING = const(3)
OTHER_VERSION = const(4)
OTHER_SIZE = const(5)
UNREADABLE = const(6)
OUT_OF_RANGE = const(7)
# layout: end
