# Generated from zerorate/effects.py by `make viper`: edit that file, not this one.
"""What the closed loop has found, subtracted: slots of coefficient times basis (design.md).

Slots are computed once a tick (1 s) on the means of the tick, one slot a sample, so that no sample
waits for all of them; what depends on the rate or the acceleration itself, which a hand moves
faster than a tick, is computed for every sample. One array `e` holds the model and its running
state: docs/layout.md has its words."""

import micropython

from .effect_basis import add_times
from .effect_basis import basis
from .effect_inputs import accumulate
from .effect_inputs import close_tick


@micropython.viper
def run_slot(e: ptr32, e_):
    i = e[5]
    if not i:
        tell_time_a = 32
        e_tell_time_a = ptr32(int(e) + (tell_time_a << 2))
        tell_time_end = 6 * e[1] + 32
        while tell_time_a < tell_time_end:
            if not e_tell_time_a[0] - 8:
                tell_time_shift = e_tell_time_a[1]
                if e[7] >> tell_time_shift > 32767:
                    e_tell_time_a[5] = 8388607
                elif tell_time_shift > 8:
                    e_tell_time_a[5] = e[7] >> tell_time_shift - 8
                else:
                    e_tell_time_a[5] = e[7] << 8 - tell_time_shift
            tell_time_a = tell_time_a + 6
            e_tell_time_a = ptr32(int(e_tell_time_a) + 24)
        if e[7] < 536866816:
            e[7] = e[7] + 2
        e[10] = 0
        e[11] = 0
        e[12] = 0
    if i < e[0]:
        a = i * 40 + 112
        e_a = ptr32(int(e) + (a << 2))
        if not e_a[33]:
            e_a[39] = int(basis(e_, a, e_))
            contribute_shift = e_a[23]
            add_times(10, e_a[39], a + 24, e_, contribute_shift)
    else:
        play_a = (i - e[0]) * 15 + 902
        e_play_a = ptr32(int(e) + (play_a << 2))
        play_centred_u = e[e_play_a[0]]
        if not play_centred_u - -1073741823:
            play_v = -1073741823
        else:
            if play_centred_u < e_play_a[1]:
                play_centred_u = e_play_a[1]
            elif play_centred_u > e_play_a[2]:
                play_centred_u = e_play_a[2]
            play_centred_u = play_centred_u - e_play_a[3]
            play_centred_shift = e_play_a[4]
            if play_centred_shift >> 30:
                play_v = play_centred_u >> 0 - play_centred_shift
            else:
                play_v = play_centred_u << play_centred_shift
        if not play_v - -1073741823:
            pass
        else:
            play_p = e_play_a[14]
            if not e_play_a[13]:
                e_play_a[13] = 1
                play_p = play_v
            elif play_p < play_v - e_play_a[5]:
                play_p = play_v - e_play_a[5]
            elif play_p > play_v + e_play_a[5]:
                play_p = play_v + e_play_a[5]
            e_play_a[14] = play_p
            play_scaled_b = play_p
            play_scaled_high = play_scaled_b >> 15
            play_scaled_b = play_scaled_b & 32767
            play_scaled_middle = (play_p >> 15) * play_scaled_b + (play_p & 32767) * play_scaled_high + ((play_p & 32767) * play_scaled_b >> 15)
            play_scaled_high = (play_p >> 15) * play_scaled_high
            play_v = (play_scaled_high << 6) + (play_scaled_middle >> 9)
            add_times(10, play_p, play_a + 7, e_, e_play_a[6])
            add_times(10, play_v, play_a + 10, e_, e_play_a[6])
    i = i + 1
    if not i - (e[0] + e[19]):
        i = 0
        e[4] = e[4] - 1
        if not e[8] - 2:
            e[8] = 3
            e[7] = 1
            begin_again_i = e[0]
            while begin_again_i > 0:
                begin_again_i = begin_again_i - 1
                e[begin_again_i * 40 + 146] = 0
            begin_again_i = e[19]
            while begin_again_i > 0:
                begin_again_i = begin_again_i - 1
                e[begin_again_i * 15 + 915] = 0
        e[13] = e[10]
        e[14] = e[11]
        e[15] = e[12]
    e[5] = i


@micropython.viper
def sense(s: ptr32, e_, x_, dt_us: int, good: int):
    e = ptr32(e_)
    if not e[8]:
        e[8] = 1
    elif dt_us <= 0:
        pass
    else:
        pass_time_elapsed_us = e[3] + dt_us
        if pass_time_elapsed_us < e[2]:
            e[3] = pass_time_elapsed_us
        else:
            e[3] = pass_time_elapsed_us % e[2]
            pass_time_due = pass_time_elapsed_us // e[2] + e[4]
            if pass_time_due > 4096:
                e[7] = (pass_time_due - 4096 << 1) + e[7]
                pass_time_due = 4096
            e[4] = pass_time_due
            close_tick(e_)
    if good:
        accumulate(e_, x_)
        if not e[8] - 1:
            e[8] = 2
            e[4] = e[4] + 1
            close_tick(e_)
            accumulate(e_, x_)
    left = e[6]
    while left > 0 and e[4] > 0:
        run_slot(e_, e_)
        left = left - 1
    e[16] = e[13]
    e[17] = e[14]
    e[18] = e[15]
    if e[9]:
        add_instant_a = 112
        e_add_instant_a = ptr32(int(e) + (add_instant_a << 2))
        add_instant_i = e[0]
        while add_instant_i > 0:
            if e_add_instant_a[33] + good > 1:
                e_add_instant_a[39] = int(basis(e_, add_instant_a, e_))
                add_instant_contribute_shift = e_add_instant_a[23]
                add_times(16, e_add_instant_a[39], add_instant_a + 24, e_, add_instant_contribute_shift)
            add_instant_a = add_instant_a + 40
            e_add_instant_a = ptr32(int(e_add_instant_a) + 160)
            add_instant_i = add_instant_i - 1
    s[61] = e[16] + 32 >> 6
    s[62] = e[17] + 32 >> 6
    s[63] = e[18] + 32 >> 6
