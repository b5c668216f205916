# Generated from zerorate/in_motion.py by `make viper`: edit that file, not this one.
"""The bias from motion that returns: the slope of integrated orientation over a stored window.

US 10,451,438: store the rates, find the stretch that moves, integrate it to orientation, fit a
line, take the slope as bias, remove it, integrate again. Two forms:

- the document's own: each axis' slope of the orientation vector is that axis' bias;
- the default: tilt comes from gravity in the level frame, only the heading from the assumption
  that it returns; slopes are mapped to the body by the integrated rotation matrix, tapered, and
  joined with what earlier windows know by weights that the window's own residual sets.

A window grows from 2 s while nothing is known, for a large bias turns a long one too far to be
linear. Work is spread: a few nodes or one piece of algebra a sample. The state is one array('i')
of 241 words and 3 a node; motion_settings.py makes the settings."""

import micropython

from .atan2 import atan2_q13
from .attitude import rotation
from .fixed import root
from .increments import close
from .least_squares import covariance
from .least_squares import element
from .least_squares import noise
from .least_squares import own_square
from .least_squares import prior_place
from .least_squares import spread_prior
from .least_squares import step
from .least_squares import sweep
from .least_squares import weigh
from .least_squares import weights
from .motion_verdict import finish
from .motion_verdict import start_window
from .real import add_smaller
from .real import divide
from .real import multiply
from .real import subtract
from .regression import centre
from .thermal import carry
from .thermal import follow_temperature


@micropython.viper
def update(s_, c_, x: ptr32, dt_us: int) -> int:
    s = ptr32(s_)
    c = ptr32(c_)
    if dt_us <= 0 or dt_us > c[6]:
        restart_i = 0
        while restart_i < 10 + 1:
            s[restart_i] = 0
            restart_i = restart_i + 1
        s[13] = 0
        s[17] = 7
        return 0
    increments_gather_convert_factor = dt_us * c[1] >> c[2]
    increments_gather_convert_i = 0
    increments_gather_convert_half = 1 << c[3] - 1
    while increments_gather_convert_i < 3:
        s[19 + increments_gather_convert_i] = x[4 + increments_gather_convert_i] * increments_gather_convert_factor + increments_gather_convert_half >> c[3]
        increments_gather_convert_increments_within_value = x[increments_gather_convert_i] * c[4] + 4096 >> 13
        if increments_gather_convert_increments_within_value > 32767:
            increments_gather_convert_increments_within_result = 32767
        elif increments_gather_convert_increments_within_value < 0 - 32767:
            increments_gather_convert_increments_within_result = 0 - 32767
        else:
            increments_gather_convert_increments_within_result = increments_gather_convert_increments_within_value
        s[211 + increments_gather_convert_i] = increments_gather_convert_increments_within_result
        increments_gather_convert_i = increments_gather_convert_i + 1
    increments_gather_coning_first = (s[2 + 1] + 512 >> 10) * (s[19 + 2] + 256 >> 9)
    increments_gather_coning_result = increments_gather_coning_first - (s[2 + 2] + 512 >> 10) * (s[19 + 1] + 256 >> 9) + 32 >> 6
    s[203] = increments_gather_coning_result
    increments_gather_coning_first = (s[2 + 2] + 512 >> 10) * (s[19 + 0] + 256 >> 9)
    increments_gather_coning_result = increments_gather_coning_first - (s[2 + 0] + 512 >> 10) * (s[19 + 2] + 256 >> 9) + 32 >> 6
    s[203 + 1] = increments_gather_coning_result
    increments_gather_coning_first = (s[2 + 0] + 512 >> 10) * (s[19 + 1] + 256 >> 9)
    increments_gather_coning_result = increments_gather_coning_first - (s[2 + 1] + 512 >> 10) * (s[19 + 0] + 256 >> 9) + 32 >> 6
    s[203 + 2] = increments_gather_coning_result
    increments_gather_carried_first = (s[2 + 1] + 1024 >> 11) * s[211 + 2]
    increments_gather_carried_result = increments_gather_carried_first - (s[2 + 2] + 1024 >> 11) * s[211 + 1] + 4096 >> 13
    s[206] = increments_gather_carried_result
    increments_gather_carried_first = (s[2 + 2] + 1024 >> 11) * s[211 + 0]
    increments_gather_carried_result = increments_gather_carried_first - (s[2 + 0] + 1024 >> 11) * s[211 + 2] + 4096 >> 13
    s[206 + 1] = increments_gather_carried_result
    increments_gather_carried_first = (s[2 + 0] + 1024 >> 11) * s[211 + 1]
    increments_gather_carried_result = increments_gather_carried_first - (s[2 + 1] + 1024 >> 11) * s[211 + 0] + 4096 >> 13
    s[206 + 2] = increments_gather_carried_result
    increments_gather_increments_advance_i = 0
    while increments_gather_increments_advance_i < 3:
        s[5 + increments_gather_increments_advance_i] += s[211 + increments_gather_increments_advance_i] + s[206 + increments_gather_increments_advance_i]
        increments_gather_increments_advance_angle = s[2 + increments_gather_increments_advance_i] + s[19 + increments_gather_increments_advance_i] + s[203 + increments_gather_increments_advance_i]
        if increments_gather_increments_advance_angle > 33554431:
            increments_gather_increments_advance_increments_within_result = 33554431
        elif increments_gather_increments_advance_angle < 0 - 33554431:
            increments_gather_increments_advance_increments_within_result = 0 - 33554431
        else:
            increments_gather_increments_advance_increments_within_result = increments_gather_increments_advance_angle
        s[2 + increments_gather_increments_advance_i] = increments_gather_increments_advance_increments_within_result
        if s[2 + increments_gather_increments_advance_i] - increments_gather_increments_advance_angle:
            s[64] = c[8]
        increments_gather_increments_advance_i = increments_gather_increments_advance_i + 1
    s[1] = s[1] + 1
    s[0] = s[0] + dt_us
    if s[0] < c[0]:
        increments_gather_result = 0
    else:
        increments_gather_result = 1
    if increments_gather_result:
        follow_temperature(s_, x[3])
        close(s_, c_)
    if not s[13]:
        if int(start_window(s_, c_, s_, c_)):
            begin_traversal(s_)
        return 0
    return int(work(s_, c_, s_, c_))


