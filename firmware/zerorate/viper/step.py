# Generated from zerorate/step.py by `make viper`: edit that file, not this one.
"""One sample's way through the firmware, and the work that a full window leaves behind."""

import micropython

from .estimators import feed
from .estimators import learn_here
from .fit import draw_line
from .guard import all_alike
from .recent import absorb
from .recent import hand_over


@micropython.viper
def publish(curve_q8_choose_find_e: int, c: ptr32, curve_q8_choose_find_d: int, a: int, s: ptr32, axis: int):
    s_a = ptr32(int(s) + (a << 2))
    s_axis = ptr32(int(s) + (axis << 2))
    curve_q8_temp = s[47]
    while True:
        s_a[29] = 0
        while True:
            curve_q8_choose_find_half = c[27] >> 1
            curve_q8_choose_find_e = s_a[2]
            if curve_q8_choose_find_e > 0:
                curve_q8_choose_find_d = curve_q8_temp - s[curve_q8_choose_find_e]
                if curve_q8_choose_find_d <= curve_q8_choose_find_half + c[28] and curve_q8_choose_find_d >= 0 - curve_q8_choose_find_half - c[28]:
                    curve_q8_choose_e = curve_q8_choose_find_e
                    break
            curve_q8_choose_find_e = a + c[14]
            curve_q8_choose_find_left = 0
            while curve_q8_choose_find_e < a + c[15]:
                curve_q8_choose_find_d = curve_q8_temp - s[curve_q8_choose_find_e]
                if curve_q8_choose_find_d < curve_q8_choose_find_half and curve_q8_choose_find_d >= 0 - curve_q8_choose_find_half:
                    curve_q8_choose_e = curve_q8_choose_find_e
                    curve_q8_choose_find_left = 1
                    break
                curve_q8_choose_find_e = curve_q8_choose_find_e + c[26]
            if curve_q8_choose_find_left:
                break
            curve_q8_choose_e = 0
            break
        if curve_q8_choose_e > 0:
            curve_q8_choose_e = s[curve_q8_choose_e + 3]
            if curve_q8_choose_e >= c[34] and curve_q8_choose_e >= (s_a[21] >> 8) * c[35]:
                curve_q8_kind = 3
                break
        if s_a[22]:
            curve_q8_choose_e = (curve_q8_temp << 4) + c[36]
            if curve_q8_choose_e < s_a[19]:
                s_a[29] = 1
            curve_q8_choose_e = (curve_q8_temp << 4) - c[36]
            if curve_q8_choose_e > s_a[20]:
                s_a[29] = 1
            curve_q8_kind = 2
            break
        curve_q8_choose_e = s_a[35]
        if curve_q8_choose_e >= c[31] or (curve_q8_choose_e > 0 and (not c[46])):
            curve_q8_kind = 1
            break
        curve_q8_kind = 0
        break
    if not curve_q8_kind - 3 and (not c[21]) and s_a[22]:
        curve_q8_kind = 2
    s_a[30] = curve_q8_kind
    if not curve_q8_kind:
        curve_q8_result = 0
    elif not curve_q8_kind - 3:
        while True:
            curve_q8_find_half = c[27] >> 1
            curve_q8_find_e = s_a[2]
            if curve_q8_find_e > 0:
                curve_q8_find_d = curve_q8_temp - s[curve_q8_find_e]
                if curve_q8_find_d <= curve_q8_find_half + c[28] and curve_q8_find_d >= 0 - curve_q8_find_half - c[28]:
                    curve_q8_kind = curve_q8_find_e
                    break
            curve_q8_find_e = a + c[14]
            curve_q8_find_left = 0
            while curve_q8_find_e < a + c[15]:
                curve_q8_find_d = curve_q8_temp - s[curve_q8_find_e]
                if curve_q8_find_d < curve_q8_find_half and curve_q8_find_d >= 0 - curve_q8_find_half:
                    curve_q8_kind = curve_q8_find_e
                    curve_q8_find_left = 1
                    break
                curve_q8_find_e = curve_q8_find_e + c[26]
            if curve_q8_find_left:
                break
            curve_q8_kind = 0
            break
        curve_q8_result = s[curve_q8_kind + 2]
    elif not curve_q8_kind - 1:
        curve_q8_result = s_a[34]
    else:
        curve_q8_line_q8_temp_q4 = curve_q8_temp << 4
        curve_q8_line_q8_u = curve_q8_line_q8_temp_q4 - s_a[14]
        curve_q8_line_q8_most = 134217727 >> s_a[18]
        if curve_q8_line_q8_u > curve_q8_line_q8_most:
            curve_q8_line_q8_u = curve_q8_line_q8_most
        if curve_q8_line_q8_u < 0 - curve_q8_line_q8_most:
            curve_q8_line_q8_u = 0 - curve_q8_line_q8_most
        curve_q8_line_q8_u = (curve_q8_line_q8_u << s_a[18]) - s_a[15]
        curve_q8_line_q8_scaled_a = s_a[17]
        curve_q8_line_q8_scaled_b = curve_q8_line_q8_u
        curve_q8_line_q8_scaled_high = curve_q8_line_q8_scaled_b >> 15
        curve_q8_line_q8_scaled_b = curve_q8_line_q8_scaled_b & 32767
        curve_q8_line_q8_scaled_middle = (curve_q8_line_q8_scaled_a >> 15) * curve_q8_line_q8_scaled_b + (curve_q8_line_q8_scaled_a & 32767) * curve_q8_line_q8_scaled_high + ((curve_q8_line_q8_scaled_a & 32767) * curve_q8_line_q8_scaled_b >> 15)
        curve_q8_line_q8_scaled_high = (curve_q8_line_q8_scaled_a >> 15) * curve_q8_line_q8_scaled_high
        curve_q8_line_q8_u = (curve_q8_line_q8_scaled_high << 4) + (curve_q8_line_q8_scaled_middle >> 11)
        curve_q8_result = s_a[16] + curve_q8_line_q8_u + 4 >> 3
    bias = curve_q8_result + s_a[24]
    if not s_a[30]:
        return
    s_axis[67] = bias
    if not s_axis[73]:
        s_axis[55] = bias
    s_axis[73] = s_a[13] if s_a[13] else s_a[30]
    sigma_q8_grown_q8_seconds = s_a[28] >> 10
    if sigma_q8_grown_q8_seconds > 2047:
        sigma_q8_grown_q8_seconds = 2047
    sigma_q8_grown_q8_result = ((s_a[26] >> 4) * sigma_q8_grown_q8_seconds >> 4) + s_a[25]
    sigma_q8_variance = (c[37] << 1) + sigma_q8_grown_q8_result
    sigma_q8_beyond_q8_d = (s[47] << 4) - s_a[20]
    if sigma_q8_beyond_q8_d >> 30:
        sigma_q8_beyond_q8_d = s_a[19] - (s[47] << 4)
    if sigma_q8_beyond_q8_d >> 30 or not s_a[22]:
        sigma_q8_beyond_q8_result = 0
    else:
        if sigma_q8_beyond_q8_d > 262143:
            sigma_q8_beyond_q8_d = 262143
        sigma_q8_beyond_q8_sigma = sigma_q8_beyond_q8_d * c[50] >> 16
        if sigma_q8_beyond_q8_sigma > 16383:
            sigma_q8_beyond_q8_sigma = 16383
        sigma_q8_beyond_q8_result = sigma_q8_beyond_q8_sigma * sigma_q8_beyond_q8_sigma
    sigma_q8_variance = sigma_q8_variance + sigma_q8_beyond_q8_result
    if sigma_q8_variance < 4194303:
        sigma_q8_root_square = sigma_q8_variance << 8
        sigma_q8_root_bit = 16384
        if sigma_q8_root_square < 16777216:
            sigma_q8_root_bit = 2048
        sigma_q8_root_found = 0
        while sigma_q8_root_bit:
            sigma_q8_root_more = sigma_q8_root_found + sigma_q8_root_bit
            if sigma_q8_root_more * sigma_q8_root_more <= sigma_q8_root_square:
                sigma_q8_root_found = sigma_q8_root_more
            sigma_q8_root_bit = sigma_q8_root_bit >> 1
        sigma_q8_result = sigma_q8_root_found
    else:
        sigma_q8_root_bit = 16384
        if sigma_q8_variance < 16777216:
            sigma_q8_root_bit = 2048
        sigma_q8_root_found = 0
        while sigma_q8_root_bit:
            sigma_q8_root_more = sigma_q8_root_found + sigma_q8_root_bit
            if sigma_q8_root_more * sigma_q8_root_more <= sigma_q8_variance:
                sigma_q8_root_found = sigma_q8_root_more
            sigma_q8_root_bit = sigma_q8_root_bit >> 1
        sigma_q8_root_result = sigma_q8_root_found
        sigma_q8_result = sigma_q8_root_result << 4
    s_axis[70] = sigma_q8_result


