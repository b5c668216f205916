# Generated from zerorate/fit.py by `make viper`: edit that file, not this one.
"""The sample-weighted least-squares line through an axis' estimators, in integers."""

import micropython


@micropython.viper
def add_product(s: ptr32, k: int, p: int, q: int, r: int):
    s_k = ptr32(int(s) + (k << 2))
    if not p or not q or (not r):
        return
    room_value = p
    if room_value >> 30:
        room_value = 0 - room_value
    room_shift = 0
    if not room_value:
        h = 27
    else:
        if room_value < 2048:
            room_value = room_value << 16
            room_shift = 16
        if room_value < 524288:
            room_value = room_value << 8
            room_shift = room_shift + 8
        if room_value < 8388608:
            room_value = room_value << 4
            room_shift = room_shift + 4
        if room_value < 33554432:
            room_value = room_value << 2
            room_shift = room_shift + 2
        if room_value < 67108864:
            room_shift = room_shift + 1
        h = room_shift
    room_value = q
    if room_value >> 30:
        room_value = 0 - room_value
    room_shift = 0
    if not room_value:
        i = 27
    else:
        if room_value < 2048:
            room_value = room_value << 16
            room_shift = 16
        if room_value < 524288:
            room_value = room_value << 8
            room_shift = room_shift + 8
        if room_value < 8388608:
            room_value = room_value << 4
            room_shift = room_shift + 4
        if room_value < 33554432:
            room_value = room_value << 2
            room_shift = room_shift + 2
        if room_value < 67108864:
            room_shift = room_shift + 1
        i = room_shift
    scaled_a = p << h
    scaled_b = q << i
    scaled_high = scaled_b >> 15
    scaled_b = scaled_b & 32767
    scaled_middle = (scaled_a >> 15) * scaled_b + (scaled_a & 32767) * scaled_high + ((scaled_a & 32767) * scaled_b >> 15)
    scaled_high = (scaled_a >> 15) * scaled_high
    p = (scaled_high << 3) + (scaled_middle >> 12)
    h = h + i
    room_value = r
    if room_value >> 30:
        room_value = 0 - room_value
    room_shift = 0
    if not room_value:
        i = 27
    else:
        if room_value < 2048:
            room_value = room_value << 16
            room_shift = 16
        if room_value < 524288:
            room_value = room_value << 8
            room_shift = room_shift + 8
        if room_value < 8388608:
            room_value = room_value << 4
            room_shift = room_shift + 4
        if room_value < 33554432:
            room_value = room_value << 2
            room_shift = room_shift + 2
        if room_value < 67108864:
            room_shift = room_shift + 1
        i = room_shift
    scaled_b = r << i
    scaled_high = scaled_b >> 15
    scaled_b = scaled_b & 32767
    scaled_middle = (p >> 15) * scaled_b + (p & 32767) * scaled_high + ((p & 32767) * scaled_b >> 15)
    scaled_high = (p >> 15) * scaled_high
    p = (scaled_high << 3) + (scaled_middle >> 12)
    h = i - 2 + h
    room_value = p
    if room_value >> 30:
        room_value = 0 - room_value
    room_shift = 0
    if not room_value:
        i = 27
    else:
        if room_value < 2048:
            room_value = room_value << 16
            room_shift = 16
        if room_value < 524288:
            room_value = room_value << 8
            room_shift = room_shift + 8
        if room_value < 8388608:
            room_value = room_value << 4
            room_shift = room_shift + 4
        if room_value < 33554432:
            room_value = room_value << 2
            room_shift = room_shift + 2
        if room_value < 67108864:
            room_shift = room_shift + 1
        i = room_shift
    p = p << i >> 2
    h = h + i
    if not s_k[0]:
        s_k[1] = h
    i = h - s_k[1]
    if not i >> 30:
        p = p >> (i if i < 30 else 30)
    else:
        s_k[0] = s_k[0] >> (0 - i if i > -30 else 30)
        s_k[1] = h
    s_k[0] = s_k[0] + p


