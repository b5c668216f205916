# Generated from zerorate/recent.py by `make viper`: edit that file, not this one.
"""What the curve over temperature does not explain lately: turn-on offset, lag, drift."""

import micropython

from .bias import curve_q8


@micropython.viper
def let_learn(s: ptr32, c: ptr32, a: int):
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
            level_q8_beyond_q8_d = level_q8_beyond_q8_d * c[50] >> 16
            if level_q8_beyond_q8_d > 16383:
                level_q8_beyond_q8_d = 16383
            level_q8_beyond_q8_result = level_q8_beyond_q8_d * level_q8_beyond_q8_d
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
def absorb(s_, c_, a: int) -> int:
    s = ptr32(s_)
    c = ptr32(c_)
    s_a = ptr32(int(s) + (a << 2))
    s[80] = s[49] // (3 * s_a[1]) + c[37]
    error_q4_before = s[52]
    error_q4_before = int(curve_q8(s_, c_, a, error_q4_before))
    s_a[23] = error_q4_before
    error_q4_mean = s_a[0] % s_a[1]
    error_q4_mean = (error_q4_mean << 8) // s_a[1]
    error_q4_mean = (s_a[0] // s_a[1] << 8) + error_q4_mean
    error = error_q4_mean - error_q4_before - s_a[24] >> 4
    while True:
        if s_a[12]:
            recent_believe_adopt_noise = (s_a[12] >> 3) + c[37]
            if not s_a[30]:
                s_a[27] = -1
                s[54] = c[39]
            else:
                recent_believe_adopt_grown_q8_seconds = s_a[28] >> 10
                if recent_believe_adopt_grown_q8_seconds > 2047:
                    recent_believe_adopt_grown_q8_seconds = 2047
                recent_believe_adopt_grown_q8_result = ((s_a[26] >> 4) * recent_believe_adopt_grown_q8_seconds >> 4) + s_a[25]
                if recent_believe_adopt_noise >= recent_believe_adopt_grown_q8_result and s_a[13] - (s_a[12] & 7):
                    recent_believe_result = 1
                    break
                else:
                    s_a[24] = (error << 4) + s_a[24]
            s_a[13] = s_a[12] & 7
            s_a[25] = recent_believe_adopt_noise
            s_a[28] = 0
            recent_believe_result = 1
            break
        s_a[13] = 0
        if not s_a[30]:
            s_a[27] = -1
            s[54] = c[39]
            s_a[24] = 0
            s_a[25] = s[80]
            s_a[28] = 0
            recent_believe_result = 1
            break
        recent_believe_grown_q8_seconds = s_a[28] >> 10
        if recent_believe_grown_q8_seconds > 2047:
            recent_believe_grown_q8_seconds = 2047
        recent_believe_grown_q8_result = ((s_a[26] >> 4) * recent_believe_grown_q8_seconds >> 4) + s_a[25]
        s[81] = recent_believe_grown_q8_result
        recent_believe_plausible_far = error if error >= 0 else 0 - error
        if recent_believe_plausible_far > 32767:
            recent_believe_plausible_far = 32767
        if recent_believe_plausible_far <= c[38]:
            recent_believe_plausible_far = 0
        recent_believe_plausible_beyond_q8_d = (s[47] << 4) - s_a[20]
        if recent_believe_plausible_beyond_q8_d >> 30:
            recent_believe_plausible_beyond_q8_d = s_a[19] - (s[47] << 4)
        if recent_believe_plausible_beyond_q8_d >> 30 or not s_a[22]:
            recent_believe_plausible_beyond_q8_result = 0
        else:
            if recent_believe_plausible_beyond_q8_d > 262143:
                recent_believe_plausible_beyond_q8_d = 262143
            recent_believe_plausible_beyond_q8_d = recent_believe_plausible_beyond_q8_d * c[50] >> 16
            if recent_believe_plausible_beyond_q8_d > 16383:
                recent_believe_plausible_beyond_q8_d = 16383
            recent_believe_plausible_beyond_q8_result = recent_believe_plausible_beyond_q8_d * recent_believe_plausible_beyond_q8_d
        if recent_believe_plausible_far * recent_believe_plausible_far // 36 <= s[81] + s[80] + recent_believe_plausible_beyond_q8_result:
            s_a[27] = 0
            recent_believe_verdict = 1
        else:
            s_a[27] = s_a[27] + 1
            if s_a[27] < c[39]:
                recent_believe_verdict = 0
            else:
                s_a[27] = 0
                s_a[24] = (error << 4) + s_a[24]
                recent_believe_verdict = 2
        if not recent_believe_verdict:
            recent_believe_result = 0
            break
        if not recent_believe_verdict - 1:
            recent_believe_follow_error = error
            if recent_believe_follow_error > 16383:
                recent_believe_follow_error = 16383
            if recent_believe_follow_error < -16383:
                recent_believe_follow_error = -16383
            recent_believe_follow_excess = recent_believe_follow_error * recent_believe_follow_error - s_a[25]
            recent_believe_follow_excess = recent_believe_follow_excess - s[80]
            recent_believe_follow_rewalk_excess = recent_believe_follow_excess
            recent_believe_follow_rewalk_age = (s_a[28] >> 6) + 1
            if recent_believe_follow_rewalk_excess > 2097151:
                recent_believe_follow_rewalk_excess = 2097151
            if recent_believe_follow_rewalk_excess < -2097151:
                recent_believe_follow_rewalk_excess = -2097151
            recent_believe_follow_rewalk_speed = (recent_believe_follow_rewalk_excess << 8) // recent_believe_follow_rewalk_age
            if recent_believe_follow_rewalk_speed > 33554431:
                recent_believe_follow_rewalk_speed = 33554431
            if recent_believe_follow_rewalk_speed < -33554431:
                recent_believe_follow_rewalk_speed = -33554431
            recent_believe_follow_rewalk_speed = recent_believe_follow_rewalk_speed << 4
            if recent_believe_follow_rewalk_speed > c[41]:
                recent_believe_follow_rewalk_speed = c[41]
            if recent_believe_follow_rewalk_age > 1023:
                recent_believe_follow_rewalk_age = 1023
            recent_believe_follow_rewalk_speed = recent_believe_follow_rewalk_speed - s_a[26] >> 4
            recent_believe_follow_rewalk_age = recent_believe_follow_rewalk_age * recent_believe_follow_rewalk_age
            recent_believe_follow_rewalk_age = recent_believe_follow_rewalk_age // (recent_believe_follow_rewalk_age + 1048576 >> 10)
            if recent_believe_follow_rewalk_age < 40:
                recent_believe_follow_rewalk_age = 40
            recent_believe_follow_rewalk_speed = recent_believe_follow_rewalk_speed * recent_believe_follow_rewalk_age >> 10 << 4
            s_a[26] = s_a[26] + recent_believe_follow_rewalk_speed
            if s_a[26] < c[40]:
                s_a[26] = c[40]
            recent_believe_follow_gain_q14_variance = s[81]
            recent_believe_follow_gain_q14_noise = s[80]
            while recent_believe_follow_gain_q14_variance + recent_believe_follow_gain_q14_noise > 32767:
                recent_believe_follow_gain_q14_variance = recent_believe_follow_gain_q14_variance >> 1
                recent_believe_follow_gain_q14_noise = recent_believe_follow_gain_q14_noise >> 1
            recent_believe_follow_excess = (recent_believe_follow_gain_q14_variance << 14) // (recent_believe_follow_gain_q14_variance + recent_believe_follow_gain_q14_noise + 1)
            s_a[24] = (recent_believe_follow_excess * recent_believe_follow_error >> 10) + s_a[24]
            recent_believe_follow_error = (s[80] & 16383) * recent_believe_follow_excess >> 14
            s_a[25] = (s[80] >> 14) * recent_believe_follow_excess + recent_believe_follow_error
        else:
            s_a[25] = s[80]
        s_a[28] = 0
        recent_believe_result = 1
        break
    if not recent_believe_result:
        return 0
    let_learn(s_, c_, a)
    return 1