@micropython.viper
def advance(c: ptr32, s: ptr32, s_, c_):
    axis = (s[53] - 1) // 3
    piece = (s[53] - 1) % 3
    busy = 0
    while not busy and axis < 3:
        a = axis * c[13] + c[0]
        s_a = ptr32(int(s) + (a << 2))
        if not piece:
            busy = s_a[1]
            if busy:
                if not int(absorb(0, c_, 0, a, s_, s_, c_)):
                    s_a[1] = 0
            if s_a[1]:
                learn_anywhere_temp = s[52]
                if learn_anywhere_temp < s_a[3]:
                    s_a[3] = learn_anywhere_temp
                if learn_anywhere_temp > s_a[4]:
                    s_a[4] = learn_anywhere_temp
                feed(0, 0, s_, c_, a + 32, a, s_, c_)
        elif not piece - 1:
            learn_here(0, 0, 0, s_, c_, a, s_, c_)
            busy = 1
        if s_a[1] and piece < 2:
            piece = piece + 1
        else:
            stale_d = s[47] - s_a[31]
            if s_a[1] or c[46] or stale_d > c[43] or (stale_d < -c[43]):
                s_a[31] = s[47]
                stale_result = 1
            else:
                stale_result = 0
            if stale_result:
                draw_line(0, 0, 0, s_, c_, a, s_, c_)
                busy = 1
            if s_a[1] and (not c[46]):
                hand_over(0, c_, 0, a, s_)
            s_a[1] = 0
            publish(0, c_, 0, a, s_, axis)
            axis = axis + 1
            piece = 0
    s[53] = axis * 3 + piece + 1 if axis < 3 else 0


