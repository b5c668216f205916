# Generated from zerorate/block.py by `make viper`: edit that file, not this one.
"""Many frames in one call, as a chip's FIFO gives them: what `step` does, faster."""

import micropython

from .guard import all_alike
from .step import advance
from .step import close
from .step import learn_at_once


@micropython.viper
def take(f_p: ptr32, s: ptr32, r: ptr32, c: ptr32, f: ptr32):
    if s[53] or c[46] or (not c[3] - 4) or (c[1] > 2097151):
        left = 0
    elif not s[8] or s[8] > 536870400:
        left = 0
    elif s[55] - s[67] or s[56] - s[68]:
        left = 0
    elif s[57] - s[69]:
        left = 0
    else:
        block_stretch_i = c[3] - 1 - s[17]
        block_stretch_n = r[8] - r[7] >> 3
        left = block_stretch_i if block_stretch_i < block_stretch_n else block_stretch_n
    d = 1 if left and s[17] == 0 else 0
    edge_k = d
    edge_p = r[7]
    f_edge_p = ptr32(int(f) + (edge_p << 2))
    if edge_k:
        edge_plain_d = f_edge_p[4] - s[3]
        if f_edge_p[0] <= 0 or f_edge_p[0] > c[1] or edge_plain_d >= c[2] or (edge_plain_d <= -c[2]):
            edge_k = 0
        elif not f_edge_p[5] - s[4] and (not f_edge_p[6] - s[5]) and (not f_edge_p[7] - s[6]):
            edge_k = 0
        elif not f_edge_p[5] - f_edge_p[6] and (not f_edge_p[6] - f_edge_p[7]):
            edge_k = 0
        elif f_edge_p[5] > 32000 or f_edge_p[6] > 32000 or f_edge_p[7] > 32000:
            edge_k = 0
        elif f_edge_p[5] < -32000 or f_edge_p[6] < -32000 or f_edge_p[7] < -32000:
            edge_k = 0
        else:
            edge_k = 1
    if edge_k:
        edge_i = 0
        r[0] = f_edge_p[1]
        s[0] = r[0]
        r[1] = f_edge_p[2]
        s[1] = r[1]
        r[2] = f_edge_p[3]
        s[2] = r[2]
        r[3] = f_edge_p[4]
        s[3] = r[3]
        r[4] = f_edge_p[5]
        s[4] = r[4]
        r[5] = f_edge_p[6]
        s[5] = r[5]
        r[6] = f_edge_p[7]
        s[6] = r[6]
        edge_i = 7
        s[8] = s[8] + 1
        edge_i = s[16] + f_edge_p[0]
        s[16] = edge_i if edge_i < 536870911 else 536870911
    if edge_k:
        if not s[17]:
            s[19] = r[0]
            s[26] = 0
            s[20] = r[1]
            s[27] = 0
            s[21] = r[2]
            s[28] = 0
            s[22] = r[3]
            s[29] = 0
            s[23] = r[4]
            s[30] = 0
            s[24] = r[5]
            s[31] = 0
            s[25] = r[6]
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
            edge_stillness_gather_d = r[0] - s[19]
            if edge_stillness_gather_d + 512 >> 10:
                s[18] = 1
                edge_stillness_gather_d = 0
            s[26] = s[26] + edge_stillness_gather_d
            s[33] = edge_stillness_gather_d * edge_stillness_gather_d + s[33]
            edge_stillness_gather_d = r[1] - s[20]
            if edge_stillness_gather_d + 512 >> 10:
                s[18] = 2
                edge_stillness_gather_d = 0
            s[27] = s[27] + edge_stillness_gather_d
            s[33] = edge_stillness_gather_d * edge_stillness_gather_d + s[33]
            edge_stillness_gather_d = r[2] - s[21]
            if edge_stillness_gather_d + 512 >> 10:
                s[18] = 3
                edge_stillness_gather_d = 0
            s[28] = s[28] + edge_stillness_gather_d
            s[33] = edge_stillness_gather_d * edge_stillness_gather_d + s[33]
            edge_stillness_gather_d = r[3] - s[22]
            if edge_stillness_gather_d + 512 >> 10:
                s[18] = 4
                edge_stillness_gather_d = 0
            s[29] = s[29] + edge_stillness_gather_d
            edge_stillness_gather_d = r[4] - s[23]
            if edge_stillness_gather_d + 512 >> 10:
                s[18] = 5
                edge_stillness_gather_d = 0
            s[30] = s[30] + edge_stillness_gather_d
            s[35] = edge_stillness_gather_d * edge_stillness_gather_d + s[35]
            edge_stillness_gather_e = edge_stillness_gather_d - s[77]
            s[76] = edge_stillness_gather_e * edge_stillness_gather_e + s[76]
            s[77] = edge_stillness_gather_d
            edge_stillness_gather_e = s[61]
            s[64] = s[64] + edge_stillness_gather_e
            edge_stillness_gather_d = r[5] - s[24]
            if edge_stillness_gather_d + 512 >> 10:
                s[18] = 6
                edge_stillness_gather_d = 0
            s[31] = s[31] + edge_stillness_gather_d
            s[35] = edge_stillness_gather_d * edge_stillness_gather_d + s[35]
            edge_stillness_gather_e = edge_stillness_gather_d - s[78]
            s[76] = edge_stillness_gather_e * edge_stillness_gather_e + s[76]
            s[78] = edge_stillness_gather_d
            edge_stillness_gather_e = s[62]
            s[65] = s[65] + edge_stillness_gather_e
            edge_stillness_gather_d = r[6] - s[25]
            if edge_stillness_gather_d + 512 >> 10:
                s[18] = 7
                edge_stillness_gather_d = 0
            s[32] = s[32] + edge_stillness_gather_d
            s[35] = edge_stillness_gather_d * edge_stillness_gather_d + s[35]
            edge_stillness_gather_e = edge_stillness_gather_d - s[79]
            s[76] = edge_stillness_gather_e * edge_stillness_gather_e + s[76]
            s[79] = edge_stillness_gather_d
            edge_stillness_gather_e = s[63]
            s[66] = s[66] + edge_stillness_gather_e
        else:
            edge_stillness_gather_d = r[3] - s[22]
            s[29] = s[29] + edge_stillness_gather_d
        if s[17] < c[3]:
            pass
    if edge_k:
        edge_i = 0
        edge_d = (r[4] << 8) - s[55] - s[61] + s[58] + 128
        f_edge_p[5] = edge_d >> 8
        s[58] = (edge_d & 255) - 128
        edge_d = (r[5] << 8) - s[56] - s[62] + s[59] + 128
        f_edge_p[6] = edge_d >> 8
        s[59] = (edge_d & 255) - 128
        edge_d = (r[6] << 8) - s[57] - s[63] + s[60] + 128
        f_edge_p[7] = edge_d >> 8
        s[60] = (edge_d & 255) - 128
        edge_i = 3
        f_edge_p[0] = 0
        r[7] = edge_p + 8
    n = edge_k
    if d:
        left = left - 1 if n else 0
    p = r[7]
    f_p = ptr32(int(f) + (p << 2))
    n = left
    moving = s[18]
    leap_us = c[1]
    usual_us = leap_us
    since = p
    elapsed_us = 0
    most_jump = c[2] - 1
    least_jump = 1 - c[2]
    near = 256 if c[2] > 256 else 0
    near_bits = 9 if near else 0
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
        if f_p[0] - usual_us:
            if f_p[0] <= 0 or f_p[0] > leap_us:
                break
            elapsed_us = (p - since >> 3) * usual_us + elapsed_us
            since = p
            usual_us = f_p[0]
        t = f_p[4]
        d = t - last_t
        if d + near >> near_bits:
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
        last_t = t
        last_x = x
        last_y = y
        last_z = z
        f_p[5] = (due_x >> 8) + x
        due_x = (due_x & 255) - bias_x
        f_p[6] = (due_y >> 8) + y
        due_y = (due_y & 255) - bias_y
        f_p[7] = (due_z >> 8) + z
        due_z = (due_z & 255) - bias_z
        f_p[0] = 0
        p = p + 8
        f_p = ptr32(int(f_p) + 32)
        left = left - 1
    r[7] = p
    n = n - left
    elapsed_us = (p - since >> 3) * usual_us + elapsed_us
    if n:
        account_elapsed_us = elapsed_us
        s[0] = f[p - 7]
        s[1] = f[p - 6]
        s[2] = f[p - 5]
        s[3] = f[p - 4]
        s[8] = s[8] + n
        s[17] = s[17] + n
        account_elapsed_us = account_elapsed_us + s[16]
        s[16] = account_elapsed_us if account_elapsed_us < 536870911 else 536870911
        s[4] = last_x
        s[5] = last_y
        s[6] = last_z
        s[29] = sum_t
        s[58] = due_x + bias_x - 128
        s[59] = due_y + bias_y - 128
        s[60] = due_z + bias_z - 128
    if n and (not moving):
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
        s[64] = s[61] * n + s[64]
        s[65] = s[62] * n + s[65]
        s[66] = s[63] * n + s[66]
    edge_k = left
    edge_p = r[7]
    f_edge_p = ptr32(int(f) + (edge_p << 2))
    if edge_k:
        edge_plain_d = f_edge_p[4] - s[3]
        if f_edge_p[0] <= 0 or f_edge_p[0] > c[1] or edge_plain_d >= c[2] or (edge_plain_d <= -c[2]):
            edge_k = 0
        elif not f_edge_p[5] - s[4] and (not f_edge_p[6] - s[5]) and (not f_edge_p[7] - s[6]):
            edge_k = 0
        elif not f_edge_p[5] - f_edge_p[6] and (not f_edge_p[6] - f_edge_p[7]):
            edge_k = 0
        elif f_edge_p[5] > 32000 or f_edge_p[6] > 32000 or f_edge_p[7] > 32000:
            edge_k = 0
        elif f_edge_p[5] < -32000 or f_edge_p[6] < -32000 or f_edge_p[7] < -32000:
            edge_k = 0
        else:
            edge_k = 1
    if edge_k:
        edge_i = 0
        r[0] = f_edge_p[1]
        s[0] = r[0]
        r[1] = f_edge_p[2]
        s[1] = r[1]
        r[2] = f_edge_p[3]
        s[2] = r[2]
        r[3] = f_edge_p[4]
        s[3] = r[3]
        r[4] = f_edge_p[5]
        s[4] = r[4]
        r[5] = f_edge_p[6]
        s[5] = r[5]
        r[6] = f_edge_p[7]
        s[6] = r[6]
        edge_i = 7
        s[8] = s[8] + 1
        edge_i = s[16] + f_edge_p[0]
        s[16] = edge_i if edge_i < 536870911 else 536870911
    if edge_k:
        if not s[17]:
            s[19] = r[0]
            s[26] = 0
            s[20] = r[1]
            s[27] = 0
            s[21] = r[2]
            s[28] = 0
            s[22] = r[3]
            s[29] = 0
            s[23] = r[4]
            s[30] = 0
            s[24] = r[5]
            s[31] = 0
            s[25] = r[6]
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
            edge_stillness_gather_d = r[0] - s[19]
            if edge_stillness_gather_d + 512 >> 10:
                s[18] = 1
                edge_stillness_gather_d = 0
            s[26] = s[26] + edge_stillness_gather_d
            s[33] = edge_stillness_gather_d * edge_stillness_gather_d + s[33]
            edge_stillness_gather_d = r[1] - s[20]
            if edge_stillness_gather_d + 512 >> 10:
                s[18] = 2
                edge_stillness_gather_d = 0
            s[27] = s[27] + edge_stillness_gather_d
            s[33] = edge_stillness_gather_d * edge_stillness_gather_d + s[33]
            edge_stillness_gather_d = r[2] - s[21]
            if edge_stillness_gather_d + 512 >> 10:
                s[18] = 3
                edge_stillness_gather_d = 0
            s[28] = s[28] + edge_stillness_gather_d
            s[33] = edge_stillness_gather_d * edge_stillness_gather_d + s[33]
            edge_stillness_gather_d = r[3] - s[22]
            if edge_stillness_gather_d + 512 >> 10:
                s[18] = 4
                edge_stillness_gather_d = 0
            s[29] = s[29] + edge_stillness_gather_d
            edge_stillness_gather_d = r[4] - s[23]
            if edge_stillness_gather_d + 512 >> 10:
                s[18] = 5
                edge_stillness_gather_d = 0
            s[30] = s[30] + edge_stillness_gather_d
            s[35] = edge_stillness_gather_d * edge_stillness_gather_d + s[35]
            edge_stillness_gather_e = edge_stillness_gather_d - s[77]
            s[76] = edge_stillness_gather_e * edge_stillness_gather_e + s[76]
            s[77] = edge_stillness_gather_d
            edge_stillness_gather_e = s[61]
            s[64] = s[64] + edge_stillness_gather_e
            edge_stillness_gather_d = r[5] - s[24]
            if edge_stillness_gather_d + 512 >> 10:
                s[18] = 6
                edge_stillness_gather_d = 0
            s[31] = s[31] + edge_stillness_gather_d
            s[35] = edge_stillness_gather_d * edge_stillness_gather_d + s[35]
            edge_stillness_gather_e = edge_stillness_gather_d - s[78]
            s[76] = edge_stillness_gather_e * edge_stillness_gather_e + s[76]
            s[78] = edge_stillness_gather_d
            edge_stillness_gather_e = s[62]
            s[65] = s[65] + edge_stillness_gather_e
            edge_stillness_gather_d = r[6] - s[25]
            if edge_stillness_gather_d + 512 >> 10:
                s[18] = 7
                edge_stillness_gather_d = 0
            s[32] = s[32] + edge_stillness_gather_d
            s[35] = edge_stillness_gather_d * edge_stillness_gather_d + s[35]
            edge_stillness_gather_e = edge_stillness_gather_d - s[79]
            s[76] = edge_stillness_gather_e * edge_stillness_gather_e + s[76]
            s[79] = edge_stillness_gather_d
            edge_stillness_gather_e = s[63]
            s[66] = s[66] + edge_stillness_gather_e
        else:
            edge_stillness_gather_d = r[3] - s[22]
            s[29] = s[29] + edge_stillness_gather_d
        if s[17] < c[3]:
            pass
    if edge_k:
        edge_i = 0
        edge_d = (r[4] << 8) - s[55] - s[61] + s[58] + 128
        f_edge_p[5] = edge_d >> 8
        s[58] = (edge_d & 255) - 128
        edge_d = (r[5] << 8) - s[56] - s[62] + s[59] + 128
        f_edge_p[6] = edge_d >> 8
        s[59] = (edge_d & 255) - 128
        edge_d = (r[6] << 8) - s[57] - s[63] + s[60] + 128
        f_edge_p[7] = edge_d >> 8
        s[60] = (edge_d & 255) - 128
        edge_i = 3
        f_edge_p[0] = 0
        r[7] = edge_p + 8


