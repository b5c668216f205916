# Generated from zerorate/in_motion.py by `make viper`: edit that file, not this one.
"""The bias from motion that returns: the slope of integrated orientation over a stored window.

Document 002: store the rates, find the stretch that moves, integrate it to orientation, fit a
line, take the slope as bias, remove it, integrate again. Two forms:

- the document's own: each axis' slope of the orientation vector is that axis' bias;
- the default: tilt comes from gravity in the level frame, only the heading from the assumption
  that it returns; slopes are mapped to the body by the integrated rotation matrix, tapered, and
  joined with what earlier windows know by weights that the window's own residual sets.

A window grows from 2 s while nothing is known, for a large bias turns a long one too far to be
linear. Work is spread: a few nodes or one piece of algebra a sample. The state is one array('i')
of 240 words and 3 a node; motion_settings.py makes the settings."""

import micropython

from .atan2 import atan2_q13
from .attitude import rotation
from .attitude import turn
from .fixed import root
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
from .thermal import carry_axis


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
        s[210 + increments_gather_convert_i] = increments_gather_convert_increments_within_result
        increments_gather_convert_i = increments_gather_convert_i + 1
    increments_gather_coning_first = (s[2 + 1] + 512 >> 10) * (s[19 + 2] + 256 >> 9)
    increments_gather_coning_result = increments_gather_coning_first - (s[2 + 2] + 512 >> 10) * (s[19 + 1] + 256 >> 9) + 32 >> 6
    s[202] = increments_gather_coning_result
    increments_gather_coning_first = (s[2 + 2] + 512 >> 10) * (s[19 + 0] + 256 >> 9)
    increments_gather_coning_result = increments_gather_coning_first - (s[2 + 0] + 512 >> 10) * (s[19 + 2] + 256 >> 9) + 32 >> 6
    s[202 + 1] = increments_gather_coning_result
    increments_gather_coning_first = (s[2 + 0] + 512 >> 10) * (s[19 + 1] + 256 >> 9)
    increments_gather_coning_result = increments_gather_coning_first - (s[2 + 1] + 512 >> 10) * (s[19 + 0] + 256 >> 9) + 32 >> 6
    s[202 + 2] = increments_gather_coning_result
    increments_gather_carried_first = (s[2 + 1] + 1024 >> 11) * s[210 + 2]
    increments_gather_carried_result = increments_gather_carried_first - (s[2 + 2] + 1024 >> 11) * s[210 + 1] + 4096 >> 13
    s[205] = increments_gather_carried_result
    increments_gather_carried_first = (s[2 + 2] + 1024 >> 11) * s[210 + 0]
    increments_gather_carried_result = increments_gather_carried_first - (s[2 + 0] + 1024 >> 11) * s[210 + 2] + 4096 >> 13
    s[205 + 1] = increments_gather_carried_result
    increments_gather_carried_first = (s[2 + 0] + 1024 >> 11) * s[210 + 1]
    increments_gather_carried_result = increments_gather_carried_first - (s[2 + 1] + 1024 >> 11) * s[210 + 0] + 4096 >> 13
    s[205 + 2] = increments_gather_carried_result
    increments_gather_increments_advance_i = 0
    while increments_gather_increments_advance_i < 3:
        s[5 + increments_gather_increments_advance_i] += s[210 + increments_gather_increments_advance_i] + s[205 + increments_gather_increments_advance_i]
        increments_gather_increments_advance_angle = s[2 + increments_gather_increments_advance_i] + s[19 + increments_gather_increments_advance_i] + s[202 + increments_gather_increments_advance_i]
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
        follow_temperature_temp = x[3]
        follow_temperature_temp = follow_temperature_temp << 8
        if not s[9]:
            s[237] = follow_temperature_temp
            s[239] = follow_temperature_temp
        s[237] = (follow_temperature_temp - s[237] + 32 >> 6) + s[237]
        s[239] = (follow_temperature_temp - s[239] + 2 >> 2) + s[239]
        s[0] = s[0] - c[0]
        increments_close_a = 3 * s[8] + 240
        increments_close_i = 0
        while increments_close_i < 3:
            increments_close_over = (s[0] << 10) // c[0]
            increments_close_over = (s[57 + increments_close_i] >> 8) * increments_close_over >> 2
            increments_close_increments_within_value = s[2 + increments_close_i] - increments_close_over + 1024 >> 11
            if increments_close_increments_within_value > 16383:
                increments_close_angle = 16383
            elif increments_close_increments_within_value < 0 - 16383:
                increments_close_angle = 0 - 16383
            else:
                increments_close_angle = increments_close_increments_within_value
            s[2 + increments_close_i] -= increments_close_angle << 11
            increments_close_increments_within_value = s[5 + increments_close_i] // s[1]
            if increments_close_increments_within_value > 16383:
                increments_close_over = 16383
            elif increments_close_increments_within_value < 0 - 16383:
                increments_close_over = 0 - 16383
            else:
                increments_close_over = increments_close_increments_within_value
            s[increments_close_a + increments_close_i] = (increments_close_angle << 15) + (increments_close_over & 32767)
            s[5 + increments_close_i] = 0
            increments_close_i = increments_close_i + 1
        s[1] = 0
        s[8] = s[8] + 1
        if s[8] >= c[8]:
            s[8] = 0
        if s[9] < c[8]:
            s[9] = s[9] + 1
        s[10] = s[10] + 1
        s[66] = s[66] + 1
        if s[64] > 0:
            s[64] = s[64] - 1
    if not s[13]:
        if int(start_window(s_, c_)):
            begin_traversal(s_)
        return 0
    return int(work(s_, c_))


