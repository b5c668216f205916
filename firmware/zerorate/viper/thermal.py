# Generated from zerorate/thermal.py by `make viper`: edit that file, not this one.
"""How the bias found in motion follows the temperature, between one window and the next.

A Kalman filter of two states an axis, bias and slope over temperature: the window's least squares
are its measurement. A bias carried along its slope does not lag behind a ramp, and what the ramp
teaches of the slope costs no more than its covariance with the bias.

Three packed numbers an axis at _TEMP_SLOPES: the slope, its covariance with the bias, its variance,
in Q24 rad a node and raw LSB of the thermometer."""

import micropython

from .real import add_smaller
from .real import divide
from .real import multiply
from .real import subtract


@micropython.viper
def follow_temperature(s: ptr32, temp: int):
    temp = temp << 8
    if not s[9]:
        s[238] = temp
        s[240] = temp
    s[238] = (temp - s[238] + 32 >> 6) + s[238]
    s[240] = (temp - s[240] + 2 >> 2) + s[240]


@micropython.viper
def present(s: ptr32, i: int, s_):
    put_m = s[240] - s[239]
    put_e = -8
    if not put_m:
        s[205] = 0
        s[206] = -4096
    else:
        while put_m < 524288 and put_m >= -524288:
            put_m = put_m << 8
            put_e = put_e - 8
        while put_m < 134217728 and put_m >= -134217728:
            put_m = put_m << 1
            put_e = put_e - 1
        while put_m >= 268435456 or put_m < -268435456:
            put_m = put_m >> 1
            put_e = put_e + 1
        s[205] = put_m
        s[206] = put_e
    unpack_a = 3 * i + 229
    s_unpack_a = ptr32(int(s) + (unpack_a << 2))
    unpack_put_m = s_unpack_a[0] >> 7 << 5
    unpack_put_e = (s_unpack_a[0] & 127) - 96
    if not unpack_put_m:
        s[207] = 0
        s[208] = -4096
    else:
        while unpack_put_m < 524288 and unpack_put_m >= -524288:
            unpack_put_m = unpack_put_m << 8
            unpack_put_e = unpack_put_e - 8
        while unpack_put_m < 134217728 and unpack_put_m >= -134217728:
            unpack_put_m = unpack_put_m << 1
            unpack_put_e = unpack_put_e - 1
        while unpack_put_m >= 268435456 or unpack_put_m < -268435456:
            unpack_put_m = unpack_put_m >> 1
            unpack_put_e = unpack_put_e + 1
        s[207] = unpack_put_m
        s[208] = unpack_put_e
    multiply(s_, 205, 207, 205)
    real_add_b = 2 * i + 179
    if s[206] < s[real_add_b + 1]:
        add_smaller(s_, real_add_b, 205, 205)
    else:
        add_smaller(s_, 205, real_add_b, 205)