@micropython.viper
def one(step_step_examine_check_at_rail_i: int, r: ptr32, s: ptr32, c: ptr32, f: ptr32, s_, c_, r_):
    p = r[7]
    f_p = ptr32(int(f) + (p << 2))
    i = 0
    r[0] = f_p[1]
    r[1] = f_p[2]
    r[2] = f_p[3]
    r[3] = f_p[4]
    r[4] = f_p[5]
    r[5] = f_p[6]
    r[6] = f_p[7]
    i = 7
    i = f_p[0]
    step_step_examine_check_dt_us = i
    step_step_examine_check_step = r[3] - s[3]
    step_step_examine_check_exchange_same = 1
    if r[0] - s[0]:
        step_step_examine_check_exchange_same = 0
    s[0] = r[0]
    if r[1] - s[1]:
        step_step_examine_check_exchange_same = 0
    s[1] = r[1]
    if r[2] - s[2]:
        step_step_examine_check_exchange_same = 0
    s[2] = r[2]
    if r[3] - s[3]:
        step_step_examine_check_exchange_same = 0
    s[3] = r[3]
    if r[4] - s[4]:
        step_step_examine_check_exchange_same = 0
    s[4] = r[4]
    if r[5] - s[5]:
        step_step_examine_check_exchange_same = 0
    s[5] = r[5]
    if r[6] - s[6]:
        step_step_examine_check_exchange_same = 0
    s[6] = r[6]
    step_step_examine_check_repeats = step_step_examine_check_exchange_same
    step_step_examine_check_kind = 0
    if (not r[0] or not r[0] - -1) and int(all_alike(r_)):
        step_step_examine_check_kind = 3 - r[0]
    elif not s[8]:
        step_step_examine_check_kind = 0
    elif step_step_examine_check_dt_us <= 0:
        step_step_examine_check_kind = 6
    elif step_step_examine_check_dt_us > c[1]:
        step_step_examine_check_kind = 7
    elif step_step_examine_check_repeats:
        step_step_examine_check_kind = 1
    elif step_step_examine_check_step >= c[2] or step_step_examine_check_step <= -c[2]:
        step_step_examine_check_kind = 5
    if not step_step_examine_check_kind:
        while True:
            step_step_examine_check_at_rail_i = 4
            step_step_examine_check_at_rail_left = 0
            while step_step_examine_check_at_rail_i < 7:
                if r[step_step_examine_check_at_rail_i] > 32766 or r[step_step_examine_check_at_rail_i] < -32767:
                    step_step_examine_check_at_rail_result = 1
                    step_step_examine_check_at_rail_left = 1
                    break
                step_step_examine_check_at_rail_i = step_step_examine_check_at_rail_i + 1
            if step_step_examine_check_at_rail_left:
                break
            step_step_examine_check_at_rail_result = 0
            break
        if step_step_examine_check_at_rail_result:
            step_step_examine_check_kind = 2
    s[step_step_examine_check_kind + 8] = s[step_step_examine_check_kind + 8] + 1 & 536870911
    if step_step_examine_check_kind > 1:
        s[17] = 0
        s[18] = 0
        s[34] = 0
    elif step_step_examine_check_dt_us > 0 and step_step_examine_check_dt_us <= c[1]:
        step_step_examine_check_dt_us = step_step_examine_check_dt_us + s[16]
        s[16] = step_step_examine_check_dt_us if step_step_examine_check_dt_us < 536870911 else 536870911
    step_step_kind = step_step_examine_check_kind
    if not step_step_kind:
        if not s[17]:
            s[19] = r[0]
            s[26] = 0
            s[20] = r[1]
            s[27] = 0
            s[21] = r[2]
            s[28] = 0
            s[22] = r[3]
            s[29] = 0
            s[23] = r[4]
            s[30] = 0
            s[24] = r[5]
            s[31] = 0
            s[25] = r[6]
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
            step_step_admit_stillness_gather_d = r[0] - s[19]
            if step_step_admit_stillness_gather_d + 512 >> 10:
                s[18] = 1
                step_step_admit_stillness_gather_d = 0
            s[26] = s[26] + step_step_admit_stillness_gather_d
            s[33] = step_step_admit_stillness_gather_d * step_step_admit_stillness_gather_d + s[33]
            step_step_admit_stillness_gather_d = r[1] - s[20]
            if step_step_admit_stillness_gather_d + 512 >> 10:
                s[18] = 2
                step_step_admit_stillness_gather_d = 0
            s[27] = s[27] + step_step_admit_stillness_gather_d
            s[33] = step_step_admit_stillness_gather_d * step_step_admit_stillness_gather_d + s[33]
            step_step_admit_stillness_gather_d = r[2] - s[21]
            if step_step_admit_stillness_gather_d + 512 >> 10:
                s[18] = 3
                step_step_admit_stillness_gather_d = 0
            s[28] = s[28] + step_step_admit_stillness_gather_d
            s[33] = step_step_admit_stillness_gather_d * step_step_admit_stillness_gather_d + s[33]
            step_step_admit_stillness_gather_d = r[3] - s[22]
            if step_step_admit_stillness_gather_d + 512 >> 10:
                s[18] = 4
                step_step_admit_stillness_gather_d = 0
            s[29] = s[29] + step_step_admit_stillness_gather_d
            step_step_admit_stillness_gather_d = r[4] - s[23]
            if step_step_admit_stillness_gather_d + 512 >> 10:
                s[18] = 5
                step_step_admit_stillness_gather_d = 0
            s[30] = s[30] + step_step_admit_stillness_gather_d
            s[35] = step_step_admit_stillness_gather_d * step_step_admit_stillness_gather_d + s[35]
            step_step_admit_stillness_gather_e = step_step_admit_stillness_gather_d - s[77]
            s[76] = step_step_admit_stillness_gather_e * step_step_admit_stillness_gather_e + s[76]
            s[77] = step_step_admit_stillness_gather_d
            step_step_admit_stillness_gather_e = s[61]
            s[64] = s[64] + step_step_admit_stillness_gather_e
            step_step_admit_stillness_gather_d = r[5] - s[24]
            if step_step_admit_stillness_gather_d + 512 >> 10:
                s[18] = 6
                step_step_admit_stillness_gather_d = 0
            s[31] = s[31] + step_step_admit_stillness_gather_d
            s[35] = step_step_admit_stillness_gather_d * step_step_admit_stillness_gather_d + s[35]
            step_step_admit_stillness_gather_e = step_step_admit_stillness_gather_d - s[78]
            s[76] = step_step_admit_stillness_gather_e * step_step_admit_stillness_gather_e + s[76]
            s[78] = step_step_admit_stillness_gather_d
            step_step_admit_stillness_gather_e = s[62]
            s[65] = s[65] + step_step_admit_stillness_gather_e
            step_step_admit_stillness_gather_d = r[6] - s[25]
            if step_step_admit_stillness_gather_d + 512 >> 10:
                s[18] = 7
                step_step_admit_stillness_gather_d = 0
            s[32] = s[32] + step_step_admit_stillness_gather_d
            s[35] = step_step_admit_stillness_gather_d * step_step_admit_stillness_gather_d + s[35]
            step_step_admit_stillness_gather_e = step_step_admit_stillness_gather_d - s[79]
            s[76] = step_step_admit_stillness_gather_e * step_step_admit_stillness_gather_e + s[76]
            s[79] = step_step_admit_stillness_gather_d
            step_step_admit_stillness_gather_e = s[63]
            s[66] = s[66] + step_step_admit_stillness_gather_e
        else:
            step_step_admit_stillness_gather_d = r[3] - s[22]
            s[29] = s[29] + step_step_admit_stillness_gather_d
        if s[17] < c[3]:
            step_step_admit_stillness_gather_result = 0
        else:
            step_step_admit_stillness_gather_result = 1
        if step_step_admit_stillness_gather_result:
            close(0, s_, 0, c_, s_, c_)
        if not s[8] - 1 or not c[3] - 4:
            s[47] = r[3]
            s[53] = 1
            while s[53]:
                advance(c_, s_, s_, c_)
        if c[46]:
            learn_at_once(s_, c_, r_, s_, c_)
    step_step_admit_i = c[12]
    while step_step_admit_i > 0 and s[53]:
        advance(c_, s_, s_, c_)
        step_step_admit_i = step_step_admit_i - 1
    if step_step_kind > 2:
        step_step_result = step_step_kind
    else:
        step_step_step_finish_d = s[67] - s[55]
        if step_step_step_finish_d > c[11]:
            step_step_step_finish_d = c[11]
        elif step_step_step_finish_d < -c[11]:
            step_step_step_finish_d = -c[11]
        s[55] = s[55] + step_step_step_finish_d
        step_step_step_finish_d = (r[4] << 8) - s[55] - s[61] + s[58]
        r[4] = step_step_step_finish_d + 128 >> 8
        s[58] = step_step_step_finish_d - (r[4] << 8)
        step_step_step_finish_d = s[68] - s[56]
        if step_step_step_finish_d > c[11]:
            step_step_step_finish_d = c[11]
        elif step_step_step_finish_d < -c[11]:
            step_step_step_finish_d = -c[11]
        s[56] = s[56] + step_step_step_finish_d
        step_step_step_finish_d = (r[5] << 8) - s[56] - s[62] + s[59]
        r[5] = step_step_step_finish_d + 128 >> 8
        s[59] = step_step_step_finish_d - (r[5] << 8)
        step_step_step_finish_d = s[69] - s[57]
        if step_step_step_finish_d > c[11]:
            step_step_step_finish_d = c[11]
        elif step_step_step_finish_d < -c[11]:
            step_step_step_finish_d = -c[11]
        s[57] = s[57] + step_step_step_finish_d
        step_step_step_finish_d = (r[6] << 8) - s[57] - s[63] + s[60]
        r[6] = step_step_step_finish_d + 128 >> 8
        s[60] = step_step_step_finish_d - (r[6] << 8)
        step_step_result = step_step_kind
    f_p[0] = step_step_result
    i = 0
    f_p[1] = r[0]
    f_p[2] = r[1]
    f_p[3] = r[2]
    f_p[4] = r[3]
    f_p[5] = r[4]
    f_p[6] = r[5]
    f_p[7] = r[6]
    i = 7
    r[7] = p + 8


@micropython.viper
def block(s_, f_, c_, r_, n: int):
    s = ptr32(s_)
    c = ptr32(c_)
    r = ptr32(r_)
    r[7] = 0
    r[8] = n << 3
    while r[7] < r[8]:
        n = r[7]
        if not s[53] and s[17] < c[3] - 1:
            take(0, s_, r_, c_, f_)
        if not r[7] - n:
            one(0, r_, s_, c_, f_, s_, c_, r_)