@micropython.viper
def work(s_, c_) -> int:
    s = ptr32(s_)
    c = ptr32(c_)
    if not s[13] - 2:
        solve_k = s[15]
        s[15] = solve_k + 1
        if c[20]:
            if solve_k < 3:
                centre(s_, 21 * solve_k + 85, 3 * solve_k, s[12])
            elif solve_k < 6:
                solve_solve_document_own_slope_i = solve_k - 3
                own_square(s_, solve_solve_document_own_slope_i)
                solve_solve_document_own_slope_a = s[12] - 16
                solve_solve_document_own_slope_put_m = s[22 * solve_solve_document_own_slope_i + 91]
                solve_solve_document_own_slope_put_e = solve_solve_document_own_slope_a
                if not solve_solve_document_own_slope_put_m:
                    s[202] = 0
                    s[203] = -4096
                else:
                    while solve_solve_document_own_slope_put_m < 524288 and solve_solve_document_own_slope_put_m >= -524288:
                        solve_solve_document_own_slope_put_m = solve_solve_document_own_slope_put_m << 8
                        solve_solve_document_own_slope_put_e = solve_solve_document_own_slope_put_e - 8
                    while solve_solve_document_own_slope_put_m < 134217728 and solve_solve_document_own_slope_put_m >= -134217728:
                        solve_solve_document_own_slope_put_m = solve_solve_document_own_slope_put_m << 1
                        solve_solve_document_own_slope_put_e = solve_solve_document_own_slope_put_e - 1
                    while solve_solve_document_own_slope_put_m >= 268435456 or solve_solve_document_own_slope_put_m < -268435456:
                        solve_solve_document_own_slope_put_m = solve_solve_document_own_slope_put_m >> 1
                        solve_solve_document_own_slope_put_e = solve_solve_document_own_slope_put_e + 1
                    s[202] = solve_solve_document_own_slope_put_m
                    s[203] = solve_solve_document_own_slope_put_e
                divide(s_, 2 * solve_solve_document_own_slope_i + 184, 202, 204)
            elif solve_k < 9:
                noise(s_, solve_k - 6)
            elif not solve_k - 9:
                if int(last_pass(s_, c_)):
                    s[14] = c[9]
                remove_slope(s_, c_)
            elif solve_k < 13:
                solve_solve_document_own_variance_i = solve_k - 10
                own_square(s_, solve_solve_document_own_variance_i)
                solve_solve_document_own_variance_put_m = -c[21]
                solve_solve_document_own_variance_put_e = 0
                if not solve_solve_document_own_variance_put_m:
                    s[202] = 0
                    s[203] = -4096
                else:
                    while solve_solve_document_own_variance_put_m < 524288 and solve_solve_document_own_variance_put_m >= -524288:
                        solve_solve_document_own_variance_put_m = solve_solve_document_own_variance_put_m << 8
                        solve_solve_document_own_variance_put_e = solve_solve_document_own_variance_put_e - 8
                    while solve_solve_document_own_variance_put_m < 134217728 and solve_solve_document_own_variance_put_m >= -134217728:
                        solve_solve_document_own_variance_put_m = solve_solve_document_own_variance_put_m << 1
                        solve_solve_document_own_variance_put_e = solve_solve_document_own_variance_put_e - 1
                    while solve_solve_document_own_variance_put_m >= 268435456 or solve_solve_document_own_variance_put_m < -268435456:
                        solve_solve_document_own_variance_put_m = solve_solve_document_own_variance_put_m >> 1
                        solve_solve_document_own_variance_put_e = solve_solve_document_own_variance_put_e + 1
                    s[202] = solve_solve_document_own_variance_put_m
                    s[203] = solve_solve_document_own_variance_put_e
                multiply(s_, 202, 202, 2 * solve_solve_document_own_variance_i + 196)
                if solve_solve_document_own_variance_i > solve_solve_document_own_variance_i:
                    solve_solve_document_own_variance_i = (4 * solve_solve_document_own_variance_i - ((solve_solve_document_own_variance_i + 1) * solve_solve_document_own_variance_i >> 1) + solve_solve_document_own_variance_i) * 2 + 33
                else:
                    solve_solve_document_own_variance_i = (4 * solve_solve_document_own_variance_i - ((solve_solve_document_own_variance_i + 1) * solve_solve_document_own_variance_i >> 1) + solve_solve_document_own_variance_i) * 2 + 33
                divide(s_, solve_solve_document_own_variance_i, 202, 204)
            else:
                s[13] = 0
                return int(finish(s_, c_))
            return 0
        if not s[14]:
            level_and_prior(s_, c_, solve_k)
            return 0
        if solve_k < 3:
            centre(s_, 21 * solve_k + 85, 3 * solve_k, s[12])
        elif not solve_k - 3:
            solve_lean_back_increments_within_value = -s[97]
            if solve_lean_back_increments_within_value > 4096:
                solve_lean_back_increments_within_result = 4096
            elif solve_lean_back_increments_within_value < -4096:
                solve_lean_back_increments_within_result = -4096
            else:
                solve_lean_back_increments_within_result = solve_lean_back_increments_within_value
            solve_lean_back_x = solve_lean_back_increments_within_result << 1
            solve_lean_back_increments_within_value = -s[118]
            if solve_lean_back_increments_within_value > 4096:
                solve_lean_back_increments_within_result = 4096
            elif solve_lean_back_increments_within_value < -4096:
                solve_lean_back_increments_within_result = -4096
            else:
                solve_lean_back_increments_within_result = solve_lean_back_increments_within_value
            solve_lean_back_y = solve_lean_back_increments_within_result << 1
            s[202] = s[29] - (solve_lean_back_x * s[30] + solve_lean_back_y * s[31] >> 14)
            s[203] = (solve_lean_back_x * s[29] + solve_lean_back_y * s[32] >> 14) + s[30]
            s[204] = (solve_lean_back_y * s[29] - solve_lean_back_x * s[32] >> 14) + s[31]
            s[205] = (solve_lean_back_x * s[31] - solve_lean_back_y * s[30] >> 14) + s[32]
            solve_lean_back_x = 0
            s[202] = s[202] >> 1
            solve_lean_back_x = s[202] * s[202] + solve_lean_back_x
            s[203] = s[203] >> 1
            solve_lean_back_x = s[203] * s[203] + solve_lean_back_x
            s[204] = s[204] >> 1
            solve_lean_back_x = s[204] * s[204] + solve_lean_back_x
            s[205] = s[205] >> 1
            solve_lean_back_x = s[205] * s[205] + solve_lean_back_x
            solve_lean_back_look_along_scale = int(root(solve_lean_back_x))
            s[29] = (s[202] << 14) // solve_lean_back_look_along_scale
            s[30] = (s[203] << 14) // solve_lean_back_look_along_scale
            s[31] = (s[204] << 14) // solve_lean_back_look_along_scale
            s[32] = (s[205] << 14) // solve_lean_back_look_along_scale
        elif solve_k < 16:
            normal_equations(s_, solve_k - 4)
        elif not solve_k - 16:
            step(s_)
        elif solve_k < 20:
            noise(s_, solve_k - 17)
        elif not solve_k - 20:
            weights(s_, c_)
            if not int(last_pass(s_, c_)):
                remove_slope(s_, c_)
        elif solve_k < 33:
            normal_equations(s_, solve_k - 21)
        elif not solve_k - 33:
            step(s_)
            s[14] = c[9]
            remove_slope(s_, c_)
        else:
            s[13] = 0
            return int(finish(s_, c_))
        return 0
    i = c[5]
    while i > 0 and (not s[13] - 1):
        visit(s_, c_)
        i = i - 1
    return 0


