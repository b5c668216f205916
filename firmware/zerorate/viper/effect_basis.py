# Generated from zerorate/effect_basis.py by `make viper`: edit that file, not this one.
"""The basis of one effect slot: what its coefficients are multiplied by, once a tick, in Q24.

Order: clamp, centre, delay, [power first], lag or memory, knot, table or power, second source,
decay.
The tool scales each slot so that no stage leaves +-1 (2^24), and 1 stands for the largest value
that the fitted range allows. Words of a slot: docs/layout.md."""

import micropython

from .fixed import scaled


@micropython.viper
def power(n: int, v: int) -> int:
    u = v
    while n > 1:
        scaled_b = v
        scaled_high = scaled_b >> 15
        scaled_b = scaled_b & 32767
        scaled_middle = (u >> 15) * scaled_b + (u & 32767) * scaled_high + ((u & 32767) * scaled_b >> 15)
        scaled_high = (u >> 15) * scaled_high
        u = (scaled_high << 6) + (scaled_middle >> 9)
        n = n - 1
    return u


@micropython.viper
def approach(u: int, f: int, e: ptr32, z: int):
    e_z = ptr32(int(e) + (z << 2))
    d = u - e_z[0]
    u = e[f + 1] + 3
    t = (d >> 12) * e[f]
    d = (d & 4095) * e[f] + e_z[1]
    f = t >> u
    d = (t - (f << u) << 12) + d
    u = u + 12
    t = d >> u
    e_z[0] = f + t + e_z[0]
    e_z[1] = d - (t << u)


@micropython.viper
def start(a: int, e: ptr32, u: int):
    e_a = ptr32(int(e) + (a << 2))
    e_a[34] = 1
    e_a[35] = u
    e_a[36] = 0
    e_a[37] = 16777216
    e_a[38] = 0


@micropython.viper
def remembered(a: int, u: int, e: ptr32) -> int:
    e_a = ptr32(int(e) + (a << 2))
    kind = e_a[7]
    a = a + 35
    e_a = ptr32(int(e_a) + 140)
    if kind <= 3:
        approach_f = a - 27
        approach_u = u
        approach_d = approach_u - e_a[0]
        approach_u = e[approach_f + 1] + 3
        approach_t = (approach_d >> 12) * e[approach_f]
        approach_d = (approach_d & 4095) * e[approach_f] + e_a[1]
        approach_f = approach_t >> approach_u
        approach_d = (approach_t - (approach_f << approach_u) << 12) + approach_d
        approach_u = approach_u + 12
        approach_t = approach_d >> approach_u
        e_a[0] = approach_f + approach_t + e_a[0]
        e_a[1] = approach_d - (approach_t << approach_u)
        return e_a[0] if kind == 1 else u - e_a[0]
    p = e_a[0]
    if not kind - 4:
        half = e[a - 25]
        if p < u - half:
            p = u - half
        elif p > u + half:
            p = u + half
    elif p < u:
        p = u
    e_a[0] = p
    return p - u


@micropython.viper
def looked_up(v: int, e: ptr32, a: int) -> int:
    e_a = ptr32(int(e) + (a << 2))
    table = e_a[19]
    e_table = ptr32(int(e) + (table << 2))
    scaled_a = v - e_a[20]
    scaled_b = e_a[21]
    scaled_shift = e_a[22]
    scaled_high = scaled_b >> 15
    scaled_b = scaled_b & 32767
    scaled_middle = (scaled_a >> 15) * scaled_b + (scaled_a & 32767) * scaled_high + ((scaled_a & 32767) * scaled_b >> 15)
    scaled_high = (scaled_a >> 15) * scaled_high
    v = (scaled_high << 30 - scaled_shift) + (scaled_middle >> scaled_shift - 15)
    if v <= 0:
        return e_table[0]
    if v >= 134217728:
        return e_table[8]
    table = (v >> 24) + table
    e_table = ptr32(int(e) + (table << 2))
    scaled_a = e_table[1] - e_table[0]
    scaled_b = v & 16777215
    scaled_high = scaled_b >> 15
    scaled_b = scaled_b & 32767
    scaled_middle = (scaled_a >> 15) * scaled_b + (scaled_a & 32767) * scaled_high + ((scaled_a & 32767) * scaled_b >> 15)
    scaled_high = (scaled_a >> 15) * scaled_high
    scaled_result = (scaled_high << 6) + (scaled_middle >> 9)
    return e_table[0] + scaled_result


