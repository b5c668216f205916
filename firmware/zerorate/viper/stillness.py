# Generated from zerorate/stillness.py by `make viper`: edit that file, not this one.
"""Still, moving or turning: judged from windows of gyroscope and accelerometer."""

import micropython


@micropython.viper
def begin(s: ptr32, c: ptr32, anchored: int):
    if not anchored:
        s[36] = (s[19] << 4) + (s[26] << 4 >> c[4])
    s[39] = (s[23] << 4) + (s[30] << 4 >> c[4])
    s[42] = 0
    if not anchored:
        s[37] = (s[20] << 4) + (s[27] << 4 >> c[4])
    s[40] = (s[24] << 4) + (s[31] << 4 >> c[4])
    s[43] = 0
    if not anchored:
        s[38] = (s[21] << 4) + (s[28] << 4 >> c[4])
    s[41] = (s[25] << 4) + (s[32] << 4 >> c[4])
    s[44] = 0
    s[45] = 0
    s[48] = 0
    s[34] = 1


@micropython.viper
def judge(s: ptr32, c: ptr32) -> int:
    while True:
        if s[18] > 3:
            state = 2
            break
        if s[18]:
            state = 4
            break
        look_spread_q8_first = 26 + 4
        look_spread_q8_square = s[35]
        look_spread_q8_i = 0
        while look_spread_q8_i < 3:
            look_spread_q8_mean_q4 = s[look_spread_q8_first + look_spread_q8_i] << 4 >> c[4]
            look_spread_q8_square = look_spread_q8_square - (look_spread_q8_mean_q4 * s[look_spread_q8_first + look_spread_q8_i] >> 4)
            look_spread_q8_i = look_spread_q8_i + 1
        if look_spread_q8_square >> 30:
            look_spread_q8_square = 0
        look_noise_q8 = look_spread_q8_square << 8 - c[4]
        if look_noise_q8 > c[7]:
            look_white_spread = look_noise_q8
            look_white_step = s[76] << 8 - c[4]
            look_white_spread = look_white_spread >> 4
            look_white_step = look_white_step >> 4
            if look_white_step > (look_white_spread >> 1) + look_white_spread - (look_white_spread >> 3) and look_white_step < 3 * look_white_spread - (look_white_spread >> 2):
                look_white_result = 1
            else:
                look_white_result = 0
            if not look_white_result:
                state = 2
                break
        look_spread_q8_square = s[33]
        look_spread_q8_i = 0
        while look_spread_q8_i < 3:
            look_spread_q8_mean_q4 = s[26 + look_spread_q8_i] << 4 >> c[4]
            look_spread_q8_square = look_spread_q8_square - (look_spread_q8_mean_q4 * s[26 + look_spread_q8_i] >> 4)
            look_spread_q8_i = look_spread_q8_i + 1
        if look_spread_q8_square >> 30:
            look_spread_q8_square = 0
        look_shake_q8 = look_spread_q8_square << 8 - c[4]
        if look_shake_q8 > c[8]:
            state = 4
            break
        s[49] = (look_noise_q8 - s[49] >> 3) + s[49]
        if not s[34]:
            state = 1
            break
        look_tip_q8_i = 0
        look_tip_q8_square = 0
        while look_tip_q8_i < 3:
            look_tip_q8_d = (s[19 + look_tip_q8_i] << 4) + (s[26 + look_tip_q8_i] << 4 >> c[4]) - s[36 + look_tip_q8_i]
            if look_tip_q8_d > 8191:
                look_tip_q8_d = 8191
            if look_tip_q8_d < -8191:
                look_tip_q8_d = -8191
            look_tip_q8_square = look_tip_q8_d * look_tip_q8_d + look_tip_q8_square
            look_tip_q8_i = look_tip_q8_i + 1
        look_tip_q8_result = look_tip_q8_square
        s[51] = look_tip_q8_result
        if s[51] > (look_shake_q8 >> c[4]) * 6 + c[9]:
            state = 3
            break
        if s[48]:
            look_change_q4_i = 0
            look_change_q4_most = 0
            while look_change_q4_i < 3:
                look_change_q4_d = (s[19 + 4 + look_change_q4_i] << 4) + (s[26 + 4 + look_change_q4_i] << 4 >> c[4]) - s[39 + look_change_q4_i]
                if look_change_q4_d >> 30:
                    look_change_q4_d = -look_change_q4_d
                if look_change_q4_d > look_change_q4_most:
                    look_change_q4_most = look_change_q4_d
                look_change_q4_i = look_change_q4_i + 1
            look_change = look_change_q4_most
            if look_change > 32767:
                state = 5
                break
            if look_change * look_change > (look_noise_q8 >> c[4]) * 14 + c[10]:
                state = 5
                break
        state = 1
        break
        break
    s[46] = state
    s[47] = (s[26 + 3] >> c[4]) + s[19 + 3]
    s[17] = 0
    if not state - 2 or not state - 4:
        s[34] = 0
        return 0
    if state - 1 or not s[34]:
        stillness_begin_i = 0
        while stillness_begin_i < 3:
            if not 0:
                s[36 + stillness_begin_i] = (s[19 + stillness_begin_i] << 4) + (s[26 + stillness_begin_i] << 4 >> c[4])
            s[39 + stillness_begin_i] = (s[19 + 4 + stillness_begin_i] << 4) + (s[26 + 4 + stillness_begin_i] << 4 >> c[4])
            s[42 + stillness_begin_i] = 0
            stillness_begin_i = stillness_begin_i + 1
        s[45] = 0
        s[48] = 0
        s[34] = 1
    elif not s[48]:
        stillness_begin_i = 0
        while stillness_begin_i < 3:
            if not 1:
                s[36 + stillness_begin_i] = (s[19 + stillness_begin_i] << 4) + (s[26 + stillness_begin_i] << 4 >> c[4])
            s[39 + stillness_begin_i] = (s[19 + 4 + stillness_begin_i] << 4) + (s[26 + 4 + stillness_begin_i] << 4 >> c[4])
            s[42 + stillness_begin_i] = 0
            stillness_begin_i = stillness_begin_i + 1
        s[45] = 0
        s[48] = 0
        s[34] = 1
    i = 0
    while i < 3:
        total = s[19 + 4 + i] << c[4]
        total = total - (s[64 + i] + 128 >> 8)
        total = total + s[26 + 4 + i]
        s[42 + i] += total
        i = i + 1
    s[45] = s[45] + s[47]
    s[48] = s[48] + 1
    if s[48] < c[5]:
        return 0
    s[48] = 0
    return 1