@micropython.viper
def close(stillness_judge_look_spread_q8_i: int, s: ptr32, stillness_judge_look_tip_q8_i: int, c: ptr32, s_, c_):
    while s[53]:
        advance(c_, s_, s_, c_)
    while True:
        if s[18] > 3:
            stillness_judge_state = 2
            break
        if s[18]:
            stillness_judge_state = 4
            break
        stillness_judge_look_spread_q8_first = 26 + 4
        stillness_judge_look_spread_q8_square = s[35]
        stillness_judge_look_spread_q8_i = 0
        while stillness_judge_look_spread_q8_i < 3:
            stillness_judge_look_spread_q8_mean_q4 = s[stillness_judge_look_spread_q8_first + stillness_judge_look_spread_q8_i] << 4 >> c[4]
            stillness_judge_look_spread_q8_square = stillness_judge_look_spread_q8_square - (stillness_judge_look_spread_q8_mean_q4 * s[stillness_judge_look_spread_q8_first + stillness_judge_look_spread_q8_i] >> 4)
            stillness_judge_look_spread_q8_i = stillness_judge_look_spread_q8_i + 1
        if stillness_judge_look_spread_q8_square >> 30:
            stillness_judge_look_spread_q8_square = 0
        stillness_judge_look_noise_q8 = stillness_judge_look_spread_q8_square << 8 - c[4]
        if stillness_judge_look_noise_q8 > c[7]:
            stillness_judge_look_white_spread = stillness_judge_look_noise_q8
            stillness_judge_look_white_step = s[76] << 8 - c[4]
            stillness_judge_look_white_spread = stillness_judge_look_white_spread >> 4
            stillness_judge_look_white_step = stillness_judge_look_white_step >> 4
            if stillness_judge_look_white_step > (stillness_judge_look_white_spread >> 1) + stillness_judge_look_white_spread - (stillness_judge_look_white_spread >> 3) and stillness_judge_look_white_step < 3 * stillness_judge_look_white_spread - (stillness_judge_look_white_spread >> 2):
                stillness_judge_look_white_result = 1
            else:
                stillness_judge_look_white_result = 0
            if not stillness_judge_look_white_result:
                stillness_judge_state = 2
                break
        stillness_judge_look_spread_q8_square = s[33]
        stillness_judge_look_spread_q8_i = 0
        while stillness_judge_look_spread_q8_i < 3:
            stillness_judge_look_spread_q8_mean_q4 = s[26 + stillness_judge_look_spread_q8_i] << 4 >> c[4]
            stillness_judge_look_spread_q8_square = stillness_judge_look_spread_q8_square - (stillness_judge_look_spread_q8_mean_q4 * s[26 + stillness_judge_look_spread_q8_i] >> 4)
            stillness_judge_look_spread_q8_i = stillness_judge_look_spread_q8_i + 1
        if stillness_judge_look_spread_q8_square >> 30:
            stillness_judge_look_spread_q8_square = 0
        stillness_judge_look_shake_q8 = stillness_judge_look_spread_q8_square << 8 - c[4]
        if stillness_judge_look_shake_q8 > c[8]:
            stillness_judge_state = 4
            break
        s[49] = (stillness_judge_look_noise_q8 - s[49] >> 3) + s[49]
        if not s[34]:
            stillness_judge_state = 1
            break
        stillness_judge_look_tip_q8_i = 0
        stillness_judge_look_tip_q8_square = 0
        while stillness_judge_look_tip_q8_i < 3:
            stillness_judge_look_tip_q8_d = (s[19 + stillness_judge_look_tip_q8_i] << 4) + (s[26 + stillness_judge_look_tip_q8_i] << 4 >> c[4]) - s[36 + stillness_judge_look_tip_q8_i]
            if stillness_judge_look_tip_q8_d > 8191:
                stillness_judge_look_tip_q8_d = 8191
            if stillness_judge_look_tip_q8_d < -8191:
                stillness_judge_look_tip_q8_d = -8191
            stillness_judge_look_tip_q8_square = stillness_judge_look_tip_q8_d * stillness_judge_look_tip_q8_d + stillness_judge_look_tip_q8_square
            stillness_judge_look_tip_q8_i = stillness_judge_look_tip_q8_i + 1
        stillness_judge_look_tip_q8_result = stillness_judge_look_tip_q8_square
        s[51] = stillness_judge_look_tip_q8_result
        if s[51] > (stillness_judge_look_shake_q8 >> c[4]) * 6 + c[9]:
            stillness_judge_state = 3
            break
        if s[48]:
            stillness_judge_look_change_q4_i = 0
            stillness_judge_look_change_q4_most = 0
            while stillness_judge_look_change_q4_i < 3:
                stillness_judge_look_change_q4_d = (s[19 + 4 + stillness_judge_look_change_q4_i] << 4) + (s[26 + 4 + stillness_judge_look_change_q4_i] << 4 >> c[4]) - s[39 + stillness_judge_look_change_q4_i]
                if stillness_judge_look_change_q4_d >> 30:
                    stillness_judge_look_change_q4_d = -stillness_judge_look_change_q4_d
                if stillness_judge_look_change_q4_d > stillness_judge_look_change_q4_most:
                    stillness_judge_look_change_q4_most = stillness_judge_look_change_q4_d
                stillness_judge_look_change_q4_i = stillness_judge_look_change_q4_i + 1
            stillness_judge_look_change = stillness_judge_look_change_q4_most
            if stillness_judge_look_change > 32767:
                stillness_judge_state = 5
                break
            if stillness_judge_look_change * stillness_judge_look_change > (stillness_judge_look_noise_q8 >> c[4]) * 14 + c[10]:
                stillness_judge_state = 5
                break
        stillness_judge_state = 1
        break
        break
    s[46] = stillness_judge_state
    s[47] = (s[26 + 3] >> c[4]) + s[19 + 3]
    s[17] = 0
    if not stillness_judge_state - 2 or not stillness_judge_state - 4:
        s[34] = 0
        still = 0
    else:
        if stillness_judge_state - 1 or not s[34]:
            stillness_judge_stillness_begin_i = 0
            while stillness_judge_stillness_begin_i < 3:
                if not 0:
                    s[36 + stillness_judge_stillness_begin_i] = (s[19 + stillness_judge_stillness_begin_i] << 4) + (s[26 + stillness_judge_stillness_begin_i] << 4 >> c[4])
                s[39 + stillness_judge_stillness_begin_i] = (s[19 + 4 + stillness_judge_stillness_begin_i] << 4) + (s[26 + 4 + stillness_judge_stillness_begin_i] << 4 >> c[4])
                s[42 + stillness_judge_stillness_begin_i] = 0
                stillness_judge_stillness_begin_i = stillness_judge_stillness_begin_i + 1
            s[45] = 0
            s[48] = 0
            s[34] = 1
        elif not s[48]:
            stillness_judge_stillness_begin_i = 0
            while stillness_judge_stillness_begin_i < 3:
                if not 1:
                    s[36 + stillness_judge_stillness_begin_i] = (s[19 + stillness_judge_stillness_begin_i] << 4) + (s[26 + stillness_judge_stillness_begin_i] << 4 >> c[4])
                s[39 + stillness_judge_stillness_begin_i] = (s[19 + 4 + stillness_judge_stillness_begin_i] << 4) + (s[26 + 4 + stillness_judge_stillness_begin_i] << 4 >> c[4])
                s[42 + stillness_judge_stillness_begin_i] = 0
                stillness_judge_stillness_begin_i = stillness_judge_stillness_begin_i + 1
            s[45] = 0
            s[48] = 0
            s[34] = 1
        stillness_judge_i = 0
        while stillness_judge_i < 3:
            stillness_judge_total = s[19 + 4 + stillness_judge_i] << c[4]
            stillness_judge_total = stillness_judge_total - (s[64 + stillness_judge_i] + 128 >> 8)
            stillness_judge_total = stillness_judge_total + s[26 + 4 + stillness_judge_i]
            s[42 + stillness_judge_i] += stillness_judge_total
            stillness_judge_i = stillness_judge_i + 1
        s[45] = s[45] + s[47]
        s[48] = s[48] + 1
        if s[48] < c[5]:
            still = 0
        else:
            s[48] = 0
            still = 1
    if still:
        s[52] = s[45] // c[5]
    i = 0
    while i < 3:
        a = i * c[13] + c[0]
        s_a = ptr32(int(s) + (a << 2))
        s_a[28] = s[16] // 1000 + s_a[28]
        if s_a[28] > 67108863:
            s_a[28] = 67108863
        if not still and (not s_a[30]) and (not c[46]):
            if s[73 + i] > 1:
                pass
            elif not s[46] - 1 and s[48] > 1:
                foretell_n = s[48] << c[4]
                foretell_level = s[42 + i] // foretell_n << 8
                foretell_level = (s[42 + i] % foretell_n << 8) // foretell_n + foretell_level
                foretell_foresay_quality = c[44]
                s[67 + i] = foretell_level
                s[55 + i] = foretell_level
                s[70 + i] = foretell_foresay_quality
                s[73 + i] = 1
            elif not s[73 + i] - 1:
                s[67 + i] = 0
                s[55 + i] = 0
                s[70 + i] = 0
                s[73 + i] = 1
                s[73 + i] = 0
        if still and (not c[46]):
            s_a[0] = s[42 + i]
            s_a[1] = c[5] << c[4]
            s_a[12] = 0
        i = i + 1
    s[16] = 0
    s[53] = 1