@micropython.viper
def begin_traversal(s: ptr32):
    i = 0
    while i < 63:
        s[i + 85] = 0
        i = i + 1
    i = 0
    whole_shift = 0
    whole_m = s[178]
    whole_shift = whole_shift + s[179]
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
    whole_m = s[180]
    whole_shift = whole_shift + s[181]
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
    whole_m = s[182]
    whole_shift = whole_shift + s[183]
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
        s[i + 42] = s[i + 213]
        i = i + 1
    s[63] = 0
    s[18] = 0
    s[65] = 0
    s[15] = 0
    s[13] = 1
    s[25] = s[29] << 14
    s[26] = s[30] << 14
    s[27] = s[31] << 14
    s[28] = s[32] << 14
    s[23] = 0
    s[24] = 0


@micropython.viper
def visit(s_, c: ptr32):
    s = ptr32(s_)
    a = s[16] + s[15]
    if a >= c[8]:
        a = a - c[8]
    a = 3 * a + 240
    taper_k = s[15]
    taper_stage = s[12]
    taper_even = c[20]
    taper_t = 2 * taper_k + 1 - (1 << taper_stage) << 10 - taper_stage
    taper_k = taper_t * taper_t >> 10
    taper_stage = (1024 - taper_k) * (1024 - taper_k) >> 10
    s[61] = (7 * taper_k - 1024) * taper_stage >> 10
    s[62] = ((3 * taper_k - 1024) * taper_t >> 10) * taper_stage >> 10
    if taper_even:
        taper_stage = 1024
    s[60] = taper_stage
    s[18] = s[18] + taper_stage
    rotation(s_)
    if c[20]:
        observe_vector_i = 0
        while observe_vector_i < 9:
            s[33 + observe_vector_i] = 0
            observe_vector_i = observe_vector_i + 1
        observe_vector_i = 0
        while observe_vector_i < 3:
            s[4 * observe_vector_i + 33] = 16384
            s[51 + observe_vector_i] = s[25 + 1 + observe_vector_i] >> 15
            if s[25] >> 30:
                s[51 + observe_vector_i] = -s[51 + observe_vector_i]
            observe_vector_i = observe_vector_i + 1
    else:
        level_observe_a = a
        level_observe_force_q12_i = 0
        level_observe_force_q12_total = 0
        while level_observe_force_q12_i < 3:
            level_observe_force_q12_total = ((s[level_observe_a + level_observe_force_q12_i] & 32767 ^ 16384) - 16384) * s[33 + 3 + level_observe_force_q12_i] + level_observe_force_q12_total
            level_observe_force_q12_i = level_observe_force_q12_i + 1
        level_observe_force = level_observe_force_q12_total + 8192 >> 14
        if level_observe_force > 32767:
            level_observe_increments_within_result = 32767
        elif level_observe_force < 0 - 32767:
            level_observe_increments_within_result = 0 - 32767
        else:
            level_observe_increments_within_result = level_observe_force
        s[51] = -level_observe_increments_within_result
        level_observe_force_q12_i = 0
        level_observe_force_q12_total = 0
        while level_observe_force_q12_i < 3:
            level_observe_force_q12_total = ((s[level_observe_a + level_observe_force_q12_i] & 32767 ^ 16384) - 16384) * s[33 + 0 + level_observe_force_q12_i] + level_observe_force_q12_total
            level_observe_force_q12_i = level_observe_force_q12_i + 1
        level_observe_force = level_observe_force_q12_total + 8192 >> 14
        if level_observe_force > 32767:
            level_observe_increments_within_result = 32767
        elif level_observe_force < 0 - 32767:
            level_observe_increments_within_result = 0 - 32767
        else:
            level_observe_increments_within_result = level_observe_force
        s[51 + 1] = level_observe_increments_within_result
        level_observe_force_q12_i = 0
        level_observe_force_q12_total = 0
        while level_observe_force_q12_i < 3:
            level_observe_force_q12_total = ((s[level_observe_a + level_observe_force_q12_i] & 32767 ^ 16384) - 16384) * s[33 + 6 + level_observe_force_q12_i] + level_observe_force_q12_total
            level_observe_force_q12_i = level_observe_force_q12_i + 1
        level_observe_force = level_observe_force_q12_total + 8192 >> 14
        s[63] = (s[60] * level_observe_force + 512 >> 10) + s[63]
        level_observe_heading_q12_w = s[25] + 8192 >> 14
        level_observe_heading_q12_x = s[26] + 8192 >> 14
        level_observe_heading_q12_y = s[27] + 8192 >> 14
        level_observe_heading_q12_z = s[28] + 8192 >> 14
        level_observe_heading_q12_real = level_observe_heading_q12_w * s[29] + level_observe_heading_q12_x * s[30] + level_observe_heading_q12_y * s[31] + level_observe_heading_q12_z * s[32]
        level_observe_heading_q12_z = level_observe_heading_q12_z * s[29] - level_observe_heading_q12_w * s[32] - level_observe_heading_q12_x * s[31] + level_observe_heading_q12_y * s[30]
        level_observe_force = int(atan2_q13(level_observe_heading_q12_z, level_observe_heading_q12_real))
        level_observe_a = level_observe_force - s[23]
        s[23] = level_observe_force
        if level_observe_a > 25736:
            s[24] = s[24] - 1
        elif level_observe_a < -25736:
            s[24] = s[24] + 1
        level_observe_increments_within_value = s[24]
        if level_observe_increments_within_value > 3:
            level_observe_increments_within_result = 3
        elif level_observe_increments_within_value < 0 - 3:
            level_observe_increments_within_result = 0 - 3
        else:
            level_observe_increments_within_result = level_observe_increments_within_value
        level_observe_force = level_observe_increments_within_result * 51472 + level_observe_force
        if level_observe_force > 32767:
            level_observe_increments_within_result = 32767
        elif level_observe_force < 0 - 32767:
            level_observe_increments_within_result = 0 - 32767
        else:
            level_observe_increments_within_result = level_observe_force
        s[51 + 2] = level_observe_increments_within_result
    sum_up(s_)
    remove_bias_i = 0
    while remove_bias_i < 3:
        s[54 + remove_bias_i] += s[57 + remove_bias_i]
        remove_bias_part = s[54 + remove_bias_i] + 1024 >> 11
        s[54 + remove_bias_i] -= remove_bias_part << 11
        remove_bias_part = (s[a + remove_bias_i] >> 15) - remove_bias_part
        s[19 + remove_bias_i] = remove_bias_part
        s[65] = (remove_bias_part if remove_bias_part > 0 else 0 - remove_bias_part) + s[65]
        remove_bias_i = remove_bias_i + 1
    sines_square = s[19] * s[19] + s[19 + 1] * s[19 + 1] + s[19 + 2] * s[19 + 2] >> 14
    sines_fourth = (sines_square >> 1) * (sines_square >> 1) >> 12
    sines_factor = 16384 - (sines_square * 2731 >> 14) + (sines_fourth * 137 >> 14)
    sines_i = 0
    while sines_i < 3:
        s[19 + sines_i] = s[19 + sines_i] * sines_factor + 2048 >> 12
        sines_i = sines_i + 1
    sines_factor = ((sines_fourth >> 1) * (sines_square >> 1) >> 12) * 23
    s[22] = (sines_fourth * 2731 >> 14) - (sines_square << 1) - (sines_factor >> 12)
    turn(s_)
    normalise_i = 0
    normalise_excess = -268435456
    while normalise_i < 4:
        normalise_part = s[25 + normalise_i] + 8192 >> 14
        normalise_excess = normalise_part * normalise_part + normalise_excess
        normalise_i = normalise_i + 1
    normalise_excess = normalise_excess >> 14
    normalise_i = 0
    while normalise_i < 4:
        s[25 + normalise_i] = s[25 + normalise_i] - ((s[25 + normalise_i] + 8192 >> 14) * normalise_excess >> 1)
        normalise_i = normalise_i + 1
    s[15] = s[15] + 1
    if s[15] >= s[11]:
        s[15] = 0
        s[13] = 2