@micropython.viper
def basis(e: ptr32, a: int, e_) -> int:
    e_a = ptr32(int(e) + (a << 2))
    centred_u = e[e_a[0]]
    if not centred_u - -1073741823:
        v = -1073741823
    else:
        if centred_u < e_a[1]:
            centred_u = e_a[1]
        elif centred_u > e_a[2]:
            centred_u = e_a[2]
        centred_u = centred_u - e_a[3]
        centred_shift = e_a[4]
        if centred_shift >> 30:
            v = centred_u >> 0 - centred_shift
        else:
            v = centred_u << centred_shift
    w = 16777216
    if e_a[12]:
        centred_f = a + 12
        e_centred_f = ptr32(int(e) + (centred_f << 2))
        centred_u = e[e_centred_f[0]]
        if not centred_u - -1073741823:
            w = -1073741823
        else:
            if centred_u < e_centred_f[1]:
                centred_u = e_centred_f[1]
            elif centred_u > e_centred_f[2]:
                centred_u = e_centred_f[2]
            centred_u = centred_u - e_centred_f[3]
            centred_shift = e_centred_f[4]
            if centred_shift >> 30:
                w = centred_u >> 0 - centred_shift
            else:
                w = centred_u << centred_shift
    if not v - -1073741823 or not w - -1073741823:
        return 0
    if e_a[27]:
        delayed_a = a
        e_delayed_a = ptr32(int(e) + (delayed_a << 2))
        delayed_u = v
        delayed_ring = e_delayed_a[27]
        e_delayed_ring = ptr32(int(e) + (delayed_ring << 2))
        if not e_delayed_a[34]:
            e_delayed_ring[0] = 0
            e_delayed_ring[1] = 0
            while e_delayed_ring[0] < 64:
                e[delayed_ring + 2 + e_delayed_ring[0]] = delayed_u
                e_delayed_ring[0] = e_delayed_ring[0] + 1
            e_delayed_ring[0] = 0
        elif not e_delayed_ring[1]:
            e_delayed_ring[0] = e_delayed_ring[0] + 1 & 63
            e[delayed_ring + 2 + e_delayed_ring[0]] = delayed_u
        delayed_u = e_delayed_a[28] - e_delayed_ring[1]
        delayed_a = e_delayed_a[29]
        e_delayed_a = ptr32(int(e) + (delayed_a << 2))
        e_delayed_ring[1] = (e_delayed_ring[1] + 1) % delayed_a
        delayed_between_place = e_delayed_ring[0] - delayed_u // delayed_a
        delayed_between_part = delayed_u % delayed_a
        delayed_between_u = e[delayed_ring + 2 + (delayed_between_place & 63)]
        delayed_between_d = e[delayed_ring + 2 + (delayed_between_place - 1 & 63)] - delayed_between_u
        if delayed_between_d >> 30:
            v = delayed_between_u - ((0 - delayed_between_d >> 4) * delayed_between_part // delayed_a << 4)
        else:
            v = ((delayed_between_d >> 4) * delayed_between_part // delayed_a << 4) + delayed_between_u
    if e_a[6]:
        v = int(power(e_a[5], v))
    if not e_a[34]:
        start(a, e_, v)
    if e_a[7]:
        v = int(remembered(a, v, e_))
    if e_a[11] - -1073741823:
        v = v - e_a[11]
        if v >> 30:
            v = 0
    if e_a[19]:
        v = int(looked_up(v, e_, a))
    elif not e_a[6]:
        v = int(power(e_a[5], v))
    if e_a[12]:
        v = int(scaled(w, v, 24))
    if e_a[17]:
        v = int(scaled(e_a[37], v, 24))
        approach(0, a + 17, e_, a + 37)
    return v


@micropython.viper
def add_times(to: int, v: int, a: int, e: ptr32, shift: int):
    i = 3
    while i > 0:
        scaled_b = e[a]
        scaled_high = scaled_b >> 15
        scaled_b = scaled_b & 32767
        scaled_middle = (v >> 15) * scaled_b + (v & 32767) * scaled_high + ((v & 32767) * scaled_b >> 15)
        scaled_high = (v >> 15) * scaled_high
        d = (scaled_high << 30 - shift) + (scaled_middle >> shift - 15)
        d = d + e[to]
        if d > 536870911:
            d = 536870911
        elif d < -536870911:
            d = -536870911
        e[to] = d
        to = to + 1
        a = a + 1
        i = i - 1
