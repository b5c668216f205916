# Generated from zerorate/realtime.py by `make viper`: edit that file, not this one.
"""The bias against the accelerometer: counters of signs, stepped by a fixed value.

US 2015/0033821: a time interval of sub-units; in each, the angular rate that a pair of
accelerometer axes implies, its deviation from the gyroscope's, a counter; at the end of the
interval the offset moves by a first value if the counter says so. The axis x has the pair (y, z),
and so round.

With gravity g and rate w in the body frame g' = -w x g, so the pair's angle turns by
    atan2(gy, gz)' = wx - gx (wy gy + wz gz) / (gy^2 + gz^2):
the last term couples the other axes in. It is subtracted less its mean over 16 s, which is bias;
where gravity lies within 45 deg of the axis the sub-unit is not counted for it. Both sides are
means over the sub-unit of an angle, the gyroscope's being its running integral, so both see the
same motion in the same way.

The document's own form has one step, counts every sign and ends an interval after so many
sub-units; the default has a dead band, ends it after so many counted ones, doubles the step while
all signs agree and halves it when the counter turns."""

import micropython

from .atan2 import atan2_q13


@micropython.viper
def clear(s: ptr32, c: ptr32):
    i = 0
    while i < 55:
        s[i] = 0
        i = i + 1
    i = 0
    s[34] = c[7]
    s[31] = 536870911
    s[35] = c[7]
    s[32] = 536870911
    s[36] = c[7]
    s[33] = 536870911
    i = 3