@micropython.viper
def unpack_slope(unpack_put_m: int, s: ptr32, a: int):
    s_a = ptr32(int(s) + (a << 2))
    unpack_put_m = s_a[0] >> 7 << 5
    unpack_put_e = (s_a[0] & 127) - 96
    if not unpack_put_m:
        s[185] = 0
        s[186] = -4096
    else:
        while unpack_put_m < 524288 and unpack_put_m >= -524288:
            unpack_put_m = unpack_put_m << 8
            unpack_put_e = unpack_put_e - 8
        while unpack_put_m < 134217728 and unpack_put_m >= -134217728:
            unpack_put_m = unpack_put_m << 1
            unpack_put_e = unpack_put_e - 1
        while unpack_put_m >= 268435456 or unpack_put_m < -268435456:
            unpack_put_m = unpack_put_m >> 1
            unpack_put_e = unpack_put_e + 1
        s[185] = unpack_put_m
        s[186] = unpack_put_e
    unpack_a = a + 1
    s_unpack_a = ptr32(int(s) + (unpack_a << 2))
    unpack_put_m = s_unpack_a[0] >> 7 << 5
    unpack_put_e = (s_unpack_a[0] & 127) - 96
    if not unpack_put_m:
        s[187] = 0
        s[188] = -4096
    else:
        while unpack_put_m < 524288 and unpack_put_m >= -524288:
            unpack_put_m = unpack_put_m << 8
            unpack_put_e = unpack_put_e - 8
        while unpack_put_m < 134217728 and unpack_put_m >= -134217728:
            unpack_put_m = unpack_put_m << 1
            unpack_put_e = unpack_put_e - 1
        while unpack_put_m >= 268435456 or unpack_put_m < -268435456:
            unpack_put_m = unpack_put_m >> 1
            unpack_put_e = unpack_put_e + 1
        s[187] = unpack_put_m
        s[188] = unpack_put_e
    unpack_a = a + 2
    s_unpack_a = ptr32(int(s) + (unpack_a << 2))
    unpack_put_m = s_unpack_a[0] >> 7 << 5
    unpack_put_e = (s_unpack_a[0] & 127) - 96
    if not unpack_put_m:
        s[189] = 0
        s[190] = -4096
    else:
        while unpack_put_m < 524288 and unpack_put_m >= -524288:
            unpack_put_m = unpack_put_m << 8
            unpack_put_e = unpack_put_e - 8
        while unpack_put_m < 134217728 and unpack_put_m >= -134217728:
            unpack_put_m = unpack_put_m << 1
            unpack_put_e = unpack_put_e - 1
        while unpack_put_m >= 268435456 or unpack_put_m < -268435456:
            unpack_put_m = unpack_put_m >> 1
            unpack_put_e = unpack_put_e + 1
        s[189] = unpack_put_m
        s[190] = unpack_put_e


@micropython.viper
def pack_slope(s: ptr32, a: int):
    s_a = ptr32(int(s) + (a << 2))
    pack_e = s[186] + 96
    if not s[185] or pack_e >> 30 or pack_e > 127:
        s_a[0] = 0
    else:
        s_a[0] = (s[185] >> 5 << 7) + pack_e
    pack_d = a + 1
    s_pack_d = ptr32(int(s) + (pack_d << 2))
    pack_e = s[188] + 96
    if not s[187] or pack_e >> 30 or pack_e > 127:
        s_pack_d[0] = 0
    else:
        s_pack_d[0] = (s[187] >> 5 << 7) + pack_e
    pack_d = a + 2
    s_pack_d = ptr32(int(s) + (pack_d << 2))
    pack_e = s[190] + 96
    if not s[189] or pack_e >> 30 or pack_e > 127:
        s_pack_d[0] = 0
    else:
        s_pack_d[0] = (s[189] >> 5 << 7) + pack_e


@micropython.viper
def carry(put_m: int, known: int, s: ptr32, c: ptr32, s_, c_):
    i = 0
    put_m = s[238] - s[239]
    put_e = -8
    if not put_m:
        s[203] = 0
        s[204] = -4096
    else:
        while put_m < 524288 and put_m >= -524288:
            put_m = put_m << 8
            put_e = put_e - 8
        while put_m < 134217728 and put_m >= -134217728:
            put_m = put_m << 1
            put_e = put_e - 1
        while put_m >= 268435456 or put_m < -268435456:
            put_m = put_m >> 1
            put_e = put_e + 1
        s[203] = put_m
        s[204] = put_e
    put_m = c[12]
    put_e = c[13]
    if not put_m:
        s[207] = 0
        s[208] = -4096
    else:
        while put_m < 524288 and put_m >= -524288:
            put_m = put_m << 8
            put_e = put_e - 8
        while put_m < 134217728 and put_m >= -134217728:
            put_m = put_m << 1
            put_e = put_e - 1
        while put_m >= 268435456 or put_m < -268435456:
            put_m = put_m >> 1
            put_e = put_e + 1
        s[207] = put_m
        s[208] = put_e
    put_m = s[67]
    put_e = 0
    if not put_m:
        s[205] = 0
        s[206] = -4096
    else:
        while put_m < 524288 and put_m >= -524288:
            put_m = put_m << 8
            put_e = put_e - 8
        while put_m < 134217728 and put_m >= -134217728:
            put_m = put_m << 1
            put_e = put_e - 1
        while put_m >= 268435456 or put_m < -268435456:
            put_m = put_m >> 1
            put_e = put_e + 1
        s[205] = put_m
        s[206] = put_e
    multiply(s_, 207, 205, 209)
    while i < 3 and known:
        carry_axis(0, 0, s_, i, c_, s_)
        i = i + 1
    s[239] = s[238]
    s[67] = 0


