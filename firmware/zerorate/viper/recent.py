# Generated from zerorate/recent.py by `make viper`: edit that file, not this one.
"""What the curve over temperature does not explain lately: turn-on offset, lag, drift."""

import micropython


@micropython.viper
def let_learn(c: ptr32, s: ptr32, a: int):
    s_a = ptr32(int(s) + (a << 2))
    if not a - c[0] and s[54] < c[39]:
        s[54] = s[54] + 1
    level_q8_k = c[0] - 3 + (a - c[0]) // c[13]
    s_level_q8_k = ptr32(int(s) + (level_q8_k << 2))
    if s[54] < c[39]:
        level_q8_off = s_a[24] >> 4
        if level_q8_off > 16383:
            level_q8_off = 16383
        if level_q8_off < -16383:
            level_q8_off = -16383
        level_q8_usual = level_q8_off * level_q8_off
        if level_q8_usual < c[45]:
            level_q8_usual = c[45]
        level_q8_beyond_q8_d = (s[47] << 4) - s_a[20]
        if level_q8_beyond_q8_d >> 30:
            level_q8_beyond_q8_d = s_a[19] - (s[47] << 4)
        if level_q8_beyond_q8_d >> 30 or not s_a[22]:
            level_q8_beyond_q8_result = 0
        else:
            if level_q8_beyond_q8_d > 262143:
                level_q8_beyond_q8_d = 262143
            level_q8_beyond_q8_sigma = level_q8_beyond_q8_d * c[50] >> 16
            if level_q8_beyond_q8_sigma > 16383:
                level_q8_beyond_q8_sigma = 16383
            level_q8_beyond_q8_result = level_q8_beyond_q8_sigma * level_q8_beyond_q8_sigma
        s_level_q8_k[0] = level_q8_beyond_q8_result
        level_q8_gain_q14_variance = s_level_q8_k[0]
        level_q8_gain_q14_noise = level_q8_usual
        while level_q8_gain_q14_variance + level_q8_gain_q14_noise > 32767:
            level_q8_gain_q14_variance = level_q8_gain_q14_variance >> 1
            level_q8_gain_q14_noise = level_q8_gain_q14_noise >> 1
        level_q8_usual = (level_q8_gain_q14_variance << 14) // (level_q8_gain_q14_variance + level_q8_gain_q14_noise + 1)
        s_level_q8_k[0] = s_a[24] - (level_q8_off * level_q8_usual >> 10)
    off = s_level_q8_k[0]
    n = s_a[1]
    s_a[0] = s_a[0] - ((off >> 8) * n + ((off & 255) * n + 128 >> 8))