@micropython.viper
def settle(s: ptr32, c: ptr32, a: int):
    s_a = ptr32(int(s) + (a << 2))
    s_a[22] = s[91]
    s_a[21] = s[90]
    s_a[14] = s[86]
    s_a[15] = s[80]
    s_a[16] = (s[87] << 3) + s[81]
    slope = s[83] - s[85]
    floating_ratio_q26_a = s[84]
    floating_ratio_q26_b = s[82]
    floating_ratio_q26_exponent = slope
    while True:
        if not floating_ratio_q26_a or floating_ratio_q26_b <= 0:
            slope = 0
            break
        while floating_ratio_q26_a > 134217727 or floating_ratio_q26_a < -134217727:
            floating_ratio_q26_a = floating_ratio_q26_a >> 1
            floating_ratio_q26_exponent = floating_ratio_q26_exponent + 1
        while floating_ratio_q26_b > 134217727:
            floating_ratio_q26_b = floating_ratio_q26_b >> 1
            floating_ratio_q26_exponent = floating_ratio_q26_exponent - 1
        floating_ratio_q26_room_value = floating_ratio_q26_a
        if floating_ratio_q26_room_value >> 30:
            floating_ratio_q26_room_value = 0 - floating_ratio_q26_room_value
        floating_ratio_q26_room_shift = 0
        if not floating_ratio_q26_room_value:
            floating_ratio_q26_shift = 27
        else:
            if floating_ratio_q26_room_value < 2048:
                floating_ratio_q26_room_value = floating_ratio_q26_room_value << 16
                floating_ratio_q26_room_shift = 16
            if floating_ratio_q26_room_value < 524288:
                floating_ratio_q26_room_value = floating_ratio_q26_room_value << 8
                floating_ratio_q26_room_shift = floating_ratio_q26_room_shift + 8
            if floating_ratio_q26_room_value < 8388608:
                floating_ratio_q26_room_value = floating_ratio_q26_room_value << 4
                floating_ratio_q26_room_shift = floating_ratio_q26_room_shift + 4
            if floating_ratio_q26_room_value < 33554432:
                floating_ratio_q26_room_value = floating_ratio_q26_room_value << 2
                floating_ratio_q26_room_shift = floating_ratio_q26_room_shift + 2
            if floating_ratio_q26_room_value < 67108864:
                floating_ratio_q26_room_shift = floating_ratio_q26_room_shift + 1
            floating_ratio_q26_shift = floating_ratio_q26_room_shift
        floating_ratio_q26_a = floating_ratio_q26_a << floating_ratio_q26_shift
        floating_ratio_q26_exponent = floating_ratio_q26_exponent - floating_ratio_q26_shift
        floating_ratio_q26_room_value = floating_ratio_q26_b
        if floating_ratio_q26_room_value >> 30:
            floating_ratio_q26_room_value = 0 - floating_ratio_q26_room_value
        floating_ratio_q26_room_shift = 0
        if not floating_ratio_q26_room_value:
            floating_ratio_q26_shift = 27
        else:
            if floating_ratio_q26_room_value < 2048:
                floating_ratio_q26_room_value = floating_ratio_q26_room_value << 16
                floating_ratio_q26_room_shift = 16
            if floating_ratio_q26_room_value < 524288:
                floating_ratio_q26_room_value = floating_ratio_q26_room_value << 8
                floating_ratio_q26_room_shift = floating_ratio_q26_room_shift + 8
            if floating_ratio_q26_room_value < 8388608:
                floating_ratio_q26_room_value = floating_ratio_q26_room_value << 4
                floating_ratio_q26_room_shift = floating_ratio_q26_room_shift + 4
            if floating_ratio_q26_room_value < 33554432:
                floating_ratio_q26_room_value = floating_ratio_q26_room_value << 2
                floating_ratio_q26_room_shift = floating_ratio_q26_room_shift + 2
            if floating_ratio_q26_room_value < 67108864:
                floating_ratio_q26_room_shift = floating_ratio_q26_room_shift + 1
            floating_ratio_q26_shift = floating_ratio_q26_room_shift
        floating_ratio_q26_b = floating_ratio_q26_b << floating_ratio_q26_shift
        floating_ratio_q26_exponent = floating_ratio_q26_exponent + floating_ratio_q26_shift
        floating_ratio_q26_ratio_q26_a = floating_ratio_q26_a
        floating_ratio_q26_ratio_q26_sign = 1
        if floating_ratio_q26_ratio_q26_a >> 30:
            floating_ratio_q26_ratio_q26_a = -floating_ratio_q26_ratio_q26_a
            floating_ratio_q26_ratio_q26_sign = -1
        if not floating_ratio_q26_b:
            floating_ratio_q26_a = 0
        elif floating_ratio_q26_ratio_q26_a >> 2 >= floating_ratio_q26_b:
            floating_ratio_q26_a = floating_ratio_q26_ratio_q26_sign * 268435455
        else:
            floating_ratio_q26_ratio_q26_q = floating_ratio_q26_ratio_q26_a // floating_ratio_q26_b
            floating_ratio_q26_ratio_q26_a = floating_ratio_q26_ratio_q26_a % floating_ratio_q26_b
            floating_ratio_q26_ratio_q26_i = 0
            while floating_ratio_q26_ratio_q26_i < 26:
                floating_ratio_q26_ratio_q26_a = floating_ratio_q26_ratio_q26_a << 1
                floating_ratio_q26_ratio_q26_q = floating_ratio_q26_ratio_q26_q << 1
                if floating_ratio_q26_ratio_q26_a >= floating_ratio_q26_b:
                    floating_ratio_q26_ratio_q26_a = floating_ratio_q26_ratio_q26_a - floating_ratio_q26_b
                    floating_ratio_q26_ratio_q26_q = floating_ratio_q26_ratio_q26_q + 1
                floating_ratio_q26_ratio_q26_i = floating_ratio_q26_ratio_q26_i + 1
            floating_ratio_q26_a = floating_ratio_q26_ratio_q26_sign * floating_ratio_q26_ratio_q26_q
        floating_ratio_q26_left = 0
        while floating_ratio_q26_exponent > 0:
            if floating_ratio_q26_a > 134217727 or floating_ratio_q26_a < -134217727:
                slope = 268435455 if floating_ratio_q26_a > 0 else -268435455
                floating_ratio_q26_left = 1
                break
            floating_ratio_q26_a = floating_ratio_q26_a << 1
            floating_ratio_q26_exponent = floating_ratio_q26_exponent - 1
        if floating_ratio_q26_left:
            break
        slope = floating_ratio_q26_a >> (0 - floating_ratio_q26_exponent if floating_ratio_q26_exponent > -30 else 30)
        break
    s_a[17] = slope
    fit_stretch_w = s[89] - s[88]
    fit_stretch_room_value = fit_stretch_w
    if fit_stretch_room_value >> 30:
        fit_stretch_room_value = 0 - fit_stretch_room_value
    fit_stretch_room_shift = 0
    if not fit_stretch_room_value:
        fit_stretch_w = 27
    else:
        if fit_stretch_room_value < 2048:
            fit_stretch_room_value = fit_stretch_room_value << 16
            fit_stretch_room_shift = 16
        if fit_stretch_room_value < 524288:
            fit_stretch_room_value = fit_stretch_room_value << 8
            fit_stretch_room_shift = fit_stretch_room_shift + 8
        if fit_stretch_room_value < 8388608:
            fit_stretch_room_value = fit_stretch_room_value << 4
            fit_stretch_room_shift = fit_stretch_room_shift + 4
        if fit_stretch_room_value < 33554432:
            fit_stretch_room_value = fit_stretch_room_value << 2
            fit_stretch_room_shift = fit_stretch_room_shift + 2
        if fit_stretch_room_value < 67108864:
            fit_stretch_room_shift = fit_stretch_room_shift + 1
        fit_stretch_w = fit_stretch_room_shift
    fit_stretch_result = fit_stretch_w - 1
    s_a[18] = fit_stretch_result
    s_a[19] = s[88]
    s_a[20] = s[89]