@micropython.viper
def carry_axis(bend_put_m: int, put_m: int, s: ptr32, i: int, c: ptr32, s_):
    d = 3 * i + 229
    unpack_slope(0, s_, d)
    multiply(s_, 185, 203, 205)
    real_add_d = 2 * i + 173
    real_add_a = 2 * i + 173
    if s[real_add_a + 1] < s[206]:
        add_smaller(s_, 205, real_add_a, real_add_d)
    else:
        add_smaller(s_, real_add_a, 205, real_add_d)
    multiply(s_, 189, 203, 205)
    if s[188] < s[206]:
        add_smaller(s_, 205, 187, 207)
    else:
        add_smaller(s_, 187, 205, 207)
    if s[188] < s[208]:
        add_smaller(s_, 207, 187, 205)
    else:
        add_smaller(s_, 187, 207, 205)
    multiply(s_, 205, 203, 205)
    put_m = s[205] if s[205] > 0 else 0
    put_e = s[206]
    if not put_m:
        s[205] = 0
        s[206] = -4096
    else:
        while put_m < 524288 and put_m >= -524288:
            put_m = put_m << 8
            put_e = put_e - 8
        while put_m < 134217728 and put_m >= -134217728:
            put_m = put_m << 1
            put_e = put_e - 1
        while put_m >= 268435456 or put_m < -268435456:
            put_m = put_m >> 1
            put_e = put_e + 1
        s[205] = put_m
        s[206] = put_e
    if s[206] < s[210]:
        add_smaller(s_, 209, 205, 205)
    else:
        add_smaller(s_, 205, 209, 205)
    v = (7 - i) * i + 149
    if s[v + 1] < s[206]:
        add_smaller(s_, 205, v, v)
    else:
        add_smaller(s_, v, 205, v)
    bend_i = s[203] if s[203] >= 0 else -s[203]
    bend_put_m = bend_i
    bend_put_e = s[204] - c[25]
    if not bend_put_m:
        s[205] = 0
        s[206] = -4096
    else:
        while bend_put_m < 524288 and bend_put_m >= -524288:
            bend_put_m = bend_put_m << 8
            bend_put_e = bend_put_e - 8
        while bend_put_m < 134217728 and bend_put_m >= -134217728:
            bend_put_m = bend_put_m << 1
            bend_put_e = bend_put_e - 1
        while bend_put_m >= 268435456 or bend_put_m < -268435456:
            bend_put_m = bend_put_m >> 1
            bend_put_e = bend_put_e + 1
        s[205] = bend_put_m
        s[206] = bend_put_e
    bend_put_m = c[23]
    bend_put_e = c[24]
    if not bend_put_m:
        s[161] = 0
        s[162] = -4096
    else:
        while bend_put_m < 524288 and bend_put_m >= -524288:
            bend_put_m = bend_put_m << 8
            bend_put_e = bend_put_e - 8
        while bend_put_m < 134217728 and bend_put_m >= -134217728:
            bend_put_m = bend_put_m << 1
            bend_put_e = bend_put_e - 1
        while bend_put_m >= 268435456 or bend_put_m < -268435456:
            bend_put_m = bend_put_m >> 1
            bend_put_e = bend_put_e + 1
        s[161] = bend_put_m
        s[162] = bend_put_e
    multiply(s_, 205, 161, 205)
    if s[190] < s[206]:
        add_smaller(s_, 205, 189, 189)
    else:
        add_smaller(s_, 189, 205, 189)
    put_m = s[207]
    put_e = s[208]
    if not put_m:
        s[187] = 0
        s[188] = -4096
    else:
        while put_m < 524288 and put_m >= -524288:
            put_m = put_m << 8
            put_e = put_e - 8
        while put_m < 134217728 and put_m >= -134217728:
            put_m = put_m << 1
            put_e = put_e - 1
        while put_m >= 268435456 or put_m < -268435456:
            put_m = put_m >> 1
            put_e = put_e + 1
        s[187] = put_m
        s[188] = put_e
    pack_slope(s_, d)