@micropython.viper
def work(s: ptr32, c: ptr32, s_, c_) -> int:
    if not s[13] - 2:
        return int(solve(s_, c_, s_, c_))
    i = c[5]
    while i > 0 and (not s[13] - 1):
        visit(s_, 0, c_, s_)
        i = i - 1
    return 0


@micropython.viper
def begin_traversal(s: ptr32):
    i = 0
    while i < 63:
        s[i + 86] = 0
        i = i + 1
    i = 0
    whole_shift = 0
    whole_m = s[179]
    whole_shift = whole_shift + s[180]
    if whole_shift > 1 and whole_m:
        whole_m = 536870911 if whole_m > 0 else -536870911
    elif not whole_shift >> 30:
        whole_m = whole_m << whole_shift
    elif whole_shift > -30:
        whole_m = (1 << -1 - whole_shift) + whole_m >> 0 - whole_shift
    else:
        whole_m = 0
    whole_result = whole_m
    s[57] = whole_result
    s[54] = 0
    whole_shift = 0
    whole_m = s[181]
    whole_shift = whole_shift + s[182]
    if whole_shift > 1 and whole_m:
        whole_m = 536870911 if whole_m > 0 else -536870911
    elif not whole_shift >> 30:
        whole_m = whole_m << whole_shift
    elif whole_shift > -30:
        whole_m = (1 << -1 - whole_shift) + whole_m >> 0 - whole_shift
    else:
        whole_m = 0
    whole_result = whole_m
    s[58] = whole_result
    s[55] = 0
    whole_shift = 0
    whole_m = s[183]
    whole_shift = whole_shift + s[184]
    if whole_shift > 1 and whole_m:
        whole_m = 536870911 if whole_m > 0 else -536870911
    elif not whole_shift >> 30:
        whole_m = whole_m << whole_shift
    elif whole_shift > -30:
        whole_m = (1 << -1 - whole_shift) + whole_m >> 0 - whole_shift
    else:
        whole_m = 0
    whole_result = whole_m
    s[59] = whole_result
    s[56] = 0
    i = 3
    i = 0
    while i < 9:
        s[i + 42] = s[i + 214]
        i = i + 1
    s[63] = 0
    s[18] = 0
    s[65] = 0
    s[66] = 0
    s[15] = 0
    s[13] = 1
    s[25] = s[29] << 14
    s[26] = s[30] << 14
    s[27] = s[31] << 14
    s[28] = s[32] << 14
    s[23] = 0
    s[24] = 0


