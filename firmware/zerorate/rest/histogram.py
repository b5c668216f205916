"""The adaptive histogram: few bins that crowd where the readings do."""

# US 9,354,080: "represents a plurality of gyroscope readings ... in a histogram", bin significance,
# "adapting bin widths". A histogram at word `h` of the state is
#
#     h .. h+bins           lower edge << 14 | population, the last one the upper edge of all
#     h+bins+1 .. h+2*bins  sum of the readings of each bin, LSB
#
# `readings` may come one by one (weight 1) or as the sum of `weight` readings of a still stretch.

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The corrector's state
_EMPTIEST = const(7)
# layout: An axis
_WAITING_SUM = const(0)
_WAITING_N = const(1)
# layout: The corrector's settings
_BINS = const(18)
_LOW_LSB = const(19)
_WIDTH_LSB = const(20)
_NARROWEST_LSB = const(21)
_SPLIT_RATIO = const(22)
_LITERAL = const(23)
_IGNORE_OUTSIDE = const(24)
_ENOUGH_TO_SPLIT = const(25)
_EVERY = const(48)
# layout: end
_MOST_READINGS = const(0x3FFF)


def clear(s: ptr32, c: ptr32, h: int, middle: int):
    """Make all bins equal and empty, about `middle`; about 0 where moving readings come as well."""
    i = 0
    low = c[_LOW_LSB] if c[_EVERY] else middle + c[_LOW_LSB]
    while i <= c[_BINS]:
        s[h + i] = (low + i * c[_WIDTH_LSB]) << 14
        i += 1
    while i <= c[_BINS] + c[_BINS]:
        s[h + i] = 0
        i += 1


def population(s: ptr32, h: int, bins: int) -> int:
    """Return the number of readings that the histogram stands for."""
    count = 0
    for i in range(h, h + bins):
        count += s[i] & _MOST_READINGS
    return count


def halve(s: ptr32, h: int, bins: int):
    """Halve every population; each bin keeps its mean, whatever the halving rounds away."""
    i = 0
    while i < bins:
        count = s[h + i] & _MOST_READINGS
        if count:
            total = s[h + bins + 1 + i]
            rest = total % count
            total = total // count * (count >> 1) + rest * (count >> 1) // count
            s[h + bins + 1 + i] = total
            count = s[h + i] - ((count + 1) >> 1)
            s[h + i] = count
        i += 1


def place(s: ptr32, c: ptr32, h: int, reading: int) -> int:
    """Return the bin of `reading`, or -1 if it is outside and readings outside are ignored."""
    k = c[_BINS]
    if reading < (s[h] >> 14):
        if c[_IGNORE_OUTSIDE]:
            return -1
        s[h] = (reading << 14) + (s[h] & _MOST_READINGS)
    elif reading >= (s[h + k] >> 14):
        if c[_IGNORE_OUTSIDE]:
            return -1
        s[h + k] = (reading + 1) << 14
    k -= 1
    while reading < (s[h + k] >> 14):
        k -= 1
    return k


def merge(s: ptr32, h: int, bins: int, p: int):
    """Join the bins p and p+1 and close the gap; the last bin's place is free then."""
    while (s[h + p] & _MOST_READINGS) + (s[h + p + 1] & _MOST_READINGS) > _MOST_READINGS:
        halve(s, h, bins)
    s[h + p] += s[h + p + 1] & _MOST_READINGS
    s[h + bins + 1 + p] += s[h + bins + 2 + p]
    for k in range(p + 1, bins):
        s[h + k] = s[h + k + 1]
        if k < bins - 1:
            s[h + bins + 1 + k] = s[h + bins + 2 + k]


def open_gap(s: ptr32, h: int, bins: int, j: int):
    """Move the bins above j one place up; bin j's halves share its place and the free one."""
    k = bins
    while k > j:
        s[h + k] = s[h + k - 1]
        if k > j + 1:
            s[h + bins + k] = s[h + bins + k - 1]
        k -= 1
    width = (s[h + j + 2] >> 14) - (s[h + j] >> 14)
    s[h + j + 1] = ((s[h + j] >> 14) + (width >> 1)) << 14


