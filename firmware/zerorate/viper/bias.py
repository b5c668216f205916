# Generated from zerorate/bias.py by `make viper`: edit that file, not this one.
"""The bias at this temperature: which estimator, line or aggregate speaks for it."""

import micropython


@micropython.viper
def curve_q8(s: ptr32, c: ptr32, a: int, temp: int) -> int:
    s_a = ptr32(int(s) + (a << 2))
    while True:
        s_a[29] = 0
        while True:
            choose_find_half = c[27] >> 1
            choose_find_e = s_a[2]
            if choose_find_e > 0:
                choose_find_d = temp - s[choose_find_e]
                if choose_find_d <= choose_find_half + c[28] and choose_find_d >= 0 - choose_find_half - c[28]:
                    choose_e = choose_find_e
                    break
            choose_find_e = a + c[14]
            choose_find_left = 0
            while choose_find_e < a + c[15]:
                choose_find_d = temp - s[choose_find_e]
                if choose_find_d < choose_find_half and choose_find_d >= 0 - choose_find_half:
                    choose_e = choose_find_e
                    choose_find_left = 1
                    break
                choose_find_e = choose_find_e + c[26]
            if choose_find_left:
                break
            choose_e = 0
            break
        if choose_e > 0:
            choose_e = s[choose_e + 3]
            if choose_e >= c[34] and choose_e >= (s_a[21] >> 8) * c[35]:
                kind = 3
                break
        if s_a[22]:
            choose_e = (temp << 4) + c[36]
            if choose_e < s_a[19]:
                s_a[29] = 1
            choose_e = (temp << 4) - c[36]
            if choose_e > s_a[20]:
                s_a[29] = 1
            kind = 2
            break
        choose_e = s_a[35]
        if choose_e >= c[31] or (choose_e > 0 and (not c[46])):
            kind = 1
            break
        kind = 0
        break
    s_a[30] = kind
    if not kind:
        return 0
    if not kind - 1 or not s_a[22]:
        return s_a[34]
    if not kind - 3 and c[21]:
        while True:
            find_half = c[27] >> 1
            find_e = s_a[2]
            if find_e > 0:
                find_d = temp - s[find_e]
                if find_d <= find_half + c[28] and find_d >= 0 - find_half - c[28]:
                    kind = find_e
                    break
            find_e = a + c[14]
            find_left = 0
            while find_e < a + c[15]:
                find_d = temp - s[find_e]
                if find_d < find_half and find_d >= 0 - find_half:
                    kind = find_e
                    find_left = 1
                    break
                find_e = find_e + c[26]
            if find_left:
                break
            kind = 0
            break
        return s[kind + 2]
    line_q8_temp_q4 = temp << 4
    line_q8_u = line_q8_temp_q4 - s_a[14]
    line_q8_most = 134217727 >> s_a[18]
    if line_q8_u > line_q8_most:
        line_q8_u = line_q8_most
    if line_q8_u < 0 - line_q8_most:
        line_q8_u = 0 - line_q8_most
    line_q8_u = (line_q8_u << s_a[18]) - s_a[15]
    line_q8_scaled_a = s_a[17]
    line_q8_scaled_b = line_q8_u
    line_q8_scaled_high = line_q8_scaled_b >> 15
    line_q8_scaled_b = line_q8_scaled_b & 32767
    line_q8_scaled_middle = (line_q8_scaled_a >> 15) * line_q8_scaled_b + (line_q8_scaled_a & 32767) * line_q8_scaled_high + ((line_q8_scaled_a & 32767) * line_q8_scaled_b >> 15)
    line_q8_scaled_high = (line_q8_scaled_a >> 15) * line_q8_scaled_high
    line_q8_u = (line_q8_scaled_high << 4) + (line_q8_scaled_middle >> 11)
    return s_a[16] + line_q8_u + 4 >> 3
