# Generated from zerorate/effect_inputs.py by `make viper`: edit that file, not this one.
"""The sources of the effect slots: means over a tick of what the samples and the application say.

A source's value is in Q8 of its integer. Words of an input: docs/layout.md."""

import micropython


@micropython.viper
def accumulate(e: ptr32, x: ptr32):
    a = 32
    e_a = ptr32(int(e) + (a << 2))
    end = 6 * e[1] + 32
    while a < end:
        v = e_a[0]
        if v >= 16:
            extra_v = e[e_a[0] + 88]
            if not extra_v - -1073741823:
                v = -1073741823
            else:
                if extra_v > 536870911:
                    extra_v = 536870911
                elif extra_v < -536870911:
                    extra_v = -536870911
                extra_v = extra_v - e_a[2]
                extra_left = 0 - e_a[1]
                if extra_left >> 30:
                    extra_v = extra_v >> 0 - extra_left
                    extra_left = 0
                if extra_v > 32767 >> extra_left:
                    extra_v = 32767 >> extra_left
                elif extra_v < -(32768 >> extra_left):
                    extra_v = -(32768 >> extra_left)
                v = extra_v << extra_left
        elif v >= 10:
            e_a[5] = x[(v - 6) % 7] << 8
            v = -1073741823
        elif v < 7:
            v = x[v]
        elif not v - 7:
            shake_total = 0
            shake_d = x[0] << 8
            shake_slow = e[20] if e[25] else shake_d
            shake_slow = (shake_d - shake_slow + 16 >> 5) + shake_slow
            e[20] = shake_slow
            shake_d = shake_d - shake_slow + 128 >> 8
            if shake_d > 18900 or shake_d < -18900:
                shake_d = 18900
            shake_total = shake_d * shake_d + shake_total
            shake_d = x[1] << 8
            shake_slow = e[21] if e[25] else shake_d
            shake_slow = (shake_d - shake_slow + 16 >> 5) + shake_slow
            e[21] = shake_slow
            shake_d = shake_d - shake_slow + 128 >> 8
            if shake_d > 18900 or shake_d < -18900:
                shake_d = 18900
            shake_total = shake_d * shake_d + shake_total
            shake_d = x[2] << 8
            shake_slow = e[22] if e[25] else shake_d
            shake_slow = (shake_d - shake_slow + 16 >> 5) + shake_slow
            e[22] = shake_slow
            shake_d = shake_d - shake_slow + 128 >> 8
            if shake_d > 18900 or shake_d < -18900:
                shake_d = 18900
            shake_total = shake_d * shake_d + shake_total
            e[25] = 1
            e[23] = (shake_total & 32767) + e[23]
            e[24] = (shake_total >> 15) + e[24]
            v = 0
        else:
            v = -1073741823
        if v - -1073741823 and e_a[4] < 16383:
            e_a[3] = e_a[3] + v
            e_a[4] = e_a[4] + 1
        a = a + 6
        e_a = ptr32(int(e_a) + 24)


@micropython.viper
def close_tick(e: ptr32):
    a = 32
    e_a = ptr32(int(e) + (a << 2))
    end = 6 * e[1] + 32
    while a < end:
        if e_a[4]:
            if not e_a[0] - 7:
                mean_square_q8_n = e_a[4]
                mean_square_q8_shift = e_a[1]
                mean_square_q8_low = (e[24] % mean_square_q8_n << 15) + e[23]
                mean_square_q8_mean = (e[24] // mean_square_q8_n << 15) + mean_square_q8_low // mean_square_q8_n
                e[23] = 0
                e[24] = 0
                if mean_square_q8_mean >> mean_square_q8_shift > 32767:
                    mean_square_q8_result = 8388607
                elif mean_square_q8_shift >= 8:
                    mean_square_q8_result = mean_square_q8_mean >> mean_square_q8_shift - 8
                else:
                    mean_square_q8_result = (mean_square_q8_mean << 8 - mean_square_q8_shift) + ((mean_square_q8_low % mean_square_q8_n << 8) // mean_square_q8_n >> mean_square_q8_shift)
                e_a[5] = mean_square_q8_result
            else:
                effect_inputs_mean_q8_total = e_a[3]
                effect_inputs_mean_q8_n = e_a[4]
                effect_inputs_mean_q8_sign = 1
                if effect_inputs_mean_q8_total >> 30:
                    effect_inputs_mean_q8_total = -effect_inputs_mean_q8_total
                    effect_inputs_mean_q8_sign = -1
                effect_inputs_mean_q8_result = ((effect_inputs_mean_q8_total // effect_inputs_mean_q8_n << 8) + ((effect_inputs_mean_q8_total % effect_inputs_mean_q8_n << 8) + (effect_inputs_mean_q8_n >> 1)) // effect_inputs_mean_q8_n) * effect_inputs_mean_q8_sign
                e_a[5] = effect_inputs_mean_q8_result
        e_a[3] = 0
        e_a[4] = 0
        a = a + 6
        e_a = ptr32(int(e_a) + 24)