@micropython.viper
def visit(s: ptr32, sum_up_i: int, c: ptr32, s_):
    a = s[16] + s[15]
    s_a = ptr32(int(s) + (a << 2))
    if a >= c[8]:
        a = a - c[8]
        s_a = ptr32(int(s) + (a << 2))
    a = 3 * a + 241
    s_a = ptr32(int(s) + (a << 2))
    taper_k = s[15]
    taper_stage = s[12]
    taper_even = c[20]
    taper_t = 2 * taper_k + 1 - (1 << taper_stage) << 10 - taper_stage
    taper_square = taper_t * taper_t >> 10
    taper_weight = (1024 - taper_square) * (1024 - taper_square) >> 10
    s[61] = (7 * taper_square - 1024) * taper_weight >> 10
    s[62] = ((3 * taper_square - 1024) * taper_t >> 10) * taper_weight >> 10
    if taper_even:
        taper_weight = 1024
    s[60] = taper_weight
    s[18] = s[18] + taper_weight
    rotation(s_)
    if c[20]:
        observe_vector_i = 0
        while observe_vector_i < 9:
            s[observe_vector_i + 33] = 0
            observe_vector_i = observe_vector_i + 1
        observe_vector_i = 0
        s[33] = 16384
        s[51] = s[26] >> 15
        if s[25] >> 30:
            s[51] = -s[51]
        s[37] = 16384
        s[52] = s[27] >> 15
        if s[25] >> 30:
            s[52] = -s[52]
        s[41] = 16384
        s[53] = s[28] >> 15
        if s[25] >> 30:
            s[53] = -s[53]
        observe_vector_i = 3
    else:
        level_observe_force_q12_total = 0
        level_observe_force_q12_total = ((s_a[0] & 32767 ^ 16384) - 16384) * s[36] + level_observe_force_q12_total
        level_observe_force_q12_total = ((s_a[1] & 32767 ^ 16384) - 16384) * s[37] + level_observe_force_q12_total
        level_observe_force_q12_total = ((s_a[2] & 32767 ^ 16384) - 16384) * s[38] + level_observe_force_q12_total
        level_observe_force = level_observe_force_q12_total + 8192 >> 14
        if level_observe_force > 32767:
            level_observe_increments_within_result = 32767
        elif level_observe_force < -32767:
            level_observe_increments_within_result = -32767
        else:
            level_observe_increments_within_result = level_observe_force
        s[51] = -level_observe_increments_within_result
        level_observe_force_q12_total = 0
        level_observe_force_q12_total = ((s_a[0] & 32767 ^ 16384) - 16384) * s[33] + level_observe_force_q12_total
        level_observe_force_q12_total = ((s_a[1] & 32767 ^ 16384) - 16384) * s[34] + level_observe_force_q12_total
        level_observe_force_q12_total = ((s_a[2] & 32767 ^ 16384) - 16384) * s[35] + level_observe_force_q12_total
        level_observe_force = level_observe_force_q12_total + 8192 >> 14
        if level_observe_force > 32767:
            level_observe_increments_within_result = 32767
        elif level_observe_force < -32767:
            level_observe_increments_within_result = -32767
        else:
            level_observe_increments_within_result = level_observe_force
        s[52] = level_observe_increments_within_result
        level_observe_force_q12_total = 0
        level_observe_force_q12_total = ((s_a[0] & 32767 ^ 16384) - 16384) * s[39] + level_observe_force_q12_total
        level_observe_force_q12_total = ((s_a[1] & 32767 ^ 16384) - 16384) * s[40] + level_observe_force_q12_total
        level_observe_force_q12_total = ((s_a[2] & 32767 ^ 16384) - 16384) * s[41] + level_observe_force_q12_total
        level_observe_force = level_observe_force_q12_total + 8192 >> 14
        s[63] = (s[60] * level_observe_force + 512 >> 10) + s[63]
        level_observe_heading_q12_w = s[25] + 8192 >> 14
        level_observe_heading_q12_x = s[26] + 8192 >> 14
        level_observe_heading_q12_y = s[27] + 8192 >> 14
        level_observe_heading_q12_z = s[28] + 8192 >> 14
        level_observe_heading_q12_real = level_observe_heading_q12_w * s[29] + level_observe_heading_q12_x * s[30] + level_observe_heading_q12_y * s[31] + level_observe_heading_q12_z * s[32]
        level_observe_heading_q12_z = level_observe_heading_q12_z * s[29] - level_observe_heading_q12_w * s[32] - level_observe_heading_q12_x * s[31] + level_observe_heading_q12_y * s[30]
        level_observe_heading = int(atan2_q13(level_observe_heading_q12_real, level_observe_heading_q12_z))
        level_observe_turned = level_observe_heading - s[23]
        s[23] = level_observe_heading
        if level_observe_turned > 25736:
            s[24] = s[24] - 1
        elif level_observe_turned < -25736:
            s[24] = s[24] + 1
        level_observe_increments_within_value = s[24]
        if level_observe_increments_within_value > 3:
            level_observe_increments_within_result = 3
        elif level_observe_increments_within_value < -3:
            level_observe_increments_within_result = -3
        else:
            level_observe_increments_within_result = level_observe_increments_within_value
        level_observe_heading = level_observe_increments_within_result * 51472 + level_observe_heading
        if level_observe_heading > 32767:
            level_observe_increments_within_result = 32767
        elif level_observe_heading < -32767:
            level_observe_increments_within_result = -32767
        else:
            level_observe_increments_within_result = level_observe_heading
        s[53] = level_observe_increments_within_result
    sum_up_i = 0
    while sum_up_i < 9:
        s[sum_up_i + 42] += s[sum_up_i + 33] >> 1
        sum_up_i = sum_up_i + 1
    sum_up_i = 0
    sum_up_regressors_shift = s[12]
    sum_up_regressors_m = (1 << sum_up_regressors_shift - 1) + s[42] >> sum_up_regressors_shift
    s[203] = sum_up_regressors_m
    s[206] = s[60] * sum_up_regressors_m + 512 >> 10
    sum_up_regressors_m = (1 << sum_up_regressors_shift - 1) + s[43] >> sum_up_regressors_shift
    s[204] = sum_up_regressors_m
    s[207] = s[60] * sum_up_regressors_m + 512 >> 10
    sum_up_regressors_m = (1 << sum_up_regressors_shift - 1) + s[44] >> sum_up_regressors_shift
    s[205] = sum_up_regressors_m
    s[208] = s[60] * sum_up_regressors_m + 512 >> 10
    sum_up_first_sums_y = s[51]
    s[92] = (s[206] * sum_up_first_sums_y + 512 >> 10) + s[92]
    s[95] = s[95] + s[206]
    s[99] = (s[61] * s[203] + 512 >> 10) + s[99]
    s[102] = (s[62] * s[203] + 512 >> 10) + s[102]
    s[93] = (s[207] * sum_up_first_sums_y + 512 >> 10) + s[93]
    s[96] = s[96] + s[207]
    s[100] = (s[61] * s[204] + 512 >> 10) + s[100]
    s[103] = (s[62] * s[204] + 512 >> 10) + s[103]
    s[94] = (s[208] * sum_up_first_sums_y + 512 >> 10) + s[94]
    s[97] = s[97] + s[208]
    s[101] = (s[61] * s[205] + 512 >> 10) + s[101]
    s[104] = (s[62] * s[205] + 512 >> 10) + s[104]
    s[98] = (s[60] * sum_up_first_sums_y + 512 >> 10) + s[98]
    s[105] = (s[61] * sum_up_first_sums_y + 512 >> 10) + s[105]
    s[106] = (s[62] * sum_up_first_sums_y + 512 >> 10) + s[106]
    sum_up_second_sums_a = 86
    s[86] = (s[206] * s[203] + 512 >> 10) + s[86]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    s[sum_up_second_sums_a] = (s[206] * s[204] + 512 >> 10) + s[sum_up_second_sums_a]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    s[sum_up_second_sums_a] = (s[206] * s[205] + 512 >> 10) + s[sum_up_second_sums_a]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    s[sum_up_second_sums_a] = (s[207] * s[204] + 512 >> 10) + s[sum_up_second_sums_a]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    s[sum_up_second_sums_a] = (s[207] * s[205] + 512 >> 10) + s[sum_up_second_sums_a]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    s[sum_up_second_sums_a] = (s[208] * s[205] + 512 >> 10) + s[sum_up_second_sums_a]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    sum_up_regressors_shift = s[12]
    sum_up_regressors_m = (1 << sum_up_regressors_shift - 1) + s[45] >> sum_up_regressors_shift
    s[203] = sum_up_regressors_m
    s[206] = s[60] * sum_up_regressors_m + 512 >> 10
    sum_up_regressors_m = (1 << sum_up_regressors_shift - 1) + s[46] >> sum_up_regressors_shift
    s[204] = sum_up_regressors_m
    s[207] = s[60] * sum_up_regressors_m + 512 >> 10
    sum_up_regressors_m = (1 << sum_up_regressors_shift - 1) + s[47] >> sum_up_regressors_shift
    s[205] = sum_up_regressors_m
    s[208] = s[60] * sum_up_regressors_m + 512 >> 10
    sum_up_first_sums_y = s[52]
    s[113] = (s[206] * sum_up_first_sums_y + 512 >> 10) + s[113]
    s[116] = s[116] + s[206]
    s[120] = (s[61] * s[203] + 512 >> 10) + s[120]
    s[123] = (s[62] * s[203] + 512 >> 10) + s[123]
    s[114] = (s[207] * sum_up_first_sums_y + 512 >> 10) + s[114]
    s[117] = s[117] + s[207]
    s[121] = (s[61] * s[204] + 512 >> 10) + s[121]
    s[124] = (s[62] * s[204] + 512 >> 10) + s[124]
    s[115] = (s[208] * sum_up_first_sums_y + 512 >> 10) + s[115]
    s[118] = s[118] + s[208]
    s[122] = (s[61] * s[205] + 512 >> 10) + s[122]
    s[125] = (s[62] * s[205] + 512 >> 10) + s[125]
    s[119] = (s[60] * sum_up_first_sums_y + 512 >> 10) + s[119]
    s[126] = (s[61] * sum_up_first_sums_y + 512 >> 10) + s[126]
    s[127] = (s[62] * sum_up_first_sums_y + 512 >> 10) + s[127]
    sum_up_second_sums_a = 107
    s[107] = (s[206] * s[203] + 512 >> 10) + s[107]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    s[sum_up_second_sums_a] = (s[206] * s[204] + 512 >> 10) + s[sum_up_second_sums_a]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    s[sum_up_second_sums_a] = (s[206] * s[205] + 512 >> 10) + s[sum_up_second_sums_a]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    s[sum_up_second_sums_a] = (s[207] * s[204] + 512 >> 10) + s[sum_up_second_sums_a]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    s[sum_up_second_sums_a] = (s[207] * s[205] + 512 >> 10) + s[sum_up_second_sums_a]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    s[sum_up_second_sums_a] = (s[208] * s[205] + 512 >> 10) + s[sum_up_second_sums_a]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    sum_up_regressors_shift = s[12]
    sum_up_regressors_m = (1 << sum_up_regressors_shift - 1) + s[48] >> sum_up_regressors_shift
    s[203] = sum_up_regressors_m
    s[206] = s[60] * sum_up_regressors_m + 512 >> 10
    sum_up_regressors_m = (1 << sum_up_regressors_shift - 1) + s[49] >> sum_up_regressors_shift
    s[204] = sum_up_regressors_m
    s[207] = s[60] * sum_up_regressors_m + 512 >> 10
    sum_up_regressors_m = (1 << sum_up_regressors_shift - 1) + s[50] >> sum_up_regressors_shift
    s[205] = sum_up_regressors_m
    s[208] = s[60] * sum_up_regressors_m + 512 >> 10
    sum_up_first_sums_y = s[53]
    s[134] = (s[206] * sum_up_first_sums_y + 512 >> 10) + s[134]
    s[137] = s[137] + s[206]
    s[141] = (s[61] * s[203] + 512 >> 10) + s[141]
    s[144] = (s[62] * s[203] + 512 >> 10) + s[144]
    s[135] = (s[207] * sum_up_first_sums_y + 512 >> 10) + s[135]
    s[138] = s[138] + s[207]
    s[142] = (s[61] * s[204] + 512 >> 10) + s[142]
    s[145] = (s[62] * s[204] + 512 >> 10) + s[145]
    s[136] = (s[208] * sum_up_first_sums_y + 512 >> 10) + s[136]
    s[139] = s[139] + s[208]
    s[143] = (s[61] * s[205] + 512 >> 10) + s[143]
    s[146] = (s[62] * s[205] + 512 >> 10) + s[146]
    s[140] = (s[60] * sum_up_first_sums_y + 512 >> 10) + s[140]
    s[147] = (s[61] * sum_up_first_sums_y + 512 >> 10) + s[147]
    s[148] = (s[62] * sum_up_first_sums_y + 512 >> 10) + s[148]
    sum_up_second_sums_a = 128
    s[128] = (s[206] * s[203] + 512 >> 10) + s[128]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    s[sum_up_second_sums_a] = (s[206] * s[204] + 512 >> 10) + s[sum_up_second_sums_a]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    s[sum_up_second_sums_a] = (s[206] * s[205] + 512 >> 10) + s[sum_up_second_sums_a]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    s[sum_up_second_sums_a] = (s[207] * s[204] + 512 >> 10) + s[sum_up_second_sums_a]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    s[sum_up_second_sums_a] = (s[207] * s[205] + 512 >> 10) + s[sum_up_second_sums_a]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    s[sum_up_second_sums_a] = (s[208] * s[205] + 512 >> 10) + s[sum_up_second_sums_a]
    sum_up_second_sums_a = sum_up_second_sums_a + 1
    sum_up_i = 3
    sum_up_i = 0
    while sum_up_i < 9:
        s[sum_up_i + 42] += s[sum_up_i + 33] - (s[sum_up_i + 33] >> 1)
        sum_up_i = sum_up_i + 1
    s[54] = s[54] + s[57]
    remove_bias_part = s[54] + 1024 >> 11
    s[54] = s[54] - (remove_bias_part << 11)
    remove_bias_part = (s_a[0] >> 15) - remove_bias_part
    s[19] = remove_bias_part
    s[65] = (remove_bias_part if remove_bias_part > 0 else 0 - remove_bias_part) + s[65]
    s[55] = s[55] + s[58]
    remove_bias_part = s[55] + 1024 >> 11
    s[55] = s[55] - (remove_bias_part << 11)
    remove_bias_part = (s_a[1] >> 15) - remove_bias_part
    s[20] = remove_bias_part
    s[65] = (remove_bias_part if remove_bias_part > 0 else 0 - remove_bias_part) + s[65]
    s[56] = s[56] + s[59]
    remove_bias_part = s[56] + 1024 >> 11
    s[56] = s[56] - (remove_bias_part << 11)
    remove_bias_part = (s_a[2] >> 15) - remove_bias_part
    s[21] = remove_bias_part
    s[65] = (remove_bias_part if remove_bias_part > 0 else 0 - remove_bias_part) + s[65]
    tilting_row = 0
    tilting_row = tilting_row + 33
    tilting_part = s[tilting_row] * s[19] + s[tilting_row + 1] * s[20]
    tilting_part = s[tilting_row + 2] * s[21] + tilting_part + 8192 >> 14
    a = tilting_part if tilting_part > 0 else 0 - tilting_part
    s_a = ptr32(int(s) + (a << 2))
    tilting_row = 3
    tilting_row = tilting_row + 33
    tilting_part = s[tilting_row] * s[19] + s[tilting_row + 1] * s[20]
    tilting_part = s[tilting_row + 2] * s[21] + tilting_part + 8192 >> 14
    tilting_result = tilting_part if tilting_part > 0 else 0 - tilting_part
    a = a + tilting_result
    s_a = ptr32(int(s) + (a << 2))
    s[66] = s[66] + a
    sines_square = s[19] * s[19] + s[20] * s[20] + s[21] * s[21] >> 14
    sines_fourth = (sines_square >> 1) * (sines_square >> 1) >> 12
    sines_factor = 16384 - (sines_square * 2731 >> 14) + (sines_fourth * 137 >> 14)
    s[19] = s[19] * sines_factor + 2048 >> 12
    s[20] = s[20] * sines_factor + 2048 >> 12
    s[21] = s[21] * sines_factor + 2048 >> 12
    sines_factor = ((sines_fourth >> 1) * (sines_square >> 1) >> 12) * 23
    s[22] = (sines_fourth * 2731 >> 14) - (sines_square << 1) - (sines_factor >> 12)
    turn_w = s[25] + 16384 >> 15
    turn_x = s[26] + 16384 >> 15
    turn_y = s[27] + 16384 >> 15
    turn_z = s[28] + 16384 >> 15
    s[25] = (turn_w * s[22] - turn_x * s[19] - turn_y * s[20] - turn_z * s[21] >> 1) + s[25]
    s[26] = (turn_x * s[22] + turn_w * s[19] + turn_y * s[21] - turn_z * s[20] >> 1) + s[26]
    s[27] = (turn_y * s[22] + turn_w * s[20] + turn_z * s[19] - turn_x * s[21] >> 1) + s[27]
    s[28] = (turn_z * s[22] + turn_w * s[21] + turn_x * s[20] - turn_y * s[19] >> 1) + s[28]
    normalise_excess = -268435456
    normalise_part = s[25] + 8192 >> 14
    normalise_excess = normalise_part * normalise_part + normalise_excess
    normalise_part = s[26] + 8192 >> 14
    normalise_excess = normalise_part * normalise_part + normalise_excess
    normalise_part = s[27] + 8192 >> 14
    normalise_excess = normalise_part * normalise_part + normalise_excess
    normalise_part = s[28] + 8192 >> 14
    normalise_excess = normalise_part * normalise_part + normalise_excess
    normalise_excess = normalise_excess >> 14
    s[25] = s[25] - ((s[25] + 8192 >> 14) * normalise_excess >> 1)
    s[26] = s[26] - ((s[26] + 8192 >> 14) * normalise_excess >> 1)
    s[27] = s[27] - ((s[27] + 8192 >> 14) * normalise_excess >> 1)
    s[28] = s[28] - ((s[28] + 8192 >> 14) * normalise_excess >> 1)
    s[15] = s[15] + 1
    if s[15] >= s[11]:
        s[15] = 0
        s[13] = 2


