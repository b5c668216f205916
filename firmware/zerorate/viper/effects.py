# Generated from zerorate/effects.py by `make viper`: edit that file, not this one.
"""What the closed loop has found, subtracted: slots of coefficient times basis (design.md).

Slots are computed once a tick (1 s) on the means of the tick, one slot a sample, so that no sample
waits for all of them; what depends on the rate or the acceleration itself, which a hand moves
faster than a tick, is computed for every sample. One array `e` holds the model and its running
state: see model.py for its words."""

import micropython

from .effect_basis import basis
from .effect_basis import contribute
from .effect_inputs import accumulate
from .effect_inputs import close_tick


@micropython.viper
def sense(s: ptr32, e_, x_, dt_us: int, good: int):
    e = ptr32(e_)
    pass_time_dt_us = dt_us
    if not e[8]:
        e[8] = 1
    elif pass_time_dt_us <= 0:
        pass
    else:
        pass_time_dt_us = pass_time_dt_us + e[3]
        if pass_time_dt_us < e[2]:
            e[3] = pass_time_dt_us
        else:
            e[3] = pass_time_dt_us % e[2]
            pass_time_dt_us = pass_time_dt_us // e[2] + e[4]
            if pass_time_dt_us > 4096:
                e[7] = (pass_time_dt_us - 4096 << 1) + e[7]
                pass_time_dt_us = 4096
            e[4] = pass_time_dt_us
            close_tick(e_)
    if good:
        accumulate(e_, x_)
        if not e[8] - 1:
            e[8] = 2
            e[4] = e[4] + 1
            close_tick(e_)
            accumulate(e_, x_)
    dt_us = e[6]
    while dt_us > 0 and e[4] > 0:
        run_slot_i = e[5]
        if not run_slot_i:
            run_slot_tell_time_a = 32
            e_run_slot_tell_time_a = ptr32(int(e) + (run_slot_tell_time_a << 2))
            run_slot_tell_time_end = 6 * e[1] + 32
            while run_slot_tell_time_a < run_slot_tell_time_end:
                if not e_run_slot_tell_time_a[0] - 8:
                    run_slot_tell_time_shift = e_run_slot_tell_time_a[1]
                    if e[7] >> run_slot_tell_time_shift > 32767:
                        e_run_slot_tell_time_a[5] = 8388607
                    elif run_slot_tell_time_shift > 8:
                        e_run_slot_tell_time_a[5] = e[7] >> run_slot_tell_time_shift - 8
                    else:
                        e_run_slot_tell_time_a[5] = e[7] << 8 - run_slot_tell_time_shift
                run_slot_tell_time_a = run_slot_tell_time_a + 6
                e_run_slot_tell_time_a = ptr32(int(e_run_slot_tell_time_a) + 24)
            if e[7] < 536866816:
                e[7] = e[7] + 2
            e[10] = 0
            e[11] = 0
            e[12] = 0
        run_slot_a = run_slot_i * 40 + 112
        e_run_slot_a = ptr32(int(e) + (run_slot_a << 2))
        if not e_run_slot_a[33]:
            e_run_slot_a[39] = int(basis(e_, run_slot_a, e_))
            contribute(10, run_slot_a, e_)
        run_slot_i = run_slot_i + 1
        if not run_slot_i - e[0]:
            run_slot_i = 0
            e[4] = e[4] - 1
            if not e[8] - 2:
                e[8] = 3
                e[7] = 1
                run_slot_begin_again_i = e[0]
                while run_slot_begin_again_i > 0:
                    run_slot_begin_again_i = run_slot_begin_again_i - 1
                    e[run_slot_begin_again_i * 40 + 146] = 0
            e[13] = e[10]
            e[14] = e[11]
            e[15] = e[12]
        e[5] = run_slot_i
        dt_us = dt_us - 1
    e[16] = e[13]
    e[17] = e[14]
    e[18] = e[15]
    if e[9]:
        add_instant_a = 112
        add_instant_i = e[0]
        while add_instant_i > 0:
            if e[add_instant_a + 33] + good > 1:
                e[add_instant_a + 39] = int(basis(e_, add_instant_a, e_))
                contribute(16, add_instant_a, e_)
            add_instant_a = add_instant_a + 40
            add_instant_i = add_instant_i - 1
    dt_us = 0
    s[61] = e[16] + 32 >> 6
    s[62] = e[17] + 32 >> 6
    s[63] = e[18] + 32 >> 6
    dt_us = 3
