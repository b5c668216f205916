# Generated from zerorate/effect_refine.py by `make viper`: edit that file, not this one.
"""Coefficients that go on learning on the board, off by default: another unit of the same part.

A Kalman filter (R. E. Kalman, 1960) whose state is, for each axis, an offset that walks, a straight
line over temperature, and how far each slot's coefficient is from the model's; the three axes have
one covariance. It is told each still segment's rate less what the model's own effects say, so
neither the turn-on offset nor the line is taken for an effect. No coefficient leaves the model's
own by more than the bound. Numbers are those of real.py; words of `e`: docs/layout.md."""

import micropython

from .real import add_smaller
from .real import divide
from .real import multiply
from .real import put
from .real import subtract


@micropython.viper
def attend(s: ptr32, c: ptr32, e_):
    e = ptr32(e_)
    if not s[17] and (not s[46] - 1) and (not s[48]):
        effect_refine_observe_n = c[5] << c[4]
        if not e[26] or e[582]:
            pass
        else:
            if not e[588]:
                e[587] = s[47]
            effect_refine_observe_put_m = 1
            effect_refine_observe_put_e = 0
            while effect_refine_observe_put_m < 524288 and effect_refine_observe_put_m >= -524288:
                effect_refine_observe_put_m = effect_refine_observe_put_m << 8
                effect_refine_observe_put_e = effect_refine_observe_put_e - 8
            while effect_refine_observe_put_m < 134217728 and effect_refine_observe_put_m >= -134217728:
                effect_refine_observe_put_m = effect_refine_observe_put_m << 1
                effect_refine_observe_put_e = effect_refine_observe_put_e - 1
            while effect_refine_observe_put_m >= 268435456 or effect_refine_observe_put_m < -268435456:
                effect_refine_observe_put_m = effect_refine_observe_put_m >> 1
                effect_refine_observe_put_e = effect_refine_observe_put_e + 1
            e[602] = effect_refine_observe_put_m
            e[603] = effect_refine_observe_put_e
            effect_refine_observe_i = s[47] - e[587]
            effect_refine_observe_put_m = effect_refine_observe_i
            effect_refine_observe_put_e = -8
            if not effect_refine_observe_put_m:
                e[604] = 0
                e[605] = -4096
            else:
                while effect_refine_observe_put_m < 524288 and effect_refine_observe_put_m >= -524288:
                    effect_refine_observe_put_m = effect_refine_observe_put_m << 8
                    effect_refine_observe_put_e = effect_refine_observe_put_e - 8
                while effect_refine_observe_put_m < 134217728 and effect_refine_observe_put_m >= -134217728:
                    effect_refine_observe_put_m = effect_refine_observe_put_m << 1
                    effect_refine_observe_put_e = effect_refine_observe_put_e - 1
                while effect_refine_observe_put_m >= 268435456 or effect_refine_observe_put_m < -268435456:
                    effect_refine_observe_put_m = effect_refine_observe_put_m >> 1
                    effect_refine_observe_put_e = effect_refine_observe_put_e + 1
                e[604] = effect_refine_observe_put_m
                e[605] = effect_refine_observe_put_e
            effect_refine_observe_i = 0
            effect_refine_observe_effect_refine_mean_q8_total = s[42]
            effect_refine_observe_effect_refine_mean_q8_sign = 1
            if effect_refine_observe_effect_refine_mean_q8_total >> 30:
                effect_refine_observe_effect_refine_mean_q8_total = -effect_refine_observe_effect_refine_mean_q8_total
                effect_refine_observe_effect_refine_mean_q8_sign = -1
            if effect_refine_observe_effect_refine_mean_q8_total // effect_refine_observe_n > 8191:
                effect_refine_observe_effect_refine_mean_q8_result = effect_refine_observe_effect_refine_mean_q8_sign * 2097151
            else:
                effect_refine_observe_effect_refine_mean_q8_result = ((effect_refine_observe_effect_refine_mean_q8_total // effect_refine_observe_n << 8) + (effect_refine_observe_effect_refine_mean_q8_total % effect_refine_observe_n << 8) // effect_refine_observe_n) * effect_refine_observe_effect_refine_mean_q8_sign
            e[584] = effect_refine_observe_effect_refine_mean_q8_result
            effect_refine_observe_effect_refine_mean_q8_total = s[43]
            effect_refine_observe_effect_refine_mean_q8_sign = 1
            if effect_refine_observe_effect_refine_mean_q8_total >> 30:
                effect_refine_observe_effect_refine_mean_q8_total = -effect_refine_observe_effect_refine_mean_q8_total
                effect_refine_observe_effect_refine_mean_q8_sign = -1
            if effect_refine_observe_effect_refine_mean_q8_total // effect_refine_observe_n > 8191:
                effect_refine_observe_effect_refine_mean_q8_result = effect_refine_observe_effect_refine_mean_q8_sign * 2097151
            else:
                effect_refine_observe_effect_refine_mean_q8_result = ((effect_refine_observe_effect_refine_mean_q8_total // effect_refine_observe_n << 8) + (effect_refine_observe_effect_refine_mean_q8_total % effect_refine_observe_n << 8) // effect_refine_observe_n) * effect_refine_observe_effect_refine_mean_q8_sign
            e[585] = effect_refine_observe_effect_refine_mean_q8_result
            effect_refine_observe_effect_refine_mean_q8_total = s[44]
            effect_refine_observe_effect_refine_mean_q8_sign = 1
            if effect_refine_observe_effect_refine_mean_q8_total >> 30:
                effect_refine_observe_effect_refine_mean_q8_total = -effect_refine_observe_effect_refine_mean_q8_total
                effect_refine_observe_effect_refine_mean_q8_sign = -1
            if effect_refine_observe_effect_refine_mean_q8_total // effect_refine_observe_n > 8191:
                effect_refine_observe_effect_refine_mean_q8_result = effect_refine_observe_effect_refine_mean_q8_sign * 2097151
            else:
                effect_refine_observe_effect_refine_mean_q8_result = ((effect_refine_observe_effect_refine_mean_q8_total // effect_refine_observe_n << 8) + (effect_refine_observe_effect_refine_mean_q8_total % effect_refine_observe_n << 8) // effect_refine_observe_n) * effect_refine_observe_effect_refine_mean_q8_sign
            e[586] = effect_refine_observe_effect_refine_mean_q8_result
            effect_refine_observe_i = 3
            effect_refine_observe_i = 2
            while effect_refine_observe_i < e[583]:
                effect_refine_observe_a = (effect_refine_observe_i - 2) * 40 + 112
                e_effect_refine_observe_a = ptr32(int(e) + (effect_refine_observe_a << 2))
                put(e_effect_refine_observe_a[39], -24, 2 * effect_refine_observe_i + 602, e_)
                if not e_effect_refine_observe_a[33] - 1:
                    put(0, 0, 2 * effect_refine_observe_i + 602, e_)
                effect_refine_observe_i = effect_refine_observe_i + 1
            e[582] = 1
    elif e[582]:
        refine(e_, e_)


@micropython.viper
def product(a: int, b: int, e: ptr32, to: int, e_):
    e_to = ptr32(int(e) + (to << 2))
    e_to[0] = 0
    e_to[1] = -4096
    i = e[583]
    while i > 0:
        multiply(e_, a, b, 590)
        if e_to[1] < e[591]:
            add_smaller(e_, 590, to, to)
        else:
            add_smaller(e_, to, 590, to)
        a = a + 2
        b = b + 2
        i = i - 1


@micropython.viper
def miss(restore_put_learned_put_m: int, restore_put_learned_put_e: int, e: ptr32, axis: int, e_):
    i = axis * 20 + 642
    product(i, 602, e_, 592, e_)
    put_m = e[axis + 584]
    put_e = -8
    if not put_m:
        e[590] = 0
        e[591] = -4096
    else:
        while put_m < 524288 and put_m >= -524288:
            put_m = put_m << 8
            put_e = put_e - 8
        while put_m < 134217728 and put_m >= -134217728:
            put_m = put_m << 1
            put_e = put_e - 1
        while put_m >= 268435456 or put_m < -268435456:
            put_m = put_m >> 1
            put_e = put_e + 1
        e[590] = put_m
        e[591] = put_e
    i = 2 * axis + 596
    subtract(e_, 592, i, 590, e_)
    restore_a = 112
    restore_i = 606
    while restore_i < 2 * e[583] + 602:
        restore_put_learned_m = e[restore_a + 24 + axis]
        restore_put_learned_m = restore_put_learned_m - e[restore_a + 30 + axis]
        restore_put_learned_exponent = 10 - e[restore_a + 23]
        restore_put_learned_put_m = restore_put_learned_m
        restore_put_learned_put_e = restore_put_learned_exponent
        if not restore_put_learned_put_m:
            e[590] = 0
            e[591] = -4096
        else:
            while restore_put_learned_put_m < 524288 and restore_put_learned_put_m >= -524288:
                restore_put_learned_put_m = restore_put_learned_put_m << 8
                restore_put_learned_put_e = restore_put_learned_put_e - 8
            while restore_put_learned_put_m < 134217728 and restore_put_learned_put_m >= -134217728:
                restore_put_learned_put_m = restore_put_learned_put_m << 1
                restore_put_learned_put_e = restore_put_learned_put_e - 1
            while restore_put_learned_put_m >= 268435456 or restore_put_learned_put_m < -268435456:
                restore_put_learned_put_m = restore_put_learned_put_m >> 1
                restore_put_learned_put_e = restore_put_learned_put_e + 1
            e[590] = restore_put_learned_put_m
            e[591] = restore_put_learned_put_e
        multiply(e_, 590, restore_i, 590)
        if e[i + 1] < e[591]:
            add_smaller(e_, 590, i, i)
        else:
            add_smaller(e_, i, 590, i)
        restore_a = restore_a + 40
        restore_i = restore_i + 2


@micropython.viper
def believe(put_m: int, put_e: int, e: ptr32, i: int, e_):
    divide(e_, 2 * i + 622, 594, 592)
    multiply(e_, 592, 596, 590)
    at = 2 * i + 642
    if e[at + 1] < e[591]:
        add_smaller(e_, 590, at, at)
    else:
        add_smaller(e_, at, 590, at)
    multiply(e_, 592, 598, 590)
    at = 2 * i + 662
    if e[at + 1] < e[591]:
        add_smaller(e_, 590, at, at)
    else:
        add_smaller(e_, at, 590, at)
    multiply(e_, 592, 600, 590)
    at = 2 * i + 682
    if e[at + 1] < e[591]:
        add_smaller(e_, 590, at, at)
    else:
        add_smaller(e_, at, 590, at)
    at = i * 20 + 702
    i = 0
    while i < e[583]:
        multiply(e_, 592, 2 * i + 622, 590)
        put_m = -e[590]
        put_e = e[591]
        if not put_m:
            e[590] = 0
            e[591] = -4096
        else:
            while put_m < 524288 and put_m >= -524288:
                put_m = put_m << 8
                put_e = put_e - 8
            while put_m < 134217728 and put_m >= -134217728:
                put_m = put_m << 1
                put_e = put_e - 1
            while put_m >= 268435456 or put_m < -268435456:
                put_m = put_m >> 1
                put_e = put_e + 1
            e[590] = put_m
            e[591] = put_e
        if e[at + 1] < e[591]:
            add_smaller(e_, 590, at, at)
        else:
            add_smaller(e_, at, 590, at)
        at = at + 2
        i = i + 1


@micropython.viper
def move(state: int, e: ptr32, a: int):
    e_a = ptr32(int(e) + (a << 2))
    bound_most = 0
    bound_m = e_a[30]
    if bound_m >> 30:
        bound_m = -bound_m
    if bound_m > 0:
        bound_most = bound_m
    bound_m = e_a[31]
    if bound_m >> 30:
        bound_m = -bound_m
    if bound_m > bound_most:
        bound_most = bound_m
    bound_m = e_a[32]
    if bound_m >> 30:
        bound_m = -bound_m
    if bound_m > bound_most:
        bound_most = bound_m
    most = (bound_most >> 3) * e[27]
    state = 2 * state + 642
    shift = e_a[23] - 10
    i = 3
    while i > 0:
        whole_shift = shift
        whole_m = e[state]
        whole_shift = whole_shift + e[state + 1]
        if whole_shift > 1 and whole_m:
            whole_m = 536870911 if whole_m > 0 else -536870911
        elif not whole_shift >> 30:
            whole_m = whole_m << whole_shift
        elif whole_shift > -30:
            whole_m = (1 << -1 - whole_shift) + whole_m >> 0 - whole_shift
        else:
            whole_m = 0
        d = whole_m
        if d > most:
            d = most
        elif d < 0 - most:
            d = 0 - most
        e_a[24] = e_a[30] + d
        a = a + 1
        e_a = ptr32(int(e_a) + 4)
        state = state + 20
        i = i - 1


@micropython.viper
def refine(e: ptr32, e_):
    n = e[583]
    i = e[582] - 1
    if i >> 30:
        return
    e[582] = e[582] + 1
    if i < n:
        if not i:
            put_m = 1
            put_e = -10
            while put_m < 524288 and put_m >= -524288:
                put_m = put_m << 8
                put_e = put_e - 8
            while put_m < 134217728 and put_m >= -134217728:
                put_m = put_m << 1
                put_e = put_e - 1
            while put_m >= 268435456 or put_m < -268435456:
                put_m = put_m >> 1
                put_e = put_e + 1
            e[590] = put_m
            e[591] = put_e
            if e[703] < e[591]:
                add_smaller(e_, 590, 702, 702)
            else:
                add_smaller(e_, 702, 590, 702)
        product(i * 20 + 702, 602, e_, 2 * i + 622, e_)
    elif not i - n:
        product(622, 602, e_, 594, e_)
        put_m = 1
        put_e = -2
        while put_m < 524288 and put_m >= -524288:
            put_m = put_m << 8
            put_e = put_e - 8
        while put_m < 134217728 and put_m >= -134217728:
            put_m = put_m << 1
            put_e = put_e - 1
        while put_m >= 268435456 or put_m < -268435456:
            put_m = put_m >> 1
            put_e = put_e + 1
        e[590] = put_m
        e[591] = put_e
        if e[595] < e[591]:
            add_smaller(e_, 590, 594, 594)
        else:
            add_smaller(e_, 594, 590, 594)
    elif i < n + 4:
        miss(0, 0, e_, i - n - 1, e_)
    elif i < 2 * n + 4:
        believe(0, 0, e_, i - n - 4, e_)
    else:
        i = 2
        while i < n and e[588] >= 64:
            move(i, e_, (i - 2) * 40 + 112)
            i = i + 1
        e[582] = 0
        if e[588] < 65535:
            e[588] = e[588] + 1


@micropython.viper
def renew(e: ptr32):
    e[582] = 0
    e[588] = 0
    i = 0
    while i < e[583]:
        put_d = 2 * i + 702
        put_m = 0
        put_e = 0
        e[put_d] = 0
        e[put_d + 1] = -4096
        put_d = i * 20 + 702
        put_m = 0
        put_e = 0
        e[put_d] = 0
        e[put_d + 1] = -4096
        i = i + 1
    put_m = 1
    put_e = 24
    while put_m < 524288 and put_m >= -524288:
        put_m = put_m << 8
        put_e = put_e - 8
    while put_m < 134217728 and put_m >= -134217728:
        put_m = put_m << 1
        put_e = put_e - 1
    while put_m >= 268435456 or put_m < -268435456:
        put_m = put_m >> 1
        put_e = put_e + 1
    e[702] = put_m
    e[703] = put_e
    i = 0
    put_d = 642
    put_m = 0
    put_e = 0
    e[642] = 0
    e[643] = -4096
    put_d = 662
    put_m = 0
    put_e = 0
    e[662] = 0
    e[663] = -4096
    put_d = 682
    put_m = 0
    put_e = 0
    e[682] = 0
    e[683] = -4096
    i = 3


@micropython.viper
def begin(e_, slots: int):
    e = ptr32(e_)
    e[583] = slots + 2
    i = 0
    while i < 30:
        put_d = 2 * i + 642
        put_m = 0
        put_e = 0
        e[put_d] = 0
        e[put_d + 1] = -4096
        i = i + 1
    i = 0
    while i < 100:
        put_d = 2 * i + 702
        put_m = 0
        put_e = 0
        e[put_d] = 0
        e[put_d + 1] = -4096
        i = i + 1
    put_d = 724
    put_m = 1
    put_e = 6
    while put_m < 524288 and put_m >= -524288:
        put_m = put_m << 8
        put_e = put_e - 8
    while put_m < 134217728 and put_m >= -134217728:
        put_m = put_m << 1
        put_e = put_e - 1
    while put_m >= 268435456 or put_m < -268435456:
        put_m = put_m >> 1
        put_e = put_e + 1
    e[724] = put_m
    e[725] = put_e
    i = 0
    while i < slots:
        doubt_a = i * 40 + 112
        e_doubt_a = ptr32(int(e) + (doubt_a << 2))
        doubt_p = (i + 2) * 22 + 702
        doubt_bound_most = 0
        doubt_bound_m = e_doubt_a[30]
        if doubt_bound_m >> 30:
            doubt_bound_m = -doubt_bound_m
        if doubt_bound_m > 0:
            doubt_bound_most = doubt_bound_m
        doubt_bound_m = e_doubt_a[31]
        if doubt_bound_m >> 30:
            doubt_bound_m = -doubt_bound_m
        if doubt_bound_m > doubt_bound_most:
            doubt_bound_most = doubt_bound_m
        doubt_bound_m = e_doubt_a[32]
        if doubt_bound_m >> 30:
            doubt_bound_m = -doubt_bound_m
        if doubt_bound_m > doubt_bound_most:
            doubt_bound_most = doubt_bound_m
        doubt_m = (doubt_bound_most >> 3) * e[27]
        doubt_exponent = 10 - e_doubt_a[23]
        doubt_put_m = doubt_m
        doubt_put_e = doubt_exponent
        if not doubt_put_m:
            e[590] = 0
            e[591] = -4096
        else:
            while doubt_put_m < 524288 and doubt_put_m >= -524288:
                doubt_put_m = doubt_put_m << 8
                doubt_put_e = doubt_put_e - 8
            while doubt_put_m < 134217728 and doubt_put_m >= -134217728:
                doubt_put_m = doubt_put_m << 1
                doubt_put_e = doubt_put_e - 1
            while doubt_put_m >= 268435456 or doubt_put_m < -268435456:
                doubt_put_m = doubt_put_m >> 1
                doubt_put_e = doubt_put_e + 1
            e[590] = doubt_put_m
            e[591] = doubt_put_e
        multiply(e_, 590, 590, doubt_p)
        i = i + 1
    e[582] = 0
    e[588] = 0
    renew_i = 0
    while renew_i < e[583]:
        renew_put_d = 2 * renew_i + 702
        renew_put_m = 0
        renew_put_e = 0
        e[renew_put_d] = 0
        e[renew_put_d + 1] = -4096
        renew_put_d = renew_i * 20 + 702
        renew_put_m = 0
        renew_put_e = 0
        e[renew_put_d] = 0
        e[renew_put_d + 1] = -4096
        renew_i = renew_i + 1
    renew_put_m = 1
    renew_put_e = 24
    while renew_put_m < 524288 and renew_put_m >= -524288:
        renew_put_m = renew_put_m << 8
        renew_put_e = renew_put_e - 8
    while renew_put_m < 134217728 and renew_put_m >= -134217728:
        renew_put_m = renew_put_m << 1
        renew_put_e = renew_put_e - 1
    while renew_put_m >= 268435456 or renew_put_m < -268435456:
        renew_put_m = renew_put_m >> 1
        renew_put_e = renew_put_e + 1
    e[702] = renew_put_m
    e[703] = renew_put_e
    renew_i = 0
    renew_put_d = 642
    renew_put_m = 0
    renew_put_e = 0
    e[642] = 0
    e[643] = -4096
    renew_put_d = 662
    renew_put_m = 0
    renew_put_e = 0
    e[662] = 0
    e[663] = -4096
    renew_put_d = 682
    renew_put_m = 0
    renew_put_e = 0
    e[682] = 0
    e[683] = -4096
    renew_i = 3