@micropython.viper
def solve(s: ptr32, c: ptr32, s_, c_) -> int:
    k = s[15]
    s[15] = k + 1
    if c[20]:
        if k < 3:
            centre(s_, 3 * k, s[12], 21 * k + 86)
        elif k < 6:
            solve_document_own_slope_i = k - 3
            own_square(s_, solve_document_own_slope_i)
            solve_document_own_slope_put_m = s[22 * solve_document_own_slope_i + 92]
            solve_document_own_slope_put_e = s[12] - 16
            if not solve_document_own_slope_put_m:
                s[203] = 0
                s[204] = -4096
            else:
                while solve_document_own_slope_put_m < 524288 and solve_document_own_slope_put_m >= -524288:
                    solve_document_own_slope_put_m = solve_document_own_slope_put_m << 8
                    solve_document_own_slope_put_e = solve_document_own_slope_put_e - 8
                while solve_document_own_slope_put_m < 134217728 and solve_document_own_slope_put_m >= -134217728:
                    solve_document_own_slope_put_m = solve_document_own_slope_put_m << 1
                    solve_document_own_slope_put_e = solve_document_own_slope_put_e - 1
                while solve_document_own_slope_put_m >= 268435456 or solve_document_own_slope_put_m < -268435456:
                    solve_document_own_slope_put_m = solve_document_own_slope_put_m >> 1
                    solve_document_own_slope_put_e = solve_document_own_slope_put_e + 1
                s[203] = solve_document_own_slope_put_m
                s[204] = solve_document_own_slope_put_e
            divide(s_, 203, 205, 2 * solve_document_own_slope_i + 185)
        elif k < 9:
            noise(0, 0, s_, k - 6, s_)
        elif not k - 9:
            if int(last_pass(s_, c_)):
                s[14] = c[9]
            remove_slope(0, s_, c_, s_)
        elif k < 13:
            solve_document_own_variance_i = k - 10
            own_square(s_, solve_document_own_variance_i)
            solve_document_own_variance_put_m = -c[21]
            solve_document_own_variance_put_e = 0
            if not solve_document_own_variance_put_m:
                s[203] = 0
                s[204] = -4096
            else:
                while solve_document_own_variance_put_m < 524288 and solve_document_own_variance_put_m >= -524288:
                    solve_document_own_variance_put_m = solve_document_own_variance_put_m << 8
                    solve_document_own_variance_put_e = solve_document_own_variance_put_e - 8
                while solve_document_own_variance_put_m < 134217728 and solve_document_own_variance_put_m >= -134217728:
                    solve_document_own_variance_put_m = solve_document_own_variance_put_m << 1
                    solve_document_own_variance_put_e = solve_document_own_variance_put_e - 1
                while solve_document_own_variance_put_m >= 268435456 or solve_document_own_variance_put_m < -268435456:
                    solve_document_own_variance_put_m = solve_document_own_variance_put_m >> 1
                    solve_document_own_variance_put_e = solve_document_own_variance_put_e + 1
                s[203] = solve_document_own_variance_put_m
                s[204] = solve_document_own_variance_put_e
            multiply(s_, 203, 2 * solve_document_own_variance_i + 197, 203)
            if solve_document_own_variance_i > solve_document_own_variance_i:
                solve_document_own_variance_d = (4 * solve_document_own_variance_i - ((solve_document_own_variance_i + 1) * solve_document_own_variance_i >> 1) + solve_document_own_variance_i) * 2 + 33
            else:
                solve_document_own_variance_d = (4 * solve_document_own_variance_i - ((solve_document_own_variance_i + 1) * solve_document_own_variance_i >> 1) + solve_document_own_variance_i) * 2 + 33
            divide(s_, 203, 205, solve_document_own_variance_d)
        else:
            s[13] = 0
            return int(finish(s_, c_))
        return 0
    if not s[14]:
        level_and_prior(0, s_, 0, k, c_, s_, c_)
        return 0
    if k < 3:
        centre(s_, 3 * k, s[12], 21 * k + 86)
    elif not k - 3:
        lean_back_increments_within_value = -s[98]
        if lean_back_increments_within_value > 4096:
            lean_back_increments_within_result = 4096
        elif lean_back_increments_within_value < -4096:
            lean_back_increments_within_result = -4096
        else:
            lean_back_increments_within_result = lean_back_increments_within_value
        lean_back_x = lean_back_increments_within_result << 1
        lean_back_increments_within_value = -s[119]
        if lean_back_increments_within_value > 4096:
            lean_back_increments_within_result = 4096
        elif lean_back_increments_within_value < -4096:
            lean_back_increments_within_result = -4096
        else:
            lean_back_increments_within_result = lean_back_increments_within_value
        lean_back_y = lean_back_increments_within_result << 1
        s[203] = s[29] - (lean_back_x * s[30] + lean_back_y * s[31] >> 14)
        s[204] = (lean_back_x * s[29] + lean_back_y * s[32] >> 14) + s[30]
        s[205] = (lean_back_y * s[29] - lean_back_x * s[32] >> 14) + s[31]
        s[206] = (lean_back_x * s[31] - lean_back_y * s[30] >> 14) + s[32]
        lean_back_x = 0
        s[203] = s[203] >> 1
        lean_back_x = s[203] * s[203] + lean_back_x
        s[204] = s[204] >> 1
        lean_back_x = s[204] * s[204] + lean_back_x
        s[205] = s[205] >> 1
        lean_back_x = s[205] * s[205] + lean_back_x
        s[206] = s[206] >> 1
        lean_back_x = s[206] * s[206] + lean_back_x
        lean_back_look_along_scale = int(root(lean_back_x))
        s[29] = (s[203] << 14) // lean_back_look_along_scale
        s[30] = (s[204] << 14) // lean_back_look_along_scale
        s[31] = (s[205] << 14) // lean_back_look_along_scale
        s[32] = (s[206] << 14) // lean_back_look_along_scale
    elif k < 16:
        normal_equations(s_, k - 4, s_)
    elif not k - 16:
        step(s_)
    elif k < 20:
        noise(0, 0, s_, k - 17, s_)
    elif not k - 20:
        weights(0, s_, 0, s_, c_)
        if not int(last_pass(s_, c_)):
            remove_slope(0, s_, c_, s_)
    elif k < 33:
        normal_equations(s_, k - 21, s_)
    elif not k - 33:
        step(s_)
        s[14] = c[9]
        remove_slope(0, s_, c_, s_)
    else:
        s[13] = 0
        return int(finish(s_, c_))
    return 0