@micropython.viper
def learn_slopes(learn_slope_put_m: int, learn_slope_put_e: int, learn_slope_i: int, s: ptr32, s_):
    i = 0
    while i < 3:
        learn_slope_i = i
        learn_slope_d = 3 * learn_slope_i + 229
        unpack_slope(0, s_, learn_slope_d)
        learn_slope_a = (7 - learn_slope_i) * learn_slope_i + 149
        divide(s_, 187, learn_slope_a, 203)
        subtract(s_, 2 * learn_slope_i + 173, 205, 2 * learn_slope_i + 179, s_)
        multiply(s_, 205, 203, 205)
        if s[186] < s[206]:
            add_smaller(s_, 205, 185, 185)
        else:
            add_smaller(s_, 185, 205, 185)
        if learn_slope_i > learn_slope_i:
            learn_slope_i = (4 * learn_slope_i - ((learn_slope_i + 1) * learn_slope_i >> 1) + learn_slope_i) * 2 + 33
        else:
            learn_slope_i = (4 * learn_slope_i - ((learn_slope_i + 1) * learn_slope_i >> 1) + learn_slope_i) * 2 + 33
        if s[learn_slope_a + 1] < s[learn_slope_i + 1]:
            add_smaller(s_, learn_slope_i, learn_slope_a, 205)
        else:
            add_smaller(s_, learn_slope_a, learn_slope_i, 205)
        multiply(s_, 205, 203, 205)
        multiply(s_, 205, 203, 205)
        subtract(s_, 205, 207, 189, s_)
        learn_slope_put_m = s[207] if s[207] > 0 else 0
        learn_slope_put_e = s[208]
        if not learn_slope_put_m:
            s[189] = 0
            s[190] = -4096
        else:
            while learn_slope_put_m < 524288 and learn_slope_put_m >= -524288:
                learn_slope_put_m = learn_slope_put_m << 8
                learn_slope_put_e = learn_slope_put_e - 8
            while learn_slope_put_m < 134217728 and learn_slope_put_m >= -134217728:
                learn_slope_put_m = learn_slope_put_m << 1
                learn_slope_put_e = learn_slope_put_e - 1
            while learn_slope_put_m >= 268435456 or learn_slope_put_m < -268435456:
                learn_slope_put_m = learn_slope_put_m >> 1
                learn_slope_put_e = learn_slope_put_e + 1
            s[189] = learn_slope_put_m
            s[190] = learn_slope_put_e
        learn_slope_put_m = -s[learn_slope_i]
        learn_slope_put_e = s[learn_slope_i + 1]
        if not learn_slope_put_m:
            s[205] = 0
            s[206] = -4096
        else:
            while learn_slope_put_m < 524288 and learn_slope_put_m >= -524288:
                learn_slope_put_m = learn_slope_put_m << 8
                learn_slope_put_e = learn_slope_put_e - 8
            while learn_slope_put_m < 134217728 and learn_slope_put_m >= -134217728:
                learn_slope_put_m = learn_slope_put_m << 1
                learn_slope_put_e = learn_slope_put_e - 1
            while learn_slope_put_m >= 268435456 or learn_slope_put_m < -268435456:
                learn_slope_put_m = learn_slope_put_m >> 1
                learn_slope_put_e = learn_slope_put_e + 1
            s[205] = learn_slope_put_m
            s[206] = learn_slope_put_e
        multiply(s_, 203, 205, 187)
        pack_slope(s_, learn_slope_d)
        i = i + 1