@micropython.viper
def learn_at_once(s: ptr32, c: ptr32, x: ptr32, s_, c_):
    s[52] = x[3]
    a = 0 * c[13] + c[0]
    s_a = ptr32(int(s) + (a << 2))
    s_a[0] = x[4]
    s_a[1] = 1
    learn_anywhere_temp = s[52]
    if learn_anywhere_temp < s_a[3]:
        s_a[3] = learn_anywhere_temp
    if learn_anywhere_temp > s_a[4]:
        s_a[4] = learn_anywhere_temp
    feed(0, 0, s_, c_, a + 32, a, s_, c_)
    learn_here(0, 0, 0, s_, c_, a, s_, c_)
    s_a[1] = 0
    a = 1 * c[13] + c[0]
    s_a = ptr32(int(s) + (a << 2))
    s_a[0] = x[5]
    s_a[1] = 1
    learn_anywhere_temp = s[52]
    if learn_anywhere_temp < s_a[3]:
        s_a[3] = learn_anywhere_temp
    if learn_anywhere_temp > s_a[4]:
        s_a[4] = learn_anywhere_temp
    feed(0, 0, s_, c_, a + 32, a, s_, c_)
    learn_here(0, 0, 0, s_, c_, a, s_, c_)
    s_a[1] = 0
    a = 2 * c[13] + c[0]
    s_a = ptr32(int(s) + (a << 2))
    s_a[0] = x[6]
    s_a[1] = 1
    learn_anywhere_temp = s[52]
    if learn_anywhere_temp < s_a[3]:
        s_a[3] = learn_anywhere_temp
    if learn_anywhere_temp > s_a[4]:
        s_a[4] = learn_anywhere_temp
    feed(0, 0, s_, c_, a + 32, a, s_, c_)
    learn_here(0, 0, 0, s_, c_, a, s_, c_)
    s_a[1] = 0