@micropython.viper
def normal_equations(s: ptr32, n: int, s_):
    if n < 6:
        matrix_element_i = 0
        matrix_element_j = n
        while matrix_element_j > 2:
            matrix_element_i = matrix_element_i + 1
            matrix_element_j = matrix_element_j - (3 - matrix_element_i)
        if matrix_element_i > matrix_element_j:
            matrix_element_j = (4 * matrix_element_j - ((matrix_element_j + 1) * matrix_element_j >> 1) + matrix_element_i) * 2 + 33
        else:
            matrix_element_j = (4 * matrix_element_i - ((matrix_element_i + 1) * matrix_element_i >> 1) + matrix_element_j) * 2 + 33
        matrix_element_real_copy_a = 2 * n + 161
        matrix_element_real_copy_words = 2
        while matrix_element_real_copy_words > 0:
            matrix_element_real_copy_words = matrix_element_real_copy_words - 1
            s[matrix_element_real_copy_words + 203] = s[matrix_element_real_copy_a + matrix_element_real_copy_words]
        element(0, 0, s_, n + 86, matrix_element_j, 2 * s[12] - 42, s_)
    elif n < 9:
        right_side_i = n - 6
        if right_side_i > 3:
            right_side_d = (right_side_i + 6) * 2 + 33
        else:
            right_side_d = (4 * right_side_i - ((right_side_i + 1) * right_side_i >> 1) + 3) * 2 + 33
        s[203] = 0
        s[204] = -4096
        element(0, 0, s_, right_side_i + 92, right_side_d, s[12] - 16, s_)
        subtract(s_, 179, 205, 173, s_)
        right_side_multiply_by_prior_a = int(prior_place(right_side_i, 0))
        multiply(s_, 205, right_side_multiply_by_prior_a, 205)
        if s[right_side_d + 1] < s[206]:
            add_smaller(s_, 205, right_side_d, right_side_d)
        else:
            add_smaller(s_, right_side_d, 205, right_side_d)
        subtract(s_, 181, 205, 175, s_)
        right_side_multiply_by_prior_a = int(prior_place(right_side_i, 1))
        multiply(s_, 205, right_side_multiply_by_prior_a, 205)
        if s[right_side_d + 1] < s[206]:
            add_smaller(s_, 205, right_side_d, right_side_d)
        else:
            add_smaller(s_, right_side_d, 205, right_side_d)
        subtract(s_, 183, 205, 177, s_)
        right_side_multiply_by_prior_a = int(prior_place(right_side_i, 2))
        multiply(s_, 205, right_side_multiply_by_prior_a, 205)
        if s[right_side_d + 1] < s[206]:
            add_smaller(s_, 205, right_side_d, right_side_d)
        else:
            add_smaller(s_, right_side_d, 205, right_side_d)
        s[51] = 0
        s[52] = -4096
    else:
        sweep(0, 0, s_, n - 9, s_)