@micropython.viper
def sum_up(s: ptr32):
    i = 0
    while i < 9:
        s[42 + i] += s[33 + i] >> 1
        i = i + 1
    i = 0
    while i < 3:
        regressors_row = 3 * i + 42
        regressors_shift = s[12]
        regressors_i = 0
        while regressors_i < 3:
            regressors_m = (1 << regressors_shift - 1) + s[regressors_row + regressors_i] >> regressors_shift
            s[202 + regressors_i] = regressors_m
            s[205 + regressors_i] = s[60] * regressors_m + 512 >> 10
            regressors_i = regressors_i + 1
        first_sums_a = 21 * i + 85
        s_first_sums_a = ptr32(int(s) + (first_sums_a << 2))
        first_sums_y = s[51 + i]
        first_sums_i = 0
        while first_sums_i < 3:
            s[first_sums_a + 6 + first_sums_i] += s[205 + first_sums_i] * first_sums_y + 512 >> 10
            s[first_sums_a + 9 + first_sums_i] += s[205 + first_sums_i]
            s[first_sums_a + 13 + first_sums_i] += s[61] * s[202 + first_sums_i] + 512 >> 10
            s[first_sums_a + 13 + 3 + first_sums_i] += s[62] * s[202 + first_sums_i] + 512 >> 10
            first_sums_i = first_sums_i + 1
        s_first_sums_a[12] = (s[60] * first_sums_y + 512 >> 10) + s_first_sums_a[12]
        s_first_sums_a[19] = (s[61] * first_sums_y + 512 >> 10) + s_first_sums_a[19]
        s[first_sums_a + 19 + 1] += s[62] * first_sums_y + 512 >> 10
        second_sums_a = 21 * i + 85
        second_sums_i = 0
        while second_sums_i < 3:
            second_sums_k = second_sums_i
            while second_sums_k < 3:
                s[second_sums_a] = (s[205 + second_sums_i] * s[202 + second_sums_k] + 512 >> 10) + s[second_sums_a]
                second_sums_a = second_sums_a + 1
                second_sums_k = second_sums_k + 1
            second_sums_i = second_sums_i + 1
        i = i + 1
    i = 0
    while i < 9:
        s[42 + i] += s[33 + i] - (s[33 + i] >> 1)
        i = i + 1