@micropython.viper
def absorb(error_q4_curve_q8_choose_find_e: int, c: ptr32, error_q4_curve_q8_choose_find_d: int, a: int, s: ptr32, s_, c_) -> int:
    s_a = ptr32(int(s) + (a << 2))
    s[80] = s[49] // (3 * s_a[1]) + c[37]
    error_q4_before = s[52]
    while True:
        s_a[29] = 0
        while True:
            error_q4_curve_q8_choose_find_half = c[27] >> 1
            error_q4_curve_q8_choose_find_e = s_a[2]
            if error_q4_curve_q8_choose_find_e > 0:
                error_q4_curve_q8_choose_find_d = error_q4_before - s[error_q4_curve_q8_choose_find_e]
                if error_q4_curve_q8_choose_find_d <= error_q4_curve_q8_choose_find_half + c[28] and error_q4_curve_q8_choose_find_d >= 0 - error_q4_curve_q8_choose_find_half - c[28]:
                    error_q4_curve_q8_choose_e = error_q4_curve_q8_choose_find_e
                    break
            error_q4_curve_q8_choose_find_e = a + c[14]
            error_q4_curve_q8_choose_find_left = 0
            while error_q4_curve_q8_choose_find_e < a + c[15]:
                error_q4_curve_q8_choose_find_d = error_q4_before - s[error_q4_curve_q8_choose_find_e]
                if error_q4_curve_q8_choose_find_d < error_q4_curve_q8_choose_find_half and error_q4_curve_q8_choose_find_d >= 0 - error_q4_curve_q8_choose_find_half:
                    error_q4_curve_q8_choose_e = error_q4_curve_q8_choose_find_e
                    error_q4_curve_q8_choose_find_left = 1
                    break
                error_q4_curve_q8_choose_find_e = error_q4_curve_q8_choose_find_e + c[26]
            if error_q4_curve_q8_choose_find_left:
                break
            error_q4_curve_q8_choose_e = 0
            break
        if error_q4_curve_q8_choose_e > 0:
            error_q4_curve_q8_choose_e = s[error_q4_curve_q8_choose_e + 3]
            if error_q4_curve_q8_choose_e >= c[34] and error_q4_curve_q8_choose_e >= (s_a[21] >> 8) * c[35]:
                error_q4_curve_q8_kind = 3
                break
        if s_a[22]:
            error_q4_curve_q8_choose_e = (error_q4_before << 4) + c[36]
            if error_q4_curve_q8_choose_e < s_a[19]:
                s_a[29] = 1
            error_q4_curve_q8_choose_e = (error_q4_before << 4) - c[36]
            if error_q4_curve_q8_choose_e > s_a[20]:
                s_a[29] = 1
            error_q4_curve_q8_kind = 2
            break
        error_q4_curve_q8_choose_e = s_a[35]
        if error_q4_curve_q8_choose_e >= c[31] or (error_q4_curve_q8_choose_e > 0 and (not c[46])):
            error_q4_curve_q8_kind = 1
            break
        error_q4_curve_q8_kind = 0
        break
    if not error_q4_curve_q8_kind - 3 and (not c[21]) and s_a[22]:
        error_q4_curve_q8_kind = 2
    s_a[30] = error_q4_curve_q8_kind
    if not error_q4_curve_q8_kind:
        error_q4_before = 0
    elif not error_q4_curve_q8_kind - 3:
        while True:
            error_q4_curve_q8_find_half = c[27] >> 1
            error_q4_curve_q8_find_e = s_a[2]
            if error_q4_curve_q8_find_e > 0:
                error_q4_curve_q8_find_d = error_q4_before - s[error_q4_curve_q8_find_e]
                if error_q4_curve_q8_find_d <= error_q4_curve_q8_find_half + c[28] and error_q4_curve_q8_find_d >= 0 - error_q4_curve_q8_find_half - c[28]:
                    error_q4_curve_q8_kind = error_q4_curve_q8_find_e
                    break
            error_q4_curve_q8_find_e = a + c[14]
            error_q4_curve_q8_find_left = 0
            while error_q4_curve_q8_find_e < a + c[15]:
                error_q4_curve_q8_find_d = error_q4_before - s[error_q4_curve_q8_find_e]
                if error_q4_curve_q8_find_d < error_q4_curve_q8_find_half and error_q4_curve_q8_find_d >= 0 - error_q4_curve_q8_find_half:
                    error_q4_curve_q8_kind = error_q4_curve_q8_find_e
                    error_q4_curve_q8_find_left = 1
                    break
                error_q4_curve_q8_find_e = error_q4_curve_q8_find_e + c[26]
            if error_q4_curve_q8_find_left:
                break
            error_q4_curve_q8_kind = 0
            break
        error_q4_before = s[error_q4_curve_q8_kind + 2]
    elif not error_q4_curve_q8_kind - 1:
        error_q4_before = s_a[34]
    else:
        error_q4_curve_q8_line_q8_temp_q4 = error_q4_before << 4
        error_q4_curve_q8_line_q8_u = error_q4_curve_q8_line_q8_temp_q4 - s_a[14]
        error_q4_curve_q8_line_q8_most = 134217727 >> s_a[18]
        if error_q4_curve_q8_line_q8_u > error_q4_curve_q8_line_q8_most:
            error_q4_curve_q8_line_q8_u = error_q4_curve_q8_line_q8_most
        if error_q4_curve_q8_line_q8_u < 0 - error_q4_curve_q8_line_q8_most:
            error_q4_curve_q8_line_q8_u = 0 - error_q4_curve_q8_line_q8_most
        error_q4_curve_q8_line_q8_u = (error_q4_curve_q8_line_q8_u << s_a[18]) - s_a[15]
        error_q4_curve_q8_line_q8_scaled_a = s_a[17]
        error_q4_curve_q8_line_q8_scaled_b = error_q4_curve_q8_line_q8_u
        error_q4_curve_q8_line_q8_scaled_high = error_q4_curve_q8_line_q8_scaled_b >> 15
        error_q4_curve_q8_line_q8_scaled_b = error_q4_curve_q8_line_q8_scaled_b & 32767
        error_q4_curve_q8_line_q8_scaled_middle = (error_q4_curve_q8_line_q8_scaled_a >> 15) * error_q4_curve_q8_line_q8_scaled_b + (error_q4_curve_q8_line_q8_scaled_a & 32767) * error_q4_curve_q8_line_q8_scaled_high + ((error_q4_curve_q8_line_q8_scaled_a & 32767) * error_q4_curve_q8_line_q8_scaled_b >> 15)
        error_q4_curve_q8_line_q8_scaled_high = (error_q4_curve_q8_line_q8_scaled_a >> 15) * error_q4_curve_q8_line_q8_scaled_high
        error_q4_curve_q8_line_q8_u = (error_q4_curve_q8_line_q8_scaled_high << 4) + (error_q4_curve_q8_line_q8_scaled_middle >> 11)
        error_q4_before = s_a[16] + error_q4_curve_q8_line_q8_u + 4 >> 3
    s_a[23] = error_q4_before
    error_q4_mean = s_a[0] % s_a[1]
    error_q4_mean = (error_q4_mean << 8) // s_a[1]
    error_q4_mean = (s_a[0] // s_a[1] << 8) + error_q4_mean
    error = error_q4_mean - error_q4_before - s_a[24] >> 4
    if not int(believe(s_, error, c_, a)):
        return 0
    let_learn(c_, s_, a)
    return 1


@micropython.viper
def believe(s: ptr32, error: int, c: ptr32, a: int) -> int:
    s_a = ptr32(int(s) + (a << 2))
    if s_a[12]:
        adopt_noise = (s_a[12] >> 3) + c[37]
        if not s_a[30]:
            s_a[27] = -1
            s[54] = c[39]
        else:
            adopt_grown_q8_seconds = s_a[28] >> 10
            if adopt_grown_q8_seconds > 2047:
                adopt_grown_q8_seconds = 2047
            adopt_grown_q8_result = ((s_a[26] >> 4) * adopt_grown_q8_seconds >> 4) + s_a[25]
            if adopt_noise >= adopt_grown_q8_result and s_a[13] - (s_a[12] & 7):
                return 1
            else:
                s_a[24] = (error << 4) + s_a[24]
        s_a[13] = s_a[12] & 7
        s_a[25] = adopt_noise
        s_a[28] = 0
        return 1
    s_a[13] = 0
    if not s_a[30]:
        s_a[27] = -1
        s[54] = c[39]
        s_a[24] = 0
        s_a[25] = s[80]
        s_a[28] = 0
        return 1
    grown_q8_seconds = s_a[28] >> 10
    if grown_q8_seconds > 2047:
        grown_q8_seconds = 2047
    grown_q8_result = ((s_a[26] >> 4) * grown_q8_seconds >> 4) + s_a[25]
    s[81] = grown_q8_result
    plausible_far = error if error >= 0 else 0 - error
    if plausible_far > 32767:
        plausible_far = 32767
    if plausible_far <= c[38]:
        plausible_far = 0
    plausible_beyond_q8_d = (s[47] << 4) - s_a[20]
    if plausible_beyond_q8_d >> 30:
        plausible_beyond_q8_d = s_a[19] - (s[47] << 4)
    if plausible_beyond_q8_d >> 30 or not s_a[22]:
        plausible_beyond_q8_result = 0
    else:
        if plausible_beyond_q8_d > 262143:
            plausible_beyond_q8_d = 262143
        plausible_beyond_q8_sigma = plausible_beyond_q8_d * c[50] >> 16
        if plausible_beyond_q8_sigma > 16383:
            plausible_beyond_q8_sigma = 16383
        plausible_beyond_q8_result = plausible_beyond_q8_sigma * plausible_beyond_q8_sigma
    if plausible_far * plausible_far // 36 <= s[81] + s[80] + plausible_beyond_q8_result:
        s_a[27] = 0
        verdict = 1
    else:
        s_a[27] = s_a[27] + 1
        if s_a[27] < c[39]:
            verdict = 0
        else:
            s_a[27] = 0
            s_a[24] = (error << 4) + s_a[24]
            verdict = 2
    if not verdict:
        return 0
    if not verdict - 1:
        follow_error = error
        if follow_error > 16383:
            follow_error = 16383
        if follow_error < -16383:
            follow_error = -16383
        follow_excess = follow_error * follow_error - s_a[25]
        follow_excess = follow_excess - s[80]
        follow_rewalk_excess = follow_excess
        follow_rewalk_age = (s_a[28] >> 6) + 1
        if follow_rewalk_excess > 2097151:
            follow_rewalk_excess = 2097151
        if follow_rewalk_excess < -2097151:
            follow_rewalk_excess = -2097151
        follow_rewalk_speed = (follow_rewalk_excess << 8) // follow_rewalk_age
        if follow_rewalk_speed > 33554431:
            follow_rewalk_speed = 33554431
        if follow_rewalk_speed < -33554431:
            follow_rewalk_speed = -33554431
        follow_rewalk_speed = follow_rewalk_speed << 4
        if follow_rewalk_speed > c[41]:
            follow_rewalk_speed = c[41]
        if follow_rewalk_age > 1023:
            follow_rewalk_age = 1023
        follow_rewalk_speed = follow_rewalk_speed - s_a[26] >> 4
        follow_rewalk_share = follow_rewalk_age * follow_rewalk_age
        follow_rewalk_share = follow_rewalk_share // (follow_rewalk_share + 1048576 >> 10)
        if follow_rewalk_share < 40:
            follow_rewalk_share = 40
        follow_rewalk_speed = follow_rewalk_speed * follow_rewalk_share >> 10 << 4
        s_a[26] = s_a[26] + follow_rewalk_speed
        if s_a[26] < c[40]:
            s_a[26] = c[40]
        follow_gain_q14_variance = s[81]
        follow_gain_q14_noise = s[80]
        while follow_gain_q14_variance + follow_gain_q14_noise > 32767:
            follow_gain_q14_variance = follow_gain_q14_variance >> 1
            follow_gain_q14_noise = follow_gain_q14_noise >> 1
        follow_gain = (follow_gain_q14_variance << 14) // (follow_gain_q14_variance + follow_gain_q14_noise + 1)
        s_a[24] = (follow_gain * follow_error >> 10) + s_a[24]
        follow_excess = (s[80] & 16383) * follow_gain >> 14
        s_a[25] = (s[80] >> 14) * follow_gain + follow_excess
    else:
        s_a[25] = s[80]
    s_a[28] = 0
    return 1


@micropython.viper
def hand_over(curve_q8_choose_find_e: int, c: ptr32, curve_q8_choose_find_d: int, a: int, s: ptr32):
    s_a = ptr32(int(s) + (a << 2))
    if s_a[27] >> 30:
        s_a[27] = 0
    else:
        after = s[52]
        while True:
            s_a[29] = 0
            while True:
                curve_q8_choose_find_half = c[27] >> 1
                curve_q8_choose_find_e = s_a[2]
                if curve_q8_choose_find_e > 0:
                    curve_q8_choose_find_d = after - s[curve_q8_choose_find_e]
                    if curve_q8_choose_find_d <= curve_q8_choose_find_half + c[28] and curve_q8_choose_find_d >= 0 - curve_q8_choose_find_half - c[28]:
                        curve_q8_choose_e = curve_q8_choose_find_e
                        break
                curve_q8_choose_find_e = a + c[14]
                curve_q8_choose_find_left = 0
                while curve_q8_choose_find_e < a + c[15]:
                    curve_q8_choose_find_d = after - s[curve_q8_choose_find_e]
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
                curve_q8_choose_e = (after << 4) + c[36]
                if curve_q8_choose_e < s_a[19]:
                    s_a[29] = 1
                curve_q8_choose_e = (after << 4) - c[36]
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
            after = 0
        elif not curve_q8_kind - 3:
            while True:
                curve_q8_find_half = c[27] >> 1
                curve_q8_find_e = s_a[2]
                if curve_q8_find_e > 0:
                    curve_q8_find_d = after - s[curve_q8_find_e]
                    if curve_q8_find_d <= curve_q8_find_half + c[28] and curve_q8_find_d >= 0 - curve_q8_find_half - c[28]:
                        curve_q8_kind = curve_q8_find_e
                        break
                curve_q8_find_e = a + c[14]
                curve_q8_find_left = 0
                while curve_q8_find_e < a + c[15]:
                    curve_q8_find_d = after - s[curve_q8_find_e]
                    if curve_q8_find_d < curve_q8_find_half and curve_q8_find_d >= 0 - curve_q8_find_half:
                        curve_q8_kind = curve_q8_find_e
                        curve_q8_find_left = 1
                        break
                    curve_q8_find_e = curve_q8_find_e + c[26]
                if curve_q8_find_left:
                    break
                curve_q8_kind = 0
                break
            after = s[curve_q8_kind + 2]
        elif not curve_q8_kind - 1:
            after = s_a[34]
        else:
            curve_q8_line_q8_temp_q4 = after << 4
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
            after = s_a[16] + curve_q8_line_q8_u + 4 >> 3
        s_a[24] = s_a[23] - after + s_a[24]