@micropython.viper
def draw_line(s_, c_, a: int):
    s = ptr32(s_)
    c = ptr32(c_)
    fit_weigh_w = 80
    while fit_weigh_w <= 92:
        s[fit_weigh_w] = 0
        fit_weigh_w = fit_weigh_w + 1
    fit_weigh_i = 93
    fit_weigh_e = a + c[14]
    s_fit_weigh_e = ptr32(int(s) + (fit_weigh_e << 2))
    while fit_weigh_e < a + c[15]:
        fit_weigh_w = 0
        if s_fit_weigh_e[0] - -1048576 and s_fit_weigh_e[3] >= c[31]:
            fit_weigh_w = s_fit_weigh_e[3]
            s[90] = s[90] + fit_weigh_w
            if fit_weigh_w > c[32]:
                fit_weigh_w = c[32]
            if c[33]:
                fit_weigh_d = s_fit_weigh_e[1] - (s[47] << 4) >> c[42]
                if fit_weigh_d > 16383 or fit_weigh_d < -16383:
                    fit_weigh_d = 16383
                fit_weigh_w = fit_weigh_w * c[51] // (fit_weigh_d * fit_weigh_d + c[33]) + 1
            if not s[91]:
                s[86] = s_fit_weigh_e[1]
                s[87] = s_fit_weigh_e[2]
                s[88] = s_fit_weigh_e[1]
                s[89] = s_fit_weigh_e[1]
            if s_fit_weigh_e[1] < s[88]:
                s[88] = s_fit_weigh_e[1]
            if s_fit_weigh_e[1] > s[89]:
                s[89] = s_fit_weigh_e[1]
            s[91] = s[91] + 1
        s[fit_weigh_i] = fit_weigh_w
        s[92] = s[92] + fit_weigh_w
        fit_weigh_i = fit_weigh_i + 1
        fit_weigh_e = fit_weigh_e + c[26]
        s_fit_weigh_e = ptr32(int(s) + (fit_weigh_e << 2))
    i = 1
    while i < c[25]:
        fit_centre_a = a
        fit_centre_w = s[i + 92]
        if not fit_centre_w:
            pass
        else:
            fit_centre_d = s[92]
            fit_centre_fraction_q27_a = fit_centre_w
            fit_centre_fraction_q27_q = 0
            fit_centre_fraction_q27_a = fit_centre_fraction_q27_a << 9
            fit_centre_fraction_q27_q = fit_centre_fraction_q27_a // fit_centre_d
            fit_centre_fraction_q27_a = fit_centre_fraction_q27_a % fit_centre_d
            fit_centre_fraction_q27_a = fit_centre_fraction_q27_a << 9
            fit_centre_fraction_q27_q = (fit_centre_fraction_q27_q << 9) + fit_centre_fraction_q27_a // fit_centre_d
            fit_centre_fraction_q27_a = fit_centre_fraction_q27_a % fit_centre_d
            fit_centre_fraction_q27_a = fit_centre_fraction_q27_a << 9
            fit_centre_fraction_q27_q = (fit_centre_fraction_q27_q << 9) + fit_centre_fraction_q27_a // fit_centre_d
            fit_centre_fraction_q27_a = fit_centre_fraction_q27_a % fit_centre_d
            fit_centre_w = fit_centre_fraction_q27_q
            fit_centre_a = i * c[26] + 32 + fit_centre_a
            fit_centre_d = s[fit_centre_a + 1]
            if fit_centre_d < s[88]:
                fit_centre_fit_within_result = s[88]
            elif fit_centre_d > s[89]:
                fit_centre_fit_within_result = s[89]
            else:
                fit_centre_fit_within_result = fit_centre_d
            fit_centre_d = fit_centre_fit_within_result - s[86]
            fit_centre_fit_stretch_w = s[89] - s[88]
            fit_centre_fit_stretch_room_value = fit_centre_fit_stretch_w
            if fit_centre_fit_stretch_room_value >> 30:
                fit_centre_fit_stretch_room_value = 0 - fit_centre_fit_stretch_room_value
            fit_centre_fit_stretch_room_shift = 0
            if not fit_centre_fit_stretch_room_value:
                fit_centre_fit_stretch_w = 27
            else:
                if fit_centre_fit_stretch_room_value < 2048:
                    fit_centre_fit_stretch_room_value = fit_centre_fit_stretch_room_value << 16
                    fit_centre_fit_stretch_room_shift = 16
                if fit_centre_fit_stretch_room_value < 524288:
                    fit_centre_fit_stretch_room_value = fit_centre_fit_stretch_room_value << 8
                    fit_centre_fit_stretch_room_shift = fit_centre_fit_stretch_room_shift + 8
                if fit_centre_fit_stretch_room_value < 8388608:
                    fit_centre_fit_stretch_room_value = fit_centre_fit_stretch_room_value << 4
                    fit_centre_fit_stretch_room_shift = fit_centre_fit_stretch_room_shift + 4
                if fit_centre_fit_stretch_room_value < 33554432:
                    fit_centre_fit_stretch_room_value = fit_centre_fit_stretch_room_value << 2
                    fit_centre_fit_stretch_room_shift = fit_centre_fit_stretch_room_shift + 2
                if fit_centre_fit_stretch_room_value < 67108864:
                    fit_centre_fit_stretch_room_shift = fit_centre_fit_stretch_room_shift + 1
                fit_centre_fit_stretch_w = fit_centre_fit_stretch_room_shift
            fit_centre_fit_stretch_result = fit_centre_fit_stretch_w - 1
            fit_centre_d = fit_centre_d << fit_centre_fit_stretch_result
            fit_centre_scaled_b = fit_centre_d
            fit_centre_scaled_high = fit_centre_scaled_b >> 15
            fit_centre_scaled_b = fit_centre_scaled_b & 32767
            fit_centre_scaled_middle = (fit_centre_w >> 15) * fit_centre_scaled_b + (fit_centre_w & 32767) * fit_centre_scaled_high + ((fit_centre_w & 32767) * fit_centre_scaled_b >> 15)
            fit_centre_scaled_high = (fit_centre_w >> 15) * fit_centre_scaled_high
            fit_centre_d = (fit_centre_scaled_high << 3) + (fit_centre_scaled_middle >> 12)
            s[80] = s[80] + fit_centre_d
            fit_centre_d = s[fit_centre_a + 2] - s[87]
            fit_centre_scaled_b = fit_centre_d << 3
            fit_centre_scaled_high = fit_centre_scaled_b >> 15
            fit_centre_scaled_b = fit_centre_scaled_b & 32767
            fit_centre_scaled_middle = (fit_centre_w >> 15) * fit_centre_scaled_b + (fit_centre_w & 32767) * fit_centre_scaled_high + ((fit_centre_w & 32767) * fit_centre_scaled_b >> 15)
            fit_centre_scaled_high = (fit_centre_w >> 15) * fit_centre_scaled_high
            fit_centre_d = (fit_centre_scaled_high << 3) + (fit_centre_scaled_middle >> 12)
            s[81] = s[81] + fit_centre_d
        i = i + 1
    i = 1
    while i < c[25]:
        lean_a = a
        lean_i = i
        lean_w = s[lean_i + 92]
        if not lean_w:
            pass
        else:
            lean_a = lean_i * c[26] + 32 + lean_a
            lean_i = s[lean_a + 1]
            if lean_i < s[88]:
                lean_fit_within_result = s[88]
            elif lean_i > s[89]:
                lean_fit_within_result = s[89]
            else:
                lean_fit_within_result = lean_i
            lean_i = lean_fit_within_result - s[86]
            lean_fit_stretch_w = s[89] - s[88]
            lean_fit_stretch_room_value = lean_fit_stretch_w
            if lean_fit_stretch_room_value >> 30:
                lean_fit_stretch_room_value = 0 - lean_fit_stretch_room_value
            lean_fit_stretch_room_shift = 0
            if not lean_fit_stretch_room_value:
                lean_fit_stretch_w = 27
            else:
                if lean_fit_stretch_room_value < 2048:
                    lean_fit_stretch_room_value = lean_fit_stretch_room_value << 16
                    lean_fit_stretch_room_shift = 16
                if lean_fit_stretch_room_value < 524288:
                    lean_fit_stretch_room_value = lean_fit_stretch_room_value << 8
                    lean_fit_stretch_room_shift = lean_fit_stretch_room_shift + 8
                if lean_fit_stretch_room_value < 8388608:
                    lean_fit_stretch_room_value = lean_fit_stretch_room_value << 4
                    lean_fit_stretch_room_shift = lean_fit_stretch_room_shift + 4
                if lean_fit_stretch_room_value < 33554432:
                    lean_fit_stretch_room_value = lean_fit_stretch_room_value << 2
                    lean_fit_stretch_room_shift = lean_fit_stretch_room_shift + 2
                if lean_fit_stretch_room_value < 67108864:
                    lean_fit_stretch_room_shift = lean_fit_stretch_room_shift + 1
                lean_fit_stretch_w = lean_fit_stretch_room_shift
            lean_fit_stretch_result = lean_fit_stretch_w - 1
            lean_i = (lean_i << lean_fit_stretch_result) - s[80]
            lean_a = (s[lean_a + 2] - s[87] << 3) - s[81]
            add_product(s_, 82, lean_w, lean_i, lean_i)
            add_product(s_, 84, lean_w, lean_i, lean_a)
        i = i + 1
    settle(s_, c_, a)