@micropython.viper
def normal_equations(s_, n: int):
    s = ptr32(s_)
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
        matrix_element_real_copy_a = 2 * n + 160
        matrix_element_real_copy_words = 2
        while matrix_element_real_copy_words > 0:
            matrix_element_real_copy_words = matrix_element_real_copy_words - 1
            s[matrix_element_real_copy_words + 202] = s[matrix_element_real_copy_a + matrix_element_real_copy_words]
        matrix_element_i = 2 * s[12] - 42
        element(s_, matrix_element_j, n + 85, matrix_element_i)
    elif n < 9:
        right_side_i = n - 6
        if right_side_i > 3:
            right_side_d = (right_side_i + 6) * 2 + 33
        else:
            right_side_d = (4 * right_side_i - ((right_side_i + 1) * right_side_i >> 1) + 3) * 2 + 33
        right_side_j = s[12] - 16
        s[202] = 0
        s[203] = -4096
        element(s_, right_side_d, right_side_i + 91, right_side_j)
        right_side_j = 0
        subtract(s_, 204, 172, 178)
        right_side_multiply_by_prior_a = int(prior_place(right_side_i, 0))
        multiply(s_, 204, 204, right_side_multiply_by_prior_a)
        if s[right_side_d + 1] < s[205]:
            add_smaller(s_, right_side_d, 204, right_side_d)
        else:
            add_smaller(s_, right_side_d, right_side_d, 204)
        subtract(s_, 204, 174, 180)
        right_side_multiply_by_prior_a = int(prior_place(right_side_i, 1))
        multiply(s_, 204, 204, right_side_multiply_by_prior_a)
        if s[right_side_d + 1] < s[205]:
            add_smaller(s_, right_side_d, 204, right_side_d)
        else:
            add_smaller(s_, right_side_d, right_side_d, 204)
        subtract(s_, 204, 176, 182)
        right_side_multiply_by_prior_a = int(prior_place(right_side_i, 2))
        multiply(s_, 204, 204, right_side_multiply_by_prior_a)
        if s[right_side_d + 1] < s[205]:
            add_smaller(s_, right_side_d, 204, right_side_d)
        else:
            add_smaller(s_, right_side_d, right_side_d, 204)
        right_side_j = 3
        s[51] = 0
        s[52] = -4096
    else:
        sweep(s_, n - 9)