@micropython.viper
def level_and_prior(turn_centre_turned_mean_j: int, s: ptr32, turn_centre_turned_mean_total: int, k: int, c: ptr32, s_, c_):
    if not k:
        find_up_x = s[119]
        find_up_y = -s[98]
        find_up_z = s[63]
        while find_up_x > 8191 or find_up_x < -8191 or find_up_y > 8191 or (find_up_y < -8191) or (find_up_z > 8191) or (find_up_z < -8191):
            find_up_x = find_up_x >> 1
            find_up_y = find_up_y >> 1
            find_up_z = find_up_z >> 1
        find_up_root_square = find_up_x * find_up_x + find_up_y * find_up_y + find_up_z * find_up_z
        find_up_root_bit = 1 << 14
        if find_up_root_square < 16777216:
            find_up_root_bit = 1 << 11
        find_up_root_found = 0
        while find_up_root_bit:
            find_up_root_more = find_up_root_found + find_up_root_bit
            if find_up_root_more * find_up_root_more <= find_up_root_square:
                find_up_root_found = find_up_root_more
            find_up_root_bit = find_up_root_bit >> 1
        find_up_scale = find_up_root_found
        find_up_over = find_up_z < 0
        if find_up_over:
            find_up_y = -find_up_y
            find_up_z = -find_up_z
        s[203] = find_up_scale + find_up_z
        s[203 + 1] = find_up_y
        s[203 + 2] = 0 - find_up_x
        s[203 + 3] = 0
        find_up_root_square = s[203] * s[203] + find_up_x * find_up_x + find_up_y * find_up_y
        find_up_root_bit = 1 << 14
        if find_up_root_square < 16777216:
            find_up_root_bit = 1 << 11
        find_up_root_found = 0
        while find_up_root_bit:
            find_up_root_more = find_up_root_found + find_up_root_bit
            if find_up_root_more * find_up_root_more <= find_up_root_square:
                find_up_root_found = find_up_root_more
            find_up_root_bit = find_up_root_bit >> 1
        find_up_scale = find_up_root_found
        if find_up_over:
            s[203 + 3] = find_up_x
            s[203 + 2] = 0
            s[203 + 1] = s[203]
            s[203] = 0 - find_up_y
        if not find_up_scale:
            s[203] = 1
            find_up_scale = 1
        find_up_look_along_i = 0
        while find_up_look_along_i < 4:
            s[29 + find_up_look_along_i] = (s[203 + find_up_look_along_i] << 14) // find_up_scale
            find_up_look_along_i = find_up_look_along_i + 1
        turn_centre_shift = s[12]
        turn_centre_begin_attitude_i = 0
        while turn_centre_begin_attitude_i < 4:
            s[25 + turn_centre_begin_attitude_i] = s[29 + turn_centre_begin_attitude_i] << 14
            turn_centre_begin_attitude_i = turn_centre_begin_attitude_i + 1
        s[23] = 0
        s[24] = 0
        rotation(s_)
        turn_centre_i = 0
        while turn_centre_i < 3:
            turn_centre_k = 0
            while turn_centre_k < 3:
                turn_centre_turned_mean_j = 0
                turn_centre_turned_mean_total = 0
                while turn_centre_turned_mean_j < 3:
                    turn_centre_turned_mean_mean = (s[21 * turn_centre_turned_mean_j + 86 + 9 + turn_centre_k] << 8) // (s[18] >> 2)
                    turn_centre_turned_mean_total = (s[3 * turn_centre_i + 33 + turn_centre_turned_mean_j] * turn_centre_turned_mean_mean >> 2) + turn_centre_turned_mean_total
                    turn_centre_turned_mean_j = turn_centre_turned_mean_j + 1
                turn_centre_turned_mean_result = turn_centre_turned_mean_total >> 12
                s[3 * turn_centre_i + 214 + turn_centre_k] = -(turn_centre_turned_mean_result << turn_centre_shift)
                turn_centre_k = turn_centre_k + 1
            turn_centre_i = turn_centre_i + 1
    elif not k - 1:
        k = 1 if s[11] == c[16] and s[68] > 0 else 0
        carry(0, k, s_, c_, s_, c_)
        if k:
            real_copy_words = 6
            while real_copy_words > 0:
                real_copy_words = real_copy_words - 1
                s[179 + real_copy_words] = s[173 + real_copy_words]
    elif not k - 2:
        spread_prior(0, s_)
    elif k < 6:
        sweep(0, 0, s_, k - 3, s_)
    else:
        covariance(0, 0, 161, s_)
        held_weights_i = 0
        while held_weights_i < 6:
            held_weights_real_copy_d = 197 + held_weights_i
            held_weights_real_copy_a = 191 + held_weights_i
            held_weights_real_copy_words = 2
            while held_weights_real_copy_words > 0:
                held_weights_real_copy_words = held_weights_real_copy_words - 1
                s[held_weights_real_copy_d + held_weights_real_copy_words] = s[held_weights_real_copy_a + held_weights_real_copy_words]
            weigh(0, s_, c_, 197 + held_weights_i, s_)
            held_weights_i = held_weights_i + 2
        s[14] = 1
        begin_traversal(s_)


