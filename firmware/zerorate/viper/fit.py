# Generated from zerorate/fit.py by `make viper`: edit that file, not this one.
"""The sample-weighted least-squares line through an axis' estimators, in integers."""

import micropython

from .fixed import room


@micropython.viper
def lean(s: ptr32, i: int, a: int, c: ptr32):
    w = s[i + 92]
    a = i * c[26] + 32 + a
    i = s[a + 1]
    if i < s[88]:
        fit_within_result = s[88]
    elif i > s[89]:
        fit_within_result = s[89]
    else:
        fit_within_result = i
    i = fit_within_result - s[86]
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
    i = (i << fit_stretch_result) - s[80]
    a = (s[a + 2] - s[87] << 3) - s[81]
    room_value = w
    if room_value >> 30:
        room_value = 0 - room_value
    room_shift = 0
    if not room_value:
        k = 27
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
        k = room_shift
    scaled_a = w << k
    scaled_b = i << int(room(i))
    scaled_high = scaled_b >> 15
    scaled_b = scaled_b & 32767
    scaled_middle = (scaled_a >> 15) * scaled_b + (scaled_a & 32767) * scaled_high + ((scaled_a & 32767) * scaled_b >> 15)
    scaled_high = (scaled_a >> 15) * scaled_high
    w = (scaled_high << 3) + (scaled_middle >> 12)
    room_value = i
    if room_value >> 30:
        room_value = 0 - room_value
    room_shift = 0
    if not room_value:
        room_result = 27
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
        room_result = room_shift
    k = (k + room_result << 7) + 82
    add_product_k = k
    s_add_product_k = ptr32(int(s) + (add_product_k << 2))
    add_product_p = w
    add_product_h = add_product_k >> 7
    add_product_k = add_product_k & 127
    s_add_product_k = ptr32(int(s) + (add_product_k << 2))
    if not add_product_p or not i:
        pass
    else:
        add_product_room_value = i
        if add_product_room_value >> 30:
            add_product_room_value = 0 - add_product_room_value
        add_product_room_shift = 0
        if not add_product_room_value:
            add_product_i = 27
        else:
            if add_product_room_value < 2048:
                add_product_room_value = add_product_room_value << 16
                add_product_room_shift = 16
            if add_product_room_value < 524288:
                add_product_room_value = add_product_room_value << 8
                add_product_room_shift = add_product_room_shift + 8
            if add_product_room_value < 8388608:
                add_product_room_value = add_product_room_value << 4
                add_product_room_shift = add_product_room_shift + 4
            if add_product_room_value < 33554432:
                add_product_room_value = add_product_room_value << 2
                add_product_room_shift = add_product_room_shift + 2
            if add_product_room_value < 67108864:
                add_product_room_shift = add_product_room_shift + 1
            add_product_i = add_product_room_shift
        add_product_scaled_b = i << add_product_i
        add_product_scaled_high = add_product_scaled_b >> 15
        add_product_scaled_b = add_product_scaled_b & 32767
        add_product_scaled_middle = (add_product_p >> 15) * add_product_scaled_b + (add_product_p & 32767) * add_product_scaled_high + ((add_product_p & 32767) * add_product_scaled_b >> 15)
        add_product_scaled_high = (add_product_p >> 15) * add_product_scaled_high
        add_product_p = (add_product_scaled_high << 3) + (add_product_scaled_middle >> 12)
        add_product_h = add_product_i - 2 + add_product_h
        add_product_room_value = add_product_p
        if add_product_room_value >> 30:
            add_product_room_value = 0 - add_product_room_value
        add_product_room_shift = 0
        if not add_product_room_value:
            add_product_i = 27
        else:
            if add_product_room_value < 2048:
                add_product_room_value = add_product_room_value << 16
                add_product_room_shift = 16
            if add_product_room_value < 524288:
                add_product_room_value = add_product_room_value << 8
                add_product_room_shift = add_product_room_shift + 8
            if add_product_room_value < 8388608:
                add_product_room_value = add_product_room_value << 4
                add_product_room_shift = add_product_room_shift + 4
            if add_product_room_value < 33554432:
                add_product_room_value = add_product_room_value << 2
                add_product_room_shift = add_product_room_shift + 2
            if add_product_room_value < 67108864:
                add_product_room_shift = add_product_room_shift + 1
            add_product_i = add_product_room_shift
        add_product_p = add_product_p << add_product_i >> 2
        add_product_h = add_product_h + add_product_i
        if not s_add_product_k[0]:
            s_add_product_k[1] = add_product_h
        add_product_i = add_product_h - s_add_product_k[1]
        if not add_product_i >> 30:
            add_product_p = add_product_p >> (add_product_i if add_product_i < 30 else 30)
        else:
            s_add_product_k[0] = s_add_product_k[0] >> (0 - add_product_i if add_product_i > -30 else 30)
            s_add_product_k[1] = add_product_h
        s_add_product_k[0] = s_add_product_k[0] + add_product_p
    add_product_k = k + 2
    s_add_product_k = ptr32(int(s) + (add_product_k << 2))
    add_product_p = w
    add_product_h = add_product_k >> 7
    add_product_k = add_product_k & 127
    s_add_product_k = ptr32(int(s) + (add_product_k << 2))
    if not add_product_p or not a:
        pass
    else:
        add_product_room_value = a
        if add_product_room_value >> 30:
            add_product_room_value = 0 - add_product_room_value
        add_product_room_shift = 0
        if not add_product_room_value:
            add_product_i = 27
        else:
            if add_product_room_value < 2048:
                add_product_room_value = add_product_room_value << 16
                add_product_room_shift = 16
            if add_product_room_value < 524288:
                add_product_room_value = add_product_room_value << 8
                add_product_room_shift = add_product_room_shift + 8
            if add_product_room_value < 8388608:
                add_product_room_value = add_product_room_value << 4
                add_product_room_shift = add_product_room_shift + 4
            if add_product_room_value < 33554432:
                add_product_room_value = add_product_room_value << 2
                add_product_room_shift = add_product_room_shift + 2
            if add_product_room_value < 67108864:
                add_product_room_shift = add_product_room_shift + 1
            add_product_i = add_product_room_shift
        add_product_scaled_b = a << add_product_i
        add_product_scaled_high = add_product_scaled_b >> 15
        add_product_scaled_b = add_product_scaled_b & 32767
        add_product_scaled_middle = (add_product_p >> 15) * add_product_scaled_b + (add_product_p & 32767) * add_product_scaled_high + ((add_product_p & 32767) * add_product_scaled_b >> 15)
        add_product_scaled_high = (add_product_p >> 15) * add_product_scaled_high
        add_product_p = (add_product_scaled_high << 3) + (add_product_scaled_middle >> 12)
        add_product_h = add_product_i - 2 + add_product_h
        add_product_room_value = add_product_p
        if add_product_room_value >> 30:
            add_product_room_value = 0 - add_product_room_value
        add_product_room_shift = 0
        if not add_product_room_value:
            add_product_i = 27
        else:
            if add_product_room_value < 2048:
                add_product_room_value = add_product_room_value << 16
                add_product_room_shift = 16
            if add_product_room_value < 524288:
                add_product_room_value = add_product_room_value << 8
                add_product_room_shift = add_product_room_shift + 8
            if add_product_room_value < 8388608:
                add_product_room_value = add_product_room_value << 4
                add_product_room_shift = add_product_room_shift + 4
            if add_product_room_value < 33554432:
                add_product_room_value = add_product_room_value << 2
                add_product_room_shift = add_product_room_shift + 2
            if add_product_room_value < 67108864:
                add_product_room_shift = add_product_room_shift + 1
            add_product_i = add_product_room_shift
        add_product_p = add_product_p << add_product_i >> 2
        add_product_h = add_product_h + add_product_i
        if not s_add_product_k[0]:
            s_add_product_k[1] = add_product_h
        add_product_i = add_product_h - s_add_product_k[1]
        if not add_product_i >> 30:
            add_product_p = add_product_p >> (add_product_i if add_product_i < 30 else 30)
        else:
            s_add_product_k[0] = s_add_product_k[0] >> (0 - add_product_i if add_product_i > -30 else 30)
            s_add_product_k[1] = add_product_h
        s_add_product_k[0] = s_add_product_k[0] + add_product_p