def share_evenly(s: ptr32, h: int, bins: int, j: int):
    """Give the upper half of a split bin j half of its population and of its sum (the document)."""
    count = s[h + j] & _MOST_READINGS
    total = s[h + bins + 1 + j]
    upper = count >> 1
    s[h + j] -= upper
    s[h + j + 1] += upper
    if count:
        upper = (total // count) * upper + (total % count) * upper // count
    s[h + bins + 2 + j] = upper
    s[h + bins + 1 + j] = total - upper


def share_by_mean(s: ptr32, h: int, bins: int, j: int):
    """Give all that a split bin j held to the half that holds its mean, which it so keeps."""
    count = s[h + j] & _MOST_READINGS
    total = s[h + bins + 1 + j]
    if total >= (s[h + j + 1] >> 14) * count:
        s[h + j] -= count
        s[h + j + 1] += count
        s[h + bins + 1 + j] = 0
        s[h + bins + 2 + j] = total
    else:
        s[h + bins + 2 + j] = 0


def emptiest(s: ptr32, c: ptr32, h: int, j: int) -> int:
    """Return the lower bin of the emptiest adjacent pair without bin j."""
    # By the document the pair with the fewest readings, else the one with the lowest significance.
    s[_EMPTIEST] = 0x3FFFFFFF
    found = 0
    i = h
    while i < h + c[_BINS] - 1:
        if i != h + j and i + 1 != h + j:
            count = s[i] & _MOST_READINGS
            count += s[i + 1] & _MOST_READINGS
            if c[_LITERAL] == 0:
                count = (count << 12) // ((s[i + 2] >> 14) - (s[i] >> 14))
            if count < s[_EMPTIEST]:
                s[_EMPTIEST] = count
                found = i - h
        i += 1
    return found


def fullest(s: ptr32, h: int, bins: int) -> int:
    """Return the bin with the largest population."""
    j = 0
    i = bins
    while i > 0:
        i -= 1
        if (s[h + i] & _MOST_READINGS) >= (s[h + j] & _MOST_READINGS):
            j = i
    return j


def crowded(s: ptr32, c: ptr32, j: int, p: int) -> int:
    """Return 1 if the bin at word j is full enough beside the emptiest pair at p to be split."""
    count = s[j] & _MOST_READINGS
    pair = (s[p] & _MOST_READINGS) + (s[p + 1] & _MOST_READINGS)
    if count < c[_ENOUGH_TO_SPLIT]:
        return 0
    if c[_LITERAL] == 0:
        count = (count << 12) // ((s[j + 1] >> 14) - (s[j] >> 14))
        pair = (pair << 12) // ((s[p + 2] >> 14) - (s[p] >> 14))
    return 1 if count > c[_SPLIT_RATIO] * pair else 0


def recentre(s: ptr32, c: ptr32, h: int, k: int) -> int:
    """Slide the narrow bin k under its mean, so that it cuts off evenly; return 1 if it moved."""
    # A mean in the middle of a bin much wider than the noise is unbiased;
    # that of a bin that cuts the noise on one side is not. No reading changes its bin.
    if k == 0 or k == c[_BINS] - 1:
        return 0
    h += k  # eleven words: h is from here on the bin itself, k its readings
    width = (s[h + 1] >> 14) - (s[h] >> 14)
    k = s[h] & _MOST_READINGS
    if k < c[_ENOUGH_TO_SPLIT] or width >= 4 * c[_NARROWEST_LSB]:
        return 0
    by = s[h + 1 + c[_BINS]] // k - (s[h] >> 14) - (width >> 1)
    if width < 32:
        width = 32  # a step of one LSB either way is rounding
    if by < (width >> 4) and by > -(width >> 4):
        return 0
    if (s[h] >> 14) + by <= (s[h - 1] >> 14) or (s[h + 1] >> 14) + by >= (s[h + 2] >> 14):
        return 0
    s[h] += by << 14
    s[h + 1] += by << 14
    return 1


def adapt(s: ptr32, c: ptr32, h: int, k: int) -> int:
    """Split the bin that crowds and merge the emptiest pair; return 1 if the edges changed."""
    # By the document the fullest is split, else k where it crowds.
    if c[_BINS] == 1:
        return 0
    if c[_LITERAL]:
        k = fullest(s, h, c[_BINS])  # eleven words: k is the bin to split, wherever it moves to
    elif recentre(s, c, h, k):
        halve(s, h, c[_BINS])
        return 1
    if (s[h + k + 1] >> 14) - (s[h + k] >> 14) < 2 * c[_NARROWEST_LSB]:
        return 0
    pair = emptiest(s, c, h, k)
    if crowded(s, c, h + k, h + pair) == 0:
        return 0
    merge(s, h, c[_BINS], pair)
    if pair < k:
        k -= 1
    open_gap(s, h, c[_BINS], k)
    if c[_LITERAL]:
        share_evenly(s, h, c[_BINS], k)
    else:
        share_by_mean(s, h, c[_BINS], k)
        halve(s, h, c[_BINS])
    return 1


def add(s: ptr32, c: ptr32, h: int, a: int) -> int:
    """Add the readings that wait at the axis `a`; return 1, or 0 if they were ignored."""
    k = s[a + _WAITING_SUM] // s[a + _WAITING_N]
    k = place(s, c, h, k)
    if k < 0:
        return 0
    while (s[h + k] & _MOST_READINGS) + s[a + _WAITING_N] > _MOST_READINGS:
        halve(s, h, c[_BINS])
    s[h + k] += s[a + _WAITING_N]
    s[h + k + 1 + c[_BINS]] += s[a + _WAITING_SUM]
    adapt(s, c, h, k)
    return 1


def most_significant(s: ptr32, h: int, bins: int) -> int:
    """Return the bin with the largest population for its width."""
    best = h
    i = h + 1
    while i < h + bins:
        # cross-multiplied: 2^14 readings x 2^16 LSB stay below 2^30
        mine = (s[i] & _MOST_READINGS) * ((s[best + 1] >> 14) - (s[best] >> 14))
        if mine > (s[best] & _MOST_READINGS) * ((s[i + 1] >> 14) - (s[i] >> 14)):
            best = i
        i += 1
    return best - h


def read_out_q8(s: ptr32, h: int, bins: int) -> int:
    """Return the mean of the most significant bin in LSB, Q8; 0 where the histogram is empty."""
    k = most_significant(s, h, bins)
    count = s[h + k] & _MOST_READINGS
    if count == 0:
        return 0
    total = s[h + bins + 1 + k]
    return ((total // count) << 8) + ((total % count) << 8) // count