@micropython.viper
def last_pass(s: ptr32, c: ptr32) -> int:
    if s[14] >= c[9]:
        return 1
    whole_shift = 0
    whole_m = s[185]
    whole_shift = whole_shift + s[186]
    if whole_shift > 1 and whole_m:
        whole_m = 536870911 if whole_m > 0 else -536870911
    elif not whole_shift >> 30:
        whole_m = whole_m << whole_shift
    elif whole_shift > -30:
        whole_m = (1 << -1 - whole_shift) + whole_m >> 0 - whole_shift
    else:
        whole_m = 0
    slope = whole_m
    if slope > c[22] or slope < -c[22]:
        return 0
    whole_shift = 0
    whole_m = s[187]
    whole_shift = whole_shift + s[188]
    if whole_shift > 1 and whole_m:
        whole_m = 536870911 if whole_m > 0 else -536870911
    elif not whole_shift >> 30:
        whole_m = whole_m << whole_shift
    elif whole_shift > -30:
        whole_m = (1 << -1 - whole_shift) + whole_m >> 0 - whole_shift
    else:
        whole_m = 0
    slope = whole_m
    if slope > c[22] or slope < -c[22]:
        return 0
    whole_shift = 0
    whole_m = s[189]
    whole_shift = whole_shift + s[190]
    if whole_shift > 1 and whole_m:
        whole_m = 536870911 if whole_m > 0 else -536870911
    elif not whole_shift >> 30:
        whole_m = whole_m << whole_shift
    elif whole_shift > -30:
        whole_m = (1 << -1 - whole_shift) + whole_m >> 0 - whole_shift
    else:
        whole_m = 0
    slope = whole_m
    if slope > c[22] or slope < -c[22]:
        return 0
    return 1