@micropython.viper
def examine(s: ptr32, c: ptr32, x_, dt_us: int) -> int:
    x = ptr32(x_)
    check_dt_us = dt_us
    check_step = x[3] - s[3]
    check_exchange_same = 1
    if x[0] - s[0]:
        check_exchange_same = 0
    s[0] = x[0]
    if x[1] - s[1]:
        check_exchange_same = 0
    s[1] = x[1]
    if x[2] - s[2]:
        check_exchange_same = 0
    s[2] = x[2]
    if x[3] - s[3]:
        check_exchange_same = 0
    s[3] = x[3]
    if x[4] - s[4]:
        check_exchange_same = 0
    s[4] = x[4]
    if x[5] - s[5]:
        check_exchange_same = 0
    s[5] = x[5]
    if x[6] - s[6]:
        check_exchange_same = 0
    s[6] = x[6]
    check_repeats = check_exchange_same
    check_kind = 0
    if (not x[0] or not x[0] - -1) and int(all_alike(x_)):
        check_kind = 3 - x[0]
    elif not s[8]:
        check_kind = 0
    elif check_dt_us <= 0:
        check_kind = 6
    elif check_dt_us > c[1]:
        check_kind = 7
    elif check_repeats:
        check_kind = 1
    elif check_step >= c[2] or check_step <= -c[2]:
        check_kind = 5
    if not check_kind:
        while True:
            check_at_rail_i = 4
            check_at_rail_left = 0
            while check_at_rail_i < 7:
                if x[check_at_rail_i] > 32766 or x[check_at_rail_i] < -32767:
                    check_at_rail_result = 1
                    check_at_rail_left = 1
                    break
                check_at_rail_i = check_at_rail_i + 1
            if check_at_rail_left:
                break
            check_at_rail_result = 0
            break
        if check_at_rail_result:
            check_kind = 2
    s[check_kind + 8] = s[check_kind + 8] + 1 & 536870911
    if check_kind > 1:
        s[17] = 0
        s[18] = 0
        s[34] = 0
    elif check_dt_us > 0 and check_dt_us <= c[1]:
        check_dt_us = check_dt_us + s[16]
        s[16] = check_dt_us if check_dt_us < 536870911 else 536870911
    return check_kind