@micropython.viper
def level_and_prior(s_, c_, k: int):
    s = ptr32(s_)
    c = ptr32(c_)
    if not k:
        find_up_x = s[118]
        find_up_y = -s[97]
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
        s[202] = find_up_scale + find_up_z
        s[202 + 1] = find_up_y
        s[202 + 2] = 0 - find_up_x
        s[202 + 3] = 0
        find_up_root_square = s[202] * s[202] + find_up_x * find_up_x + find_up_y * find_up_y
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
            s[202 + 3] = find_up_x
            s[202 + 2] = 0
            s[202 + 1] = s[202]
            s[202] = 0 - find_up_y
        if not find_up_scale:
            s[202] = 1
            find_up_scale = 1
        find_up_look_along_i = 0
        while find_up_look_along_i < 4:
            s[29 + find_up_look_along_i] = (s[202 + find_up_look_along_i] << 14) // find_up_scale
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
                    turn_centre_turned_mean_mean = (s[21 * turn_centre_turned_mean_j + 85 + 9 + turn_centre_k] << 8) // (s[18] >> 2)
                    turn_centre_turned_mean_total = (s[3 * turn_centre_i + 33 + turn_centre_turned_mean_j] * turn_centre_turned_mean_mean >> 2) + turn_centre_turned_mean_total
                    turn_centre_turned_mean_j = turn_centre_turned_mean_j + 1
                turn_centre_turned_mean_result = turn_centre_turned_mean_total >> 12
                s[3 * turn_centre_i + 213 + turn_centre_k] = -(turn_centre_turned_mean_result << turn_centre_shift)
                turn_centre_k = turn_centre_k + 1
            turn_centre_i = turn_centre_i + 1
    elif not k - 1:
        k = 1 if s[11] == c[16] and s[67] > 0 else 0
        carry_i = 0
        carry_put_m = s[237] - s[238]
        carry_put_e = -8
        if not carry_put_m:
            s[202] = 0
            s[202 + 1] = -4096
        else:
            while carry_put_m < 524288 and carry_put_m >= -524288:
                carry_put_m = carry_put_m << 8
                carry_put_e = carry_put_e - 8
            while carry_put_m < 134217728 and carry_put_m >= -134217728:
                carry_put_m = carry_put_m << 1
                carry_put_e = carry_put_e - 1
            while carry_put_m >= 268435456 or carry_put_m < -268435456:
                carry_put_m = carry_put_m >> 1
                carry_put_e = carry_put_e + 1
            s[202] = carry_put_m
            s[202 + 1] = carry_put_e
        carry_put_m = c[12]
        carry_put_e = c[12 + 1]
        if not carry_put_m:
            s[206] = 0
            s[206 + 1] = -4096
        else:
            while carry_put_m < 524288 and carry_put_m >= -524288:
                carry_put_m = carry_put_m << 8
                carry_put_e = carry_put_e - 8
            while carry_put_m < 134217728 and carry_put_m >= -134217728:
                carry_put_m = carry_put_m << 1
                carry_put_e = carry_put_e - 1
            while carry_put_m >= 268435456 or carry_put_m < -268435456:
                carry_put_m = carry_put_m >> 1
                carry_put_e = carry_put_e + 1
            s[206] = carry_put_m
            s[206 + 1] = carry_put_e
        carry_put_m = s[66]
        carry_put_e = 0
        if not carry_put_m:
            s[204] = 0
            s[204 + 1] = -4096
        else:
            while carry_put_m < 524288 and carry_put_m >= -524288:
                carry_put_m = carry_put_m << 8
                carry_put_e = carry_put_e - 8
            while carry_put_m < 134217728 and carry_put_m >= -134217728:
                carry_put_m = carry_put_m << 1
                carry_put_e = carry_put_e - 1
            while carry_put_m >= 268435456 or carry_put_m < -268435456:
                carry_put_m = carry_put_m >> 1
                carry_put_e = carry_put_e + 1
            s[204] = carry_put_m
            s[204 + 1] = carry_put_e
        multiply(s_, 208, 206, 204)
        while carry_i < 3 and k:
            carry_axis(s_, c_, carry_i)
            carry_i = carry_i + 1
        s[238] = s[237]
        s[66] = 0
        if k:
            real_copy_words = 6
            while real_copy_words > 0:
                real_copy_words = real_copy_words - 1
                s[178 + real_copy_words] = s[172 + real_copy_words]
    elif not k - 2:
        spread_prior(s_)
    elif k < 6:
        sweep(s_, k - 3)
    else:
        covariance(s_, 160)
        held_weights_i = 0
        while held_weights_i < 6:
            held_weights_real_copy_d = 196 + held_weights_i
            held_weights_real_copy_a = 190 + held_weights_i
            held_weights_real_copy_words = 2
            while held_weights_real_copy_words > 0:
                held_weights_real_copy_words = held_weights_real_copy_words - 1
                s[held_weights_real_copy_d + held_weights_real_copy_words] = s[held_weights_real_copy_a + held_weights_real_copy_words]
            weigh(s_, c_, 196 + held_weights_i)
            held_weights_i = held_weights_i + 2
        s[14] = 1
        begin_traversal(s_)


