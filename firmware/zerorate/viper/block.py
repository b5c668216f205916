# Generated from zerorate/block.py by `make viper`: edit that file, not this one.
"""Many frames in one call, as a chip's FIFO gives them: what `step` does, faster."""

import micropython

from .estimators import feed
from .estimators import learn_here
from .step import advance
from .step import close


@micropython.viper
def take(s: ptr32, f: ptr32, c: ptr32, first: int, n: int) -> int:
    p = first << 3
    f_p = ptr32(int(f) + (p << 2))
    left = n
    moving = s[18]
    leap_us = c[1]
    usual_us = leap_us
    elapsed_us = 0
    most_jump = c[2] - 1
    least_jump = 1 - c[2]
    last_t = s[3]
    last_x = s[4]
    last_y = s[5]
    last_z = s[6]
    ref_a = s[19]
    ref_b = s[20]
    ref_c = s[21]
    ref_t = s[22]
    ref_x = s[23]
    ref_y = s[24]
    ref_z = s[25]
    sum_a = s[26]
    sum_b = s[27]
    sum_c = s[28]
    sum_t = s[29]
    sum_x = s[30]
    sum_y = s[31]
    sum_z = s[32]
    square_accel = s[33]
    square_gyro = s[35]
    square_step = s[76]
    bias_x = s[55] + s[61]
    bias_y = s[56] + s[62]
    bias_z = s[57] + s[63]
    due_x = s[58] + 128 - bias_x
    due_y = s[59] + 128 - bias_y
    due_z = s[60] + 128 - bias_z
    while left:
        dt = f_p[0]
        if dt - usual_us:
            if dt <= 0 or dt > leap_us:
                break
            usual_us = dt
        t = f_p[4]
        d = t - last_t
        if d > most_jump or d < least_jump:
            break
        x = f_p[5]
        y = f_p[6]
        z = f_p[7]
        if not x - last_x and (not y - last_y) and (not z - last_z):
            break
        if not x - y and (not y - z):
            break
        if moving:
            if (x + 16384 | y + 16384 | z + 16384) >> 15:
                if x > 32766 or y > 32766 or z > 32766:
                    break
                if x < -32767 or y < -32767 or z < -32767:
                    break
            sum_t = t - ref_t + sum_t
        else:
            a = f_p[1] - ref_a
            b = f_p[2] - ref_b
            g = f_p[3] - ref_c
            d = t - ref_t
            dx = x - ref_x
            dy = y - ref_y
            dz = z - ref_z
            far = a + 512 | b + 512 | g + 512 | d + 512
            if (dx + 512 | dy + 512 | dz + 512 | far) >> 10:
                break
            sum_a = sum_a + a
            sum_b = sum_b + b
            sum_c = sum_c + g
            sum_t = sum_t + d
            sum_x = sum_x + dx
            sum_y = sum_y + dy
            sum_z = sum_z + dz
            square_accel = a * a + b * b + g * g + square_accel
            square_gyro = dx * dx + dy * dy + dz * dz + square_gyro
            a = x - last_x
            b = y - last_y
            g = z - last_z
            square_step = a * a + b * b + g * g + square_step
        elapsed_us = elapsed_us + dt
        last_t = t
        last_x = x
        last_y = y
        last_z = z
        d = (x << 8) + due_x
        f_p[5] = d >> 8
        due_x = (d & 255) - bias_x
        d = (y << 8) + due_y
        f_p[6] = d >> 8
        due_y = (d & 255) - bias_y
        d = (z << 8) + due_z
        f_p[7] = d >> 8
        due_z = (d & 255) - bias_z
        f_p[0] = 0
        p = p + 8
        f_p = ptr32(int(f) + (p << 2))
        left = left - 1
    left = n - left
    if not left:
        return 0
    account_elapsed_us = elapsed_us
    s[0] = f[p - 7]
    s[1] = f[p - 6]
    s[2] = f[p - 5]
    s[3] = f[p - 4]
    s[8] = s[8] + left
    s[17] = s[17] + left
    account_elapsed_us = account_elapsed_us + s[16]
    s[16] = account_elapsed_us if account_elapsed_us < 536870911 else 536870911
    s[4] = last_x
    s[5] = last_y
    s[6] = last_z
    s[29] = sum_t
    s[58] = due_x + bias_x - 128
    s[59] = due_y + bias_y - 128
    s[60] = due_z + bias_z - 128
    if moving:
        return left
    s[26] = sum_a
    s[27] = sum_b
    s[28] = sum_c
    s[30] = sum_x
    s[31] = sum_y
    s[32] = sum_z
    s[33] = square_accel
    s[35] = square_gyro
    s[76] = square_step
    s[77] = last_x - ref_x
    s[78] = last_y - ref_y
    s[79] = last_z - ref_z
    s[64] = s[61] * left + s[64]
    s[65] = s[62] * left + s[65]
    s[66] = s[63] * left + s[66]
    return left


