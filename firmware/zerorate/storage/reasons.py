"""What loading from a store says, in words."""

# layout: names that a board's own compiler reads
const = int
# layout: What a store says, in words
REASONS = (
    "loaded",
    "nothing was ever stored",
    "neither slot is whole",
    "stored for another chip, range, filter, effect model or other settings",
    "stored by another version",
    "stored with another size",
    "the storage cannot be read",
    "a word of what was stored cannot be",
)
# layout: end