@micropython.viper
def admit(s_, c_, x_, kind: int) -> int:
    s = ptr32(s_)
    c = ptr32(c_)
    x = ptr32(x_)
    if not kind:
        if not s[17]:
            s[19] = x[0]
            s[26] = 0
            s[20] = x[1]
            s[27] = 0
            s[21] = x[2]
            s[28] = 0
            s[22] = x[3]
            s[29] = 0
            s[23] = x[4]
            s[30] = 0
            s[24] = x[5]
            s[31] = 0
            s[25] = x[6]
            s[32] = 0
            s[33] = 0
            s[35] = 0
            s[76] = 0
            s[77] = 0
            s[78] = 0
            s[79] = 0
            s[64] = 0
            s[65] = 0
            s[66] = 0
            s[18] = 0
        s[17] = s[17] + 1
        if not s[18]:
            stillness_gather_d = x[0] - s[19]
            if stillness_gather_d + 512 >> 10:
                s[18] = 1
                stillness_gather_d = 0
            s[26] = s[26] + stillness_gather_d
            s[33] = stillness_gather_d * stillness_gather_d + s[33]
            stillness_gather_d = x[1] - s[20]
            if stillness_gather_d + 512 >> 10:
                s[18] = 2
                stillness_gather_d = 0
            s[27] = s[27] + stillness_gather_d
            s[33] = stillness_gather_d * stillness_gather_d + s[33]
            stillness_gather_d = x[2] - s[21]
            if stillness_gather_d + 512 >> 10:
                s[18] = 3
                stillness_gather_d = 0
            s[28] = s[28] + stillness_gather_d
            s[33] = stillness_gather_d * stillness_gather_d + s[33]
            stillness_gather_d = x[3] - s[22]
            if stillness_gather_d + 512 >> 10:
                s[18] = 4
                stillness_gather_d = 0
            s[29] = s[29] + stillness_gather_d
            stillness_gather_d = x[4] - s[23]
            if stillness_gather_d + 512 >> 10:
                s[18] = 5
                stillness_gather_d = 0
            s[30] = s[30] + stillness_gather_d
            s[35] = stillness_gather_d * stillness_gather_d + s[35]
            stillness_gather_e = stillness_gather_d - s[77]
            s[76] = stillness_gather_e * stillness_gather_e + s[76]
            s[77] = stillness_gather_d
            stillness_gather_e = s[61]
            s[64] = s[64] + stillness_gather_e
            stillness_gather_d = x[5] - s[24]
            if stillness_gather_d + 512 >> 10:
                s[18] = 6
                stillness_gather_d = 0
            s[31] = s[31] + stillness_gather_d
            s[35] = stillness_gather_d * stillness_gather_d + s[35]
            stillness_gather_e = stillness_gather_d - s[78]
            s[76] = stillness_gather_e * stillness_gather_e + s[76]
            s[78] = stillness_gather_d
            stillness_gather_e = s[62]
            s[65] = s[65] + stillness_gather_e
            stillness_gather_d = x[6] - s[25]
            if stillness_gather_d + 512 >> 10:
                s[18] = 7
                stillness_gather_d = 0
            s[32] = s[32] + stillness_gather_d
            s[35] = stillness_gather_d * stillness_gather_d + s[35]
            stillness_gather_e = stillness_gather_d - s[79]
            s[76] = stillness_gather_e * stillness_gather_e + s[76]
            s[79] = stillness_gather_d
            stillness_gather_e = s[63]
            s[66] = s[66] + stillness_gather_e
        else:
            stillness_gather_d = x[3] - s[22]
            s[29] = s[29] + stillness_gather_d
        if s[17] < c[3]:
            stillness_gather_result = 0
        else:
            stillness_gather_result = 1
        if stillness_gather_result:
            close(0, s_, 0, c_, s_, c_)
        if not s[8] - 1 or not c[3] - 4:
            s[47] = x[3]
            s[53] = 1
            while s[53]:
                advance(c_, s_, s_, c_)
        if c[46]:
            learn_at_once(s_, c_, x_, s_, c_)
    i = c[12]
    while i > 0 and s[53]:
        advance(c_, s_, s_, c_)
        i = i - 1
    return kind


@micropython.viper
def finish(s: ptr32, c: ptr32, x: ptr32, kind: int) -> int:
    if kind > 2:
        return kind
    d = s[67] - s[55]
    if d > c[11]:
        d = c[11]
    elif d < -c[11]:
        d = -c[11]
    s[55] = s[55] + d
    d = (x[4] << 8) - s[55] - s[61] + s[58]
    x[4] = d + 128 >> 8
    s[58] = d - (x[4] << 8)
    d = s[68] - s[56]
    if d > c[11]:
        d = c[11]
    elif d < -c[11]:
        d = -c[11]
    s[56] = s[56] + d
    d = (x[5] << 8) - s[56] - s[62] + s[59]
    x[5] = d + 128 >> 8
    s[59] = d - (x[5] << 8)
    d = s[69] - s[57]
    if d > c[11]:
        d = c[11]
    elif d < -c[11]:
        d = -c[11]
    s[57] = s[57] + d
    d = (x[6] << 8) - s[57] - s[63] + s[60]
    x[6] = d + 128 >> 8
    s[60] = d - (x[6] << 8)
    return kind