@micropython.viper
def update(s_, c_, x: ptr32, dt_us: int) -> int:
    s = ptr32(s_)
    c = ptr32(c_)
    if dt_us <= 0 or dt_us > c[10]:
        s[0] = 0
        s[1] = 0
        s[20] = 0
        s[49] = 3
        begin_unit_i = 0
        s[1] = 0
        while begin_unit_i < 3:
            s[2 + begin_unit_i] = 0
            s[5 + begin_unit_i] = 0
            s[8 + begin_unit_i] = 0
            begin_unit_i = begin_unit_i + 1
        return 0
    realtime_gather_factor = dt_us * c[1] >> c[2]
    realtime_gather_shift = c[3]
    realtime_gather_i = 0
    while realtime_gather_i < 3:
        realtime_gather_turned = (x[4 + realtime_gather_i] << 8) - s[28 + realtime_gather_i]
        realtime_gather_scaled_b = realtime_gather_factor
        realtime_gather_scaled_high = realtime_gather_scaled_b >> 15
        realtime_gather_scaled_b = realtime_gather_scaled_b & 32767
        realtime_gather_scaled_middle = (realtime_gather_turned >> 15) * realtime_gather_scaled_b + (realtime_gather_turned & 32767) * realtime_gather_scaled_high + ((realtime_gather_turned & 32767) * realtime_gather_scaled_b >> 15)
        realtime_gather_scaled_high = (realtime_gather_turned >> 15) * realtime_gather_scaled_high
        realtime_gather_turned = (realtime_gather_scaled_high << 30 - realtime_gather_shift) + (realtime_gather_scaled_middle >> realtime_gather_shift - 15)
        realtime_gather_turned = realtime_gather_turned + s[2 + realtime_gather_i]
        s[2 + realtime_gather_i] = realtime_gather_turned
        realtime_gather_turned = realtime_gather_turned >> 9
        s[5 + realtime_gather_i] += realtime_gather_turned
        s[8 + realtime_gather_i] += x[realtime_gather_i]
        realtime_gather_i = realtime_gather_i + 1
    s[0] = s[0] + dt_us
    s[1] = s[1] + 1
    if s[0] < c[0]:
        return 0
    s[0] = s[0] - c[0]
    end_unit_i = 0
    end_unit_square = 0
    while end_unit_i < 3:
        end_unit_force = (s[8 + end_unit_i] // s[1] << 12) // c[9]
        if end_unit_force > 8191 or end_unit_force < -8191:
            end_unit_force = 8191
        s[8 + end_unit_i] = end_unit_force
        end_unit_square = end_unit_force * end_unit_force + end_unit_square
        end_unit_i = end_unit_i + 1
    end_unit_i = 16777216 - end_unit_square
    if end_unit_i > 3145728 or end_unit_i < -3145728:
        s[20] = 0
        s[50] = s[50] + 1
        s[49] = 2
    else:
        s[49] = 1
        end_unit_i = 0
        while end_unit_i < 3:
            compare(s_, c_, end_unit_i, end_unit_square)
            end_unit_i = end_unit_i + 1
    end_unit_begin_unit_i = 0
    s[1] = 0
    while end_unit_begin_unit_i < 3:
        s[2 + end_unit_begin_unit_i] = 0
        s[5 + end_unit_begin_unit_i] = 0
        s[8 + end_unit_begin_unit_i] = 0
        end_unit_begin_unit_i = end_unit_begin_unit_i + 1
    s[21] = s[21] + 1
    return int(end_interval(s_, c_))


@micropython.viper
def compare(s: ptr32, c: ptr32, i: int, square: int):
    s_i = ptr32(int(s) + (i << 2))
    across = square - s_i[8] * s_i[8]
    if across < 8388608 or int(too_far(s_i[2] >> 9)):
        s[20] = 7 - (1 << i) & s[20]
        return
    since_last_square = across >> 12
    since_last_mean = s_i[5] // s[1]
    since_last_deviation = since_last_mean - s_i[11] + s_i[14]
    s_i[11] = since_last_mean - (s_i[2] >> 9)
    since_last_pair_angle_q13_j = i + 1 if i < 2 else 0
    since_last_pair_angle_q13_k = i - 1 if i > 0 else 2
    since_last_mean = int(atan2_q13(s[since_last_pair_angle_q13_k + 8], s[since_last_pair_angle_q13_j + 8]))
    s_i[14] = since_last_mean
    since_last_deviation = since_last_deviation - since_last_mean
    since_last_coupled_q13_square = since_last_square >> 2
    since_last_coupled_q13_along_q12_j = i + 1 if i < 2 else 0
    s_since_last_coupled_q13_along_q12_j = ptr32(int(s) + (since_last_coupled_q13_along_q12_j << 2))
    since_last_coupled_q13_along_q12_k = i - 1 if i > 0 else 2
    s_since_last_coupled_q13_along_q12_k = ptr32(int(s) + (since_last_coupled_q13_along_q12_k << 2))
    since_last_coupled_q13_along_q12_held_angle = s_since_last_coupled_q13_along_q12_j[2] >> 9
    if since_last_coupled_q13_along_q12_held_angle > 32767:
        since_last_coupled_q13_along_q12_held_result = 32767
    elif since_last_coupled_q13_along_q12_held_angle < -32767:
        since_last_coupled_q13_along_q12_held_result = -32767
    else:
        since_last_coupled_q13_along_q12_held_result = since_last_coupled_q13_along_q12_held_angle
    since_last_coupled_q13_along_q12_first = since_last_coupled_q13_along_q12_held_result * s_since_last_coupled_q13_along_q12_j[8]
    since_last_coupled_q13_along_q12_held_angle = s_since_last_coupled_q13_along_q12_k[2] >> 9
    if since_last_coupled_q13_along_q12_held_angle > 32767:
        since_last_coupled_q13_along_q12_held_result = 32767
    elif since_last_coupled_q13_along_q12_held_angle < -32767:
        since_last_coupled_q13_along_q12_held_result = -32767
    else:
        since_last_coupled_q13_along_q12_held_result = since_last_coupled_q13_along_q12_held_angle
    since_last_coupled_q13_along = since_last_coupled_q13_along_q12_held_result * s_since_last_coupled_q13_along_q12_k[8] + since_last_coupled_q13_along_q12_first >> 13
    since_last_coupled_q13_mean = s_i[51]
    since_last_coupled_q13_mean = ((since_last_coupled_q13_along << 8) - since_last_coupled_q13_mean >> 5) + since_last_coupled_q13_mean
    s_i[51] = since_last_coupled_q13_mean
    since_last_coupled_q13_along = since_last_coupled_q13_along - (since_last_coupled_q13_mean >> 8)
    since_last_mean = (s_i[8] >> 1) * since_last_coupled_q13_along // since_last_coupled_q13_square
    since_last_deviation = since_last_deviation - (since_last_mean + s_i[17] >> 1)
    s_i[17] = since_last_mean
    while since_last_deviation > 25736:
        since_last_deviation = since_last_deviation - 51472
    while since_last_deviation < -25736:
        since_last_deviation = since_last_deviation + 51472
    across = since_last_deviation
    if 1 << i & s[20]:
        s_i[25] = s_i[25] + 1
        s_i[37] = s_i[37] + 1
        count_spread_deviation = across
        if count_spread_deviation >> 30:
            count_spread_deviation = -count_spread_deviation
        if count_spread_deviation > 8192:
            count_spread_deviation = 8192
        s[54] = ((count_spread_deviation << 8) - s[54] >> 6) + s[54]
        if across > c[6]:
            s_i[22] = s_i[22] + 1
        elif across < -c[6]:
            s_i[22] = s_i[22] - 1
    s[20] = 1 << i | s[20]


@micropython.viper
def too_far(turned: int) -> int:
    if turned > 32767 or turned < -32767:
        return 1
    return 0


@micropython.viper
def count(s: ptr32, c: ptr32, i: int, deviation: int):
    s_i = ptr32(int(s) + (i << 2))
    s_i[25] = s_i[25] + 1
    s_i[37] = s_i[37] + 1
    spread_deviation = deviation
    if spread_deviation >> 30:
        spread_deviation = -spread_deviation
    if spread_deviation > 8192:
        spread_deviation = 8192
    s[54] = ((spread_deviation << 8) - s[54] >> 6) + s[54]
    if deviation > c[6]:
        s_i[22] = s_i[22] + 1
    elif deviation < -c[6]:
        s_i[22] = s_i[22] - 1


@micropython.viper
def end_interval(s: ptr32, c: ptr32) -> int:
    ended = 0
    if s[25] >= c[4] or (not c[11] and s[21] >= c[4]):
        if c[11]:
            end_axis_size_step_most = s[22]
            end_axis_size_step_sign = 1
            if end_axis_size_step_most >> 30:
                end_axis_size_step_most = -end_axis_size_step_most
                end_axis_size_step_sign = -1
            if end_axis_size_step_most <= c[5]:
                pass
            else:
                if not s[40] + end_axis_size_step_sign:
                    s[43] = s[43] + 1
                    if s[34] > c[8]:
                        s[34] = s[34] >> 1
                elif end_axis_size_step_most >= s[25] and s[34] < c[7] * 8:
                    s[34] = s[34] << 1
                s[40] = end_axis_size_step_sign
        end_axis_realtime_step_moved = 0
        if s[22] > c[5]:
            end_axis_realtime_step_moved = s[34]
            s[28] = s[28] + end_axis_realtime_step_moved
        elif s[22] < -c[5]:
            end_axis_realtime_step_moved = s[34]
            s[28] = s[28] - end_axis_realtime_step_moved
        s[46] = (end_axis_realtime_step_moved - s[46] >> 3) + s[46]
        if s[43] < 3 and c[11]:
            pass
        else:
            end_axis_realtime_judge_pushed = s[54] * c[11] >> 10
            s[31] = (s[46] << 1) + s[34] + (c[8] << 2) + end_axis_realtime_judge_pushed
        s[22] = 0
        s[25] = 0
        ended = 1
    if s[26] >= c[4] or (not c[11] and s[21] >= c[4]):
        if c[11]:
            end_axis_size_step_most = s[23]
            end_axis_size_step_sign = 1
            if end_axis_size_step_most >> 30:
                end_axis_size_step_most = -end_axis_size_step_most
                end_axis_size_step_sign = -1
            if end_axis_size_step_most <= c[5]:
                pass
            else:
                if not s[41] + end_axis_size_step_sign:
                    s[44] = s[44] + 1
                    if s[35] > c[8]:
                        s[35] = s[35] >> 1
                elif end_axis_size_step_most >= s[26] and s[35] < c[7] * 8:
                    s[35] = s[35] << 1
                s[41] = end_axis_size_step_sign
        end_axis_realtime_step_moved = 0
        if s[23] > c[5]:
            end_axis_realtime_step_moved = s[35]
            s[29] = s[29] + end_axis_realtime_step_moved
        elif s[23] < -c[5]:
            end_axis_realtime_step_moved = s[35]
            s[29] = s[29] - end_axis_realtime_step_moved
        s[47] = (end_axis_realtime_step_moved - s[47] >> 3) + s[47]
        if s[44] < 3 and c[11]:
            pass
        else:
            end_axis_realtime_judge_pushed = s[54] * c[11] >> 10
            s[32] = (s[47] << 1) + s[35] + (c[8] << 2) + end_axis_realtime_judge_pushed
        s[23] = 0
        s[26] = 0
        ended = 1
    if s[27] >= c[4] or (not c[11] and s[21] >= c[4]):
        if c[11]:
            end_axis_size_step_most = s[24]
            end_axis_size_step_sign = 1
            if end_axis_size_step_most >> 30:
                end_axis_size_step_most = -end_axis_size_step_most
                end_axis_size_step_sign = -1
            if end_axis_size_step_most <= c[5]:
                pass
            else:
                if not s[42] + end_axis_size_step_sign:
                    s[45] = s[45] + 1
                    if s[36] > c[8]:
                        s[36] = s[36] >> 1
                elif end_axis_size_step_most >= s[27] and s[36] < c[7] * 8:
                    s[36] = s[36] << 1
                s[42] = end_axis_size_step_sign
        end_axis_realtime_step_moved = 0
        if s[24] > c[5]:
            end_axis_realtime_step_moved = s[36]
            s[30] = s[30] + end_axis_realtime_step_moved
        elif s[24] < -c[5]:
            end_axis_realtime_step_moved = s[36]
            s[30] = s[30] - end_axis_realtime_step_moved
        s[48] = (end_axis_realtime_step_moved - s[48] >> 3) + s[48]
        if s[45] < 3 and c[11]:
            pass
        else:
            end_axis_realtime_judge_pushed = s[54] * c[11] >> 10
            s[33] = (s[48] << 1) + s[36] + (c[8] << 2) + end_axis_realtime_judge_pushed
        s[24] = 0
        s[27] = 0
        ended = 1
    if s[21] >= c[4]:
        s[21] = 0
    return ended


@micropython.viper
def step(s: ptr32, c: ptr32, i: int):
    s_i = ptr32(int(s) + (i << 2))
    moved = 0
    if s_i[22] > c[5]:
        moved = s_i[34]
        s_i[28] = s_i[28] + moved
    elif s_i[22] < -c[5]:
        moved = s_i[34]
        s_i[28] = s_i[28] - moved
    s_i[46] = (moved - s_i[46] >> 3) + s_i[46]


@micropython.viper
def judge(s: ptr32, c: ptr32, i: int):
    s_i = ptr32(int(s) + (i << 2))
    if s_i[43] < 3 and c[11]:
        return
    pushed = s[54] * c[11] >> 10
    s_i[31] = (s_i[46] << 1) + s_i[34] + (c[8] << 2) + pushed