@micropython.viper
def draw_line(settle_floating_ratio_q26_a: int, settle_floating_ratio_q26_exponent: int, settle_floating_ratio_q26_b: int, s: ptr32, c: ptr32, a: int, s_, c_):
    s_a = ptr32(int(s) + (a << 2))
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
        if s[i + 92]:
            lean(s_, i, a, c_)
        i = i + 1
    s_a[22] = s[91]
    s_a[21] = s[90]
    s_a[14] = s[86]
    s_a[15] = s[80]
    s_a[16] = (s[87] << 3) + s[81]
    settle_slope = s[83] - s[85]
    settle_floating_ratio_q26_a = s[84]
    settle_floating_ratio_q26_b = s[82]
    settle_floating_ratio_q26_exponent = settle_slope
    while True:
        if not settle_floating_ratio_q26_a or settle_floating_ratio_q26_b <= 0:
            settle_slope = 0
            break
        while settle_floating_ratio_q26_a > 134217727 or settle_floating_ratio_q26_a < -134217727:
            settle_floating_ratio_q26_a = settle_floating_ratio_q26_a >> 1
            settle_floating_ratio_q26_exponent = settle_floating_ratio_q26_exponent + 1
        while settle_floating_ratio_q26_b > 134217727:
            settle_floating_ratio_q26_b = settle_floating_ratio_q26_b >> 1
            settle_floating_ratio_q26_exponent = settle_floating_ratio_q26_exponent - 1
        settle_floating_ratio_q26_room_value = settle_floating_ratio_q26_a
        if settle_floating_ratio_q26_room_value >> 30:
            settle_floating_ratio_q26_room_value = 0 - settle_floating_ratio_q26_room_value
        settle_floating_ratio_q26_room_shift = 0
        if not settle_floating_ratio_q26_room_value:
            settle_floating_ratio_q26_shift = 27
        else:
            if settle_floating_ratio_q26_room_value < 2048:
                settle_floating_ratio_q26_room_value = settle_floating_ratio_q26_room_value << 16
                settle_floating_ratio_q26_room_shift = 16
            if settle_floating_ratio_q26_room_value < 524288:
                settle_floating_ratio_q26_room_value = settle_floating_ratio_q26_room_value << 8
                settle_floating_ratio_q26_room_shift = settle_floating_ratio_q26_room_shift + 8
            if settle_floating_ratio_q26_room_value < 8388608:
                settle_floating_ratio_q26_room_value = settle_floating_ratio_q26_room_value << 4
                settle_floating_ratio_q26_room_shift = settle_floating_ratio_q26_room_shift + 4
            if settle_floating_ratio_q26_room_value < 33554432:
                settle_floating_ratio_q26_room_value = settle_floating_ratio_q26_room_value << 2
                settle_floating_ratio_q26_room_shift = settle_floating_ratio_q26_room_shift + 2
            if settle_floating_ratio_q26_room_value < 67108864:
                settle_floating_ratio_q26_room_shift = settle_floating_ratio_q26_room_shift + 1
            settle_floating_ratio_q26_shift = settle_floating_ratio_q26_room_shift
        settle_floating_ratio_q26_a = settle_floating_ratio_q26_a << settle_floating_ratio_q26_shift
        settle_floating_ratio_q26_exponent = settle_floating_ratio_q26_exponent - settle_floating_ratio_q26_shift
        settle_floating_ratio_q26_room_value = settle_floating_ratio_q26_b
        if settle_floating_ratio_q26_room_value >> 30:
            settle_floating_ratio_q26_room_value = 0 - settle_floating_ratio_q26_room_value
        settle_floating_ratio_q26_room_shift = 0
        if not settle_floating_ratio_q26_room_value:
            settle_floating_ratio_q26_shift = 27
        else:
            if settle_floating_ratio_q26_room_value < 2048:
                settle_floating_ratio_q26_room_value = settle_floating_ratio_q26_room_value << 16
                settle_floating_ratio_q26_room_shift = 16
            if settle_floating_ratio_q26_room_value < 524288:
                settle_floating_ratio_q26_room_value = settle_floating_ratio_q26_room_value << 8
                settle_floating_ratio_q26_room_shift = settle_floating_ratio_q26_room_shift + 8
            if settle_floating_ratio_q26_room_value < 8388608:
                settle_floating_ratio_q26_room_value = settle_floating_ratio_q26_room_value << 4
                settle_floating_ratio_q26_room_shift = settle_floating_ratio_q26_room_shift + 4
            if settle_floating_ratio_q26_room_value < 33554432:
                settle_floating_ratio_q26_room_value = settle_floating_ratio_q26_room_value << 2
                settle_floating_ratio_q26_room_shift = settle_floating_ratio_q26_room_shift + 2
            if settle_floating_ratio_q26_room_value < 67108864:
                settle_floating_ratio_q26_room_shift = settle_floating_ratio_q26_room_shift + 1
            settle_floating_ratio_q26_shift = settle_floating_ratio_q26_room_shift
        settle_floating_ratio_q26_b = settle_floating_ratio_q26_b << settle_floating_ratio_q26_shift
        settle_floating_ratio_q26_exponent = settle_floating_ratio_q26_exponent + settle_floating_ratio_q26_shift
        settle_floating_ratio_q26_ratio_q26_a = settle_floating_ratio_q26_a
        settle_floating_ratio_q26_ratio_q26_sign = 1
        if settle_floating_ratio_q26_ratio_q26_a >> 30:
            settle_floating_ratio_q26_ratio_q26_a = -settle_floating_ratio_q26_ratio_q26_a
            settle_floating_ratio_q26_ratio_q26_sign = -1
        if not settle_floating_ratio_q26_b:
            settle_floating_ratio_q26_a = 0
        elif settle_floating_ratio_q26_ratio_q26_a >> 2 >= settle_floating_ratio_q26_b:
            settle_floating_ratio_q26_a = settle_floating_ratio_q26_ratio_q26_sign * 268435455
        else:
            settle_floating_ratio_q26_ratio_q26_q = settle_floating_ratio_q26_ratio_q26_a // settle_floating_ratio_q26_b
            settle_floating_ratio_q26_ratio_q26_a = settle_floating_ratio_q26_ratio_q26_a % settle_floating_ratio_q26_b
            settle_floating_ratio_q26_ratio_q26_i = 0
            while settle_floating_ratio_q26_ratio_q26_i < 26:
                settle_floating_ratio_q26_ratio_q26_a = settle_floating_ratio_q26_ratio_q26_a << 1
                settle_floating_ratio_q26_ratio_q26_q = settle_floating_ratio_q26_ratio_q26_q << 1
                if settle_floating_ratio_q26_ratio_q26_a >= settle_floating_ratio_q26_b:
                    settle_floating_ratio_q26_ratio_q26_a = settle_floating_ratio_q26_ratio_q26_a - settle_floating_ratio_q26_b
                    settle_floating_ratio_q26_ratio_q26_q = settle_floating_ratio_q26_ratio_q26_q + 1
                settle_floating_ratio_q26_ratio_q26_i = settle_floating_ratio_q26_ratio_q26_i + 1
            settle_floating_ratio_q26_a = settle_floating_ratio_q26_ratio_q26_sign * settle_floating_ratio_q26_ratio_q26_q
        settle_floating_ratio_q26_left = 0
        while settle_floating_ratio_q26_exponent > 0:
            if settle_floating_ratio_q26_a > 134217727 or settle_floating_ratio_q26_a < -134217727:
                settle_slope = 268435455 if settle_floating_ratio_q26_a > 0 else -268435455
                settle_floating_ratio_q26_left = 1
                break
            settle_floating_ratio_q26_a = settle_floating_ratio_q26_a << 1
            settle_floating_ratio_q26_exponent = settle_floating_ratio_q26_exponent - 1
        if settle_floating_ratio_q26_left:
            break
        settle_slope = settle_floating_ratio_q26_a >> (0 - settle_floating_ratio_q26_exponent if settle_floating_ratio_q26_exponent > -30 else 30)
        break
    s_a[17] = settle_slope
    settle_fit_stretch_w = s[89] - s[88]
    settle_fit_stretch_room_value = settle_fit_stretch_w
    if settle_fit_stretch_room_value >> 30:
        settle_fit_stretch_room_value = 0 - settle_fit_stretch_room_value
    settle_fit_stretch_room_shift = 0
    if not settle_fit_stretch_room_value:
        settle_fit_stretch_w = 27
    else:
        if settle_fit_stretch_room_value < 2048:
            settle_fit_stretch_room_value = settle_fit_stretch_room_value << 16
            settle_fit_stretch_room_shift = 16
        if settle_fit_stretch_room_value < 524288:
            settle_fit_stretch_room_value = settle_fit_stretch_room_value << 8
            settle_fit_stretch_room_shift = settle_fit_stretch_room_shift + 8
        if settle_fit_stretch_room_value < 8388608:
            settle_fit_stretch_room_value = settle_fit_stretch_room_value << 4
            settle_fit_stretch_room_shift = settle_fit_stretch_room_shift + 4
        if settle_fit_stretch_room_value < 33554432:
            settle_fit_stretch_room_value = settle_fit_stretch_room_value << 2
            settle_fit_stretch_room_shift = settle_fit_stretch_room_shift + 2
        if settle_fit_stretch_room_value < 67108864:
            settle_fit_stretch_room_shift = settle_fit_stretch_room_shift + 1
        settle_fit_stretch_w = settle_fit_stretch_room_shift
    settle_fit_stretch_result = settle_fit_stretch_w - 1
    s_a[18] = settle_fit_stretch_result
    s_a[19] = s[88]
    s_a[20] = s[89]