@micropython.viper
def one(s_, f: ptr32, c_, x: ptr32, p: int):
    s = ptr32(s_)
    c = ptr32(c_)
    f_p = ptr32(int(f) + (p << 2))
    i = 0
    while i < 7:
        x[i] = f[p + 1 + i]
        i = i + 1
    i = f_p[0]
    step_step_examine_check_dt_us = i
    step_step_examine_check_differ = 0
    step_step_examine_check_fresh = 0
    step_step_examine_check_jump = x[3] - s[3]
    step_step_examine_check_i = 0
    while step_step_examine_check_i < 7:
        if x[step_step_examine_check_i] - x[0]:
            step_step_examine_check_differ = 1
        if x[step_step_examine_check_i] - s[step_step_examine_check_i]:
            step_step_examine_check_fresh = 1
        s[step_step_examine_check_i] = x[step_step_examine_check_i]
        step_step_examine_check_i = step_step_examine_check_i + 1
    step_step_examine_check_i = 0
    if not step_step_examine_check_differ and (not x[0] or not x[0] - -1):
        step_step_examine_check_i = 3 - x[0]
    elif not s[8]:
        step_step_examine_check_i = 0
    elif step_step_examine_check_dt_us <= 0:
        step_step_examine_check_i = 6
    elif step_step_examine_check_dt_us > c[1]:
        step_step_examine_check_i = 7
    elif not step_step_examine_check_fresh:
        step_step_examine_check_i = 1
    elif step_step_examine_check_jump >= c[2] or step_step_examine_check_jump <= -c[2]:
        step_step_examine_check_i = 5
    if not step_step_examine_check_i:
        step_step_examine_check_jump = 4
        while step_step_examine_check_jump < 7:
            if x[step_step_examine_check_jump] > 32766 or x[step_step_examine_check_jump] < -32767:
                step_step_examine_check_i = 2
            step_step_examine_check_jump = step_step_examine_check_jump + 1
    step_step_examine_check_i = step_step_examine_check_i + 8
    step_step_examine_check_jump = s[step_step_examine_check_i] + 1
    s[step_step_examine_check_i] = step_step_examine_check_jump & 536870911
    step_step_examine_check_i = step_step_examine_check_i - 8
    if step_step_examine_check_i > 1:
        s[17] = 0
        s[18] = 0
        s[34] = 0
    elif step_step_examine_check_dt_us > 0 and step_step_examine_check_dt_us <= c[1]:
        step_step_examine_check_dt_us = step_step_examine_check_dt_us + s[16]
        s[16] = step_step_examine_check_dt_us if step_step_examine_check_dt_us < 536870911 else 536870911
    step_step_kind = step_step_examine_check_i
    if not step_step_kind:
        step_step_admit_stillness_gather_i = 0
        if not s[17]:
            while step_step_admit_stillness_gather_i < 7:
                s[19 + step_step_admit_stillness_gather_i] = x[step_step_admit_stillness_gather_i]
                s[26 + step_step_admit_stillness_gather_i] = 0
                step_step_admit_stillness_gather_i = step_step_admit_stillness_gather_i + 1
            s[33] = 0
            s[35] = 0
            s[76] = 0
            s[77] = 0
            s[77 + 1] = 0
            s[77 + 2] = 0
            s[64] = 0
            s[64 + 1] = 0
            s[64 + 2] = 0
            s[18] = 0
        s[17] = s[17] + 1
        if not s[18]:
            step_step_admit_stillness_gather_i = 0
            while step_step_admit_stillness_gather_i < 7:
                step_step_admit_stillness_gather_d = x[step_step_admit_stillness_gather_i] - s[19 + step_step_admit_stillness_gather_i]
                if step_step_admit_stillness_gather_d + 512 >> 10:
                    s[18] = step_step_admit_stillness_gather_i + 1
                    step_step_admit_stillness_gather_d = 0
                s[26 + step_step_admit_stillness_gather_i] += step_step_admit_stillness_gather_d
                if step_step_admit_stillness_gather_i < 3:
                    s[33] = step_step_admit_stillness_gather_d * step_step_admit_stillness_gather_d + s[33]
                elif step_step_admit_stillness_gather_i > 3:
                    s[35] = step_step_admit_stillness_gather_d * step_step_admit_stillness_gather_d + s[35]
                    step_step_admit_stillness_gather_e = step_step_admit_stillness_gather_d - s[77 - 4 + step_step_admit_stillness_gather_i]
                    s[76] = step_step_admit_stillness_gather_e * step_step_admit_stillness_gather_e + s[76]
                    s[77 - 4 + step_step_admit_stillness_gather_i] = step_step_admit_stillness_gather_d
                    step_step_admit_stillness_gather_e = s[61 - 4 + step_step_admit_stillness_gather_i]
                    s[64 - 4 + step_step_admit_stillness_gather_i] += step_step_admit_stillness_gather_e
                step_step_admit_stillness_gather_i = step_step_admit_stillness_gather_i + 1
        else:
            step_step_admit_stillness_gather_d = x[3] - s[19 + 3]
            s[26 + 3] += step_step_admit_stillness_gather_d
        if s[17] < c[3]:
            step_step_admit_stillness_gather_result = 0
        else:
            step_step_admit_stillness_gather_result = 1
        if step_step_admit_stillness_gather_result:
            close(s_, c_)
        if not s[8] - 1 or not c[3] - 4:
            s[47] = x[3]
            s[53] = 1
            while s[53]:
                advance(s_, c_)
        if c[46]:
            s[52] = x[3]
            step_step_admit_learn_at_once_i = 0
            while step_step_admit_learn_at_once_i < 3:
                step_step_admit_learn_at_once_a = step_step_admit_learn_at_once_i * c[13] + c[0]
                s_step_step_admit_learn_at_once_a = ptr32(int(s) + (step_step_admit_learn_at_once_a << 2))
                s_step_step_admit_learn_at_once_a[0] = x[4 + step_step_admit_learn_at_once_i]
                s_step_step_admit_learn_at_once_a[1] = 1
                step_step_admit_learn_at_once_learn_anywhere_temp = s[52]
                if step_step_admit_learn_at_once_learn_anywhere_temp < s_step_step_admit_learn_at_once_a[3]:
                    s_step_step_admit_learn_at_once_a[3] = step_step_admit_learn_at_once_learn_anywhere_temp
                if step_step_admit_learn_at_once_learn_anywhere_temp > s_step_step_admit_learn_at_once_a[4]:
                    s_step_step_admit_learn_at_once_a[4] = step_step_admit_learn_at_once_learn_anywhere_temp
                feed(s_, c_, step_step_admit_learn_at_once_a, step_step_admit_learn_at_once_a + 32)
                learn_here(s_, c_, step_step_admit_learn_at_once_a)
                s_step_step_admit_learn_at_once_a[1] = 0
                step_step_admit_learn_at_once_i = step_step_admit_learn_at_once_i + 1
    step_step_admit_i = c[12]
    while step_step_admit_i > 0 and s[53]:
        advance(s_, c_)
        step_step_admit_i = step_step_admit_i - 1
    step_step_step_finish_i = 0
    while step_step_step_finish_i < 3 and step_step_kind < 3:
        step_step_step_finish_d = s[67 + step_step_step_finish_i] - s[55 + step_step_step_finish_i]
        if step_step_step_finish_d > c[11]:
            step_step_step_finish_d = c[11]
        elif step_step_step_finish_d < -c[11]:
            step_step_step_finish_d = -c[11]
        s[55 + step_step_step_finish_i] += step_step_step_finish_d
        step_step_step_finish_d = (x[4 + step_step_step_finish_i] << 8) - s[55 + step_step_step_finish_i] - s[61 + step_step_step_finish_i] + s[58 + step_step_step_finish_i]
        x[4 + step_step_step_finish_i] = step_step_step_finish_d + 128 >> 8
        s[58 + step_step_step_finish_i] = step_step_step_finish_d - (x[4 + step_step_step_finish_i] << 8)
        step_step_step_finish_i = step_step_step_finish_i + 1
    step_step_result = step_step_kind
    f_p[0] = step_step_result
    i = 0
    while i < 7:
        f[p + 1 + i] = x[i]
        i = i + 1


@micropython.viper
def block(s_, f_, c_, x_, n: int):
    s = ptr32(s_)
    c = ptr32(c_)
    i = 0
    while i < n:
        k = n - i
        while True:
            if s[53] or not s[17] or c[46] or (c[1] > 2097151):
                k = 0
                break
            if not s[8] or s[8] > 536870400:
                k = 0
                break
            block_stretch_i = 0
            block_stretch_left = 0
            while block_stretch_i < 3:
                if s[block_stretch_i + 55] - s[block_stretch_i + 67]:
                    k = 0
                    block_stretch_left = 1
                    break
                if s[block_stretch_i + 23] > 32000 or s[block_stretch_i + 23] < -32000:
                    k = 0
                    block_stretch_left = 1
                    break
                block_stretch_i = block_stretch_i + 1
            if block_stretch_left:
                break
            block_stretch_i = c[3] - 1 - s[17]
            k = block_stretch_i if block_stretch_i < k else k
            break
        if k:
            k = int(take(s_, f_, c_, i, k))
        if not k:
            one(s_, f_, c_, x_, i << 3)
            k = 1
        i = i + k