@micropython.viper
def remove_slope(note_slope_put_m: int, s: ptr32, c: ptr32, s_):
    i = 0
    while i < 6:
        real_add_d = i + 179
        real_add_a = i + 179
        real_add_b = i + 185
        if s[real_add_a + 1] < s[real_add_b + 1]:
            add_smaller(s_, real_add_b, real_add_a, real_add_d)
        else:
            add_smaller(s_, real_add_a, real_add_b, real_add_d)
        i = i + 2
    note_slope_a = s[14] - 1
    if note_slope_a > 2:
        note_slope_a = 2
    note_slope_a = 3 * note_slope_a + 77
    note_slope_put_m = c[10]
    note_slope_put_e = c[11]
    if not note_slope_put_m:
        s[203] = 0
        s[204] = -4096
    else:
        while note_slope_put_m < 524288 and note_slope_put_m >= -524288:
            note_slope_put_m = note_slope_put_m << 8
            note_slope_put_e = note_slope_put_e - 8
        while note_slope_put_m < 134217728 and note_slope_put_m >= -134217728:
            note_slope_put_m = note_slope_put_m << 1
            note_slope_put_e = note_slope_put_e - 1
        while note_slope_put_m >= 268435456 or note_slope_put_m < -268435456:
            note_slope_put_m = note_slope_put_m >> 1
            note_slope_put_e = note_slope_put_e + 1
        s[203] = note_slope_put_m
        s[204] = note_slope_put_e
    multiply(s_, 203, 185, 203)
    note_slope_whole_shift = 0
    note_slope_whole_m = s[203]
    note_slope_whole_shift = note_slope_whole_shift + s[204]
    if note_slope_whole_shift > 1 and note_slope_whole_m:
        note_slope_whole_m = 536870911 if note_slope_whole_m > 0 else -536870911
    elif not note_slope_whole_shift >> 30:
        note_slope_whole_m = note_slope_whole_m << note_slope_whole_shift
    elif note_slope_whole_shift > -30:
        note_slope_whole_m = (1 << -1 - note_slope_whole_shift) + note_slope_whole_m >> 0 - note_slope_whole_shift
    else:
        note_slope_whole_m = 0
    note_slope_whole_result = note_slope_whole_m
    s[note_slope_a] = note_slope_whole_result
    note_slope_put_m = c[10]
    note_slope_put_e = c[11]
    if not note_slope_put_m:
        s[203] = 0
        s[204] = -4096
    else:
        while note_slope_put_m < 524288 and note_slope_put_m >= -524288:
            note_slope_put_m = note_slope_put_m << 8
            note_slope_put_e = note_slope_put_e - 8
        while note_slope_put_m < 134217728 and note_slope_put_m >= -134217728:
            note_slope_put_m = note_slope_put_m << 1
            note_slope_put_e = note_slope_put_e - 1
        while note_slope_put_m >= 268435456 or note_slope_put_m < -268435456:
            note_slope_put_m = note_slope_put_m >> 1
            note_slope_put_e = note_slope_put_e + 1
        s[203] = note_slope_put_m
        s[204] = note_slope_put_e
    multiply(s_, 203, 187, 203)
    note_slope_whole_shift = 0
    note_slope_whole_m = s[203]
    note_slope_whole_shift = note_slope_whole_shift + s[204]
    if note_slope_whole_shift > 1 and note_slope_whole_m:
        note_slope_whole_m = 536870911 if note_slope_whole_m > 0 else -536870911
    elif not note_slope_whole_shift >> 30:
        note_slope_whole_m = note_slope_whole_m << note_slope_whole_shift
    elif note_slope_whole_shift > -30:
        note_slope_whole_m = (1 << -1 - note_slope_whole_shift) + note_slope_whole_m >> 0 - note_slope_whole_shift
    else:
        note_slope_whole_m = 0
    note_slope_whole_result = note_slope_whole_m
    s[note_slope_a + 1] = note_slope_whole_result
    note_slope_put_m = c[10]
    note_slope_put_e = c[11]
    if not note_slope_put_m:
        s[203] = 0
        s[204] = -4096
    else:
        while note_slope_put_m < 524288 and note_slope_put_m >= -524288:
            note_slope_put_m = note_slope_put_m << 8
            note_slope_put_e = note_slope_put_e - 8
        while note_slope_put_m < 134217728 and note_slope_put_m >= -134217728:
            note_slope_put_m = note_slope_put_m << 1
            note_slope_put_e = note_slope_put_e - 1
        while note_slope_put_m >= 268435456 or note_slope_put_m < -268435456:
            note_slope_put_m = note_slope_put_m >> 1
            note_slope_put_e = note_slope_put_e + 1
        s[203] = note_slope_put_m
        s[204] = note_slope_put_e
    multiply(s_, 203, 189, 203)
    note_slope_whole_shift = 0
    note_slope_whole_m = s[203]
    note_slope_whole_shift = note_slope_whole_shift + s[204]
    if note_slope_whole_shift > 1 and note_slope_whole_m:
        note_slope_whole_m = 536870911 if note_slope_whole_m > 0 else -536870911
    elif not note_slope_whole_shift >> 30:
        note_slope_whole_m = note_slope_whole_m << note_slope_whole_shift
    elif note_slope_whole_shift > -30:
        note_slope_whole_m = (1 << -1 - note_slope_whole_shift) + note_slope_whole_m >> 0 - note_slope_whole_shift
    else:
        note_slope_whole_m = 0
    note_slope_whole_result = note_slope_whole_m
    s[note_slope_a + 2] = note_slope_whole_result
    if s[14] < c[9]:
        s[14] = s[14] + 1
        begin_traversal(s_)