@micropython.viper
def last_pass(s: ptr32, c: ptr32) -> int:
    if s[14] >= c[9]:
        return 1
    whole_shift = 0
    whole_m = s[184]
    whole_shift = whole_shift + s[185]
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
    whole_m = s[186]
    whole_shift = whole_shift + s[187]
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
    whole_m = s[188]
    whole_shift = whole_shift + s[189]
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
def remove_slope(s_, c: ptr32):
    s = ptr32(s_)
    i = 0
    while i < 6:
        real_add_d = i + 178
        real_add_a = i + 178
        real_add_b = i + 184
        if s[real_add_a + 1] < s[real_add_b + 1]:
            add_smaller(s_, real_add_d, real_add_b, real_add_a)
        else:
            add_smaller(s_, real_add_d, real_add_a, real_add_b)
        i = i + 2
    note_slope_a = s[14] - 1
    if note_slope_a > 2:
        note_slope_a = 2
    note_slope_a = 3 * note_slope_a + 76
    note_slope_put_m = c[10]
    note_slope_put_e = c[11]
    if not note_slope_put_m:
        s[202] = 0
        s[203] = -4096
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
        s[202] = note_slope_put_m
        s[203] = note_slope_put_e
    multiply(s_, 202, 202, 184)
    note_slope_whole_shift = 0
    note_slope_whole_m = s[202]
    note_slope_whole_shift = note_slope_whole_shift + s[203]
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
        s[202] = 0
        s[203] = -4096
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
        s[202] = note_slope_put_m
        s[203] = note_slope_put_e
    multiply(s_, 202, 202, 186)
    note_slope_whole_shift = 0
    note_slope_whole_m = s[202]
    note_slope_whole_shift = note_slope_whole_shift + s[203]
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
        s[202] = 0
        s[203] = -4096
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
        s[202] = note_slope_put_m
        s[203] = note_slope_put_e
    multiply(s_, 202, 202, 188)
    note_slope_whole_shift = 0
    note_slope_whole_m = s[202]
    note_slope_whole_shift = note_slope_whole_shift + s[203]
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