@micropython.viper
def step(s_, c_, x_, dt_us: int) -> int:
    s = ptr32(s_)
    c = ptr32(c_)
    x = ptr32(x_)
    examine_check_dt_us = dt_us
    examine_check_step = x[3] - s[3]
    examine_check_exchange_same = 1
    if x[0] - s[0]:
        examine_check_exchange_same = 0
    s[0] = x[0]
    if x[1] - s[1]:
        examine_check_exchange_same = 0
    s[1] = x[1]
    if x[2] - s[2]:
        examine_check_exchange_same = 0
    s[2] = x[2]
    if x[3] - s[3]:
        examine_check_exchange_same = 0
    s[3] = x[3]
    if x[4] - s[4]:
        examine_check_exchange_same = 0
    s[4] = x[4]
    if x[5] - s[5]:
        examine_check_exchange_same = 0
    s[5] = x[5]
    if x[6] - s[6]:
        examine_check_exchange_same = 0
    s[6] = x[6]
    examine_check_repeats = examine_check_exchange_same
    examine_check_kind = 0
    if (not x[0] or not x[0] - -1) and int(all_alike(x_)):
        examine_check_kind = 3 - x[0]
    elif not s[8]:
        examine_check_kind = 0
    elif examine_check_dt_us <= 0:
        examine_check_kind = 6
    elif examine_check_dt_us > c[1]:
        examine_check_kind = 7
    elif examine_check_repeats:
        examine_check_kind = 1
    elif examine_check_step >= c[2] or examine_check_step <= -c[2]:
        examine_check_kind = 5
    if not examine_check_kind:
        while True:
            examine_check_at_rail_i = 4
            examine_check_at_rail_left = 0
            while examine_check_at_rail_i < 7:
                if x[examine_check_at_rail_i] > 32766 or x[examine_check_at_rail_i] < -32767:
                    examine_check_at_rail_result = 1
                    examine_check_at_rail_left = 1
                    break
                examine_check_at_rail_i = examine_check_at_rail_i + 1
            if examine_check_at_rail_left:
                break
            examine_check_at_rail_result = 0
            break
        if examine_check_at_rail_result:
            examine_check_kind = 2
    s[examine_check_kind + 8] = s[examine_check_kind + 8] + 1 & 536870911
    if examine_check_kind > 1:
        s[17] = 0
        s[18] = 0
        s[34] = 0
    elif examine_check_dt_us > 0 and examine_check_dt_us <= c[1]:
        examine_check_dt_us = examine_check_dt_us + s[16]
        s[16] = examine_check_dt_us if examine_check_dt_us < 536870911 else 536870911
    kind = examine_check_kind
    if not kind:
        if not s[17]:
            s[19] = x[0]
            s[26] = 0
            s[20] = x[1]
            s[27] = 0
            s[21] = x[2]
            s[28] = 0
            s[22] = x[3]
            s[29] = 0
            s[23] = x[4]
            s[30] = 0
            s[24] = x[5]
            s[31] = 0
            s[25] = x[6]
            s[32] = 0
            s[33] = 0
            s[35] = 0
            s[76] = 0
            s[77] = 0
            s[78] = 0
            s[79] = 0
            s[64] = 0
            s[65] = 0
            s[66] = 0
            s[18] = 0
        s[17] = s[17] + 1
        if not s[18]:
            admit_stillness_gather_d = x[0] - s[19]
            if admit_stillness_gather_d + 512 >> 10:
                s[18] = 1
                admit_stillness_gather_d = 0
            s[26] = s[26] + admit_stillness_gather_d
            s[33] = admit_stillness_gather_d * admit_stillness_gather_d + s[33]
            admit_stillness_gather_d = x[1] - s[20]
            if admit_stillness_gather_d + 512 >> 10:
                s[18] = 2
                admit_stillness_gather_d = 0
            s[27] = s[27] + admit_stillness_gather_d
            s[33] = admit_stillness_gather_d * admit_stillness_gather_d + s[33]
            admit_stillness_gather_d = x[2] - s[21]
            if admit_stillness_gather_d + 512 >> 10:
                s[18] = 3
                admit_stillness_gather_d = 0
            s[28] = s[28] + admit_stillness_gather_d
            s[33] = admit_stillness_gather_d * admit_stillness_gather_d + s[33]
            admit_stillness_gather_d = x[3] - s[22]
            if admit_stillness_gather_d + 512 >> 10:
                s[18] = 4
                admit_stillness_gather_d = 0
            s[29] = s[29] + admit_stillness_gather_d
            admit_stillness_gather_d = x[4] - s[23]
            if admit_stillness_gather_d + 512 >> 10:
                s[18] = 5
                admit_stillness_gather_d = 0
            s[30] = s[30] + admit_stillness_gather_d
            s[35] = admit_stillness_gather_d * admit_stillness_gather_d + s[35]
            admit_stillness_gather_e = admit_stillness_gather_d - s[77]
            s[76] = admit_stillness_gather_e * admit_stillness_gather_e + s[76]
            s[77] = admit_stillness_gather_d
            admit_stillness_gather_e = s[61]
            s[64] = s[64] + admit_stillness_gather_e
            admit_stillness_gather_d = x[5] - s[24]
            if admit_stillness_gather_d + 512 >> 10:
                s[18] = 6
                admit_stillness_gather_d = 0
            s[31] = s[31] + admit_stillness_gather_d
            s[35] = admit_stillness_gather_d * admit_stillness_gather_d + s[35]
            admit_stillness_gather_e = admit_stillness_gather_d - s[78]
            s[76] = admit_stillness_gather_e * admit_stillness_gather_e + s[76]
            s[78] = admit_stillness_gather_d
            admit_stillness_gather_e = s[62]
            s[65] = s[65] + admit_stillness_gather_e
            admit_stillness_gather_d = x[6] - s[25]
            if admit_stillness_gather_d + 512 >> 10:
                s[18] = 7
                admit_stillness_gather_d = 0
            s[32] = s[32] + admit_stillness_gather_d
            s[35] = admit_stillness_gather_d * admit_stillness_gather_d + s[35]
            admit_stillness_gather_e = admit_stillness_gather_d - s[79]
            s[76] = admit_stillness_gather_e * admit_stillness_gather_e + s[76]
            s[79] = admit_stillness_gather_d
            admit_stillness_gather_e = s[63]
            s[66] = s[66] + admit_stillness_gather_e
        else:
            admit_stillness_gather_d = x[3] - s[22]
            s[29] = s[29] + admit_stillness_gather_d
        if s[17] < c[3]:
            admit_stillness_gather_result = 0
        else:
            admit_stillness_gather_result = 1
        if admit_stillness_gather_result:
            close(0, s_, 0, c_, s_, c_)
        if not s[8] - 1 or not c[3] - 4:
            s[47] = x[3]
            s[53] = 1
            while s[53]:
                advance(c_, s_, s_, c_)
        if c[46]:
            learn_at_once(s_, c_, x_, s_, c_)
    admit_i = c[12]
    while admit_i > 0 and s[53]:
        advance(c_, s_, s_, c_)
        admit_i = admit_i - 1
    if kind > 2:
        return kind
    step_finish_d = s[67] - s[55]
    if step_finish_d > c[11]:
        step_finish_d = c[11]
    elif step_finish_d < -c[11]:
        step_finish_d = -c[11]
    s[55] = s[55] + step_finish_d
    step_finish_d = (x[4] << 8) - s[55] - s[61] + s[58]
    x[4] = step_finish_d + 128 >> 8
    s[58] = step_finish_d - (x[4] << 8)
    step_finish_d = s[68] - s[56]
    if step_finish_d > c[11]:
        step_finish_d = c[11]
    elif step_finish_d < -c[11]:
        step_finish_d = -c[11]
    s[56] = s[56] + step_finish_d
    step_finish_d = (x[5] << 8) - s[56] - s[62] + s[59]
    x[5] = step_finish_d + 128 >> 8
    s[59] = step_finish_d - (x[5] << 8)
    step_finish_d = s[69] - s[57]
    if step_finish_d > c[11]:
        step_finish_d = c[11]
    elif step_finish_d < -c[11]:
        step_finish_d = -c[11]
    s[57] = s[57] + step_finish_d
    step_finish_d = (x[6] << 8) - s[57] - s[63] + s[60]
    x[6] = step_finish_d + 128 >> 8
    s[60] = step_finish_d - (x[6] << 8)
    return kind


@micropython.viper
def offer(c: ptr32, axis: int, w: int, s: ptr32, m: ptr32):
    a = axis * c[13] + c[0]
    s_a = ptr32(int(s) + (a << 2))
    sigma = m[w + 3 + axis] >> 2
    if s_a[1] or sigma > c[48]:
        return
    readings_worth_n = c[49] // (sigma * sigma + 1)
    readings_worth_result = readings_worth_n if readings_worth_n < 256 else 256
    s_a[1] = readings_worth_result
    if s_a[1]:
        w = m[w + axis] - s[axis + 61] >> 4
        s_a[0] = w * s_a[1] >> 4
        s_a[12] = (sigma * sigma >> 4 << 3) + s[7]


@micropython.viper
def consider(s_, c_, m_, w: int, source: int):
    s = ptr32(s_)
    c = ptr32(c_)
    m = ptr32(m_)
    while s[53]:
        advance(c_, s_, s_, c_)
    s[52] = s[47]
    s[7] = source
    speak_w = w
    m_speak_w = ptr32(int(m) + (speak_w << 2))
    if not s[0 * c[13] + c[0] + 30]:
        speak_w = speak_w + 0
        m_speak_w = ptr32(int(m_speak_w) + 0)
        if m_speak_w[3] >> 5 < c[48]:
            s[67] = m_speak_w[0]
            if not s[73]:
                s[55] = m_speak_w[0]
            s[70] = m_speak_w[3]
            s[73] = s[7]
    speak_w = w
    m_speak_w = ptr32(int(m) + (speak_w << 2))
    if not s[1 * c[13] + c[0] + 30]:
        speak_w = speak_w + 1
        m_speak_w = ptr32(int(m_speak_w) + 4)
        if m_speak_w[3] >> 5 < c[48]:
            s[68] = m_speak_w[0]
            if not s[74]:
                s[56] = m_speak_w[0]
            s[71] = m_speak_w[3]
            s[74] = s[7]
    speak_w = w
    m_speak_w = ptr32(int(m) + (speak_w << 2))
    if not s[2 * c[13] + c[0] + 30]:
        speak_w = speak_w + 2
        m_speak_w = ptr32(int(m_speak_w) + 8)
        if m_speak_w[3] >> 5 < c[48]:
            s[69] = m_speak_w[0]
            if not s[75]:
                s[57] = m_speak_w[0]
            s[72] = m_speak_w[3]
            s[75] = s[7]
    offer(c_, 0, w, s_, m_)
    offer(c_, 1, w, s_, m_)
    offer(c_, 2, w, s_, m_)
    s[53] = 1
