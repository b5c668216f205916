# Generated from zerorate/motion_verdict.py by `make viper`: edit that file, not this one.
"""Whether a window in motion may teach a bias, and what is kept of it.

Refused: a window that hardly moves (the still source's), one that turned faster than the nodes
hold, one whose mean force is not 1 g along one direction (the integration lost its way), and one
that contradicts what is known: a turn that stays turned. Contradiction that lasts is believed."""

import micropython

from .least_squares import covariance
from .least_squares import place
from .real import multiply
from .real import put
from .real import root_of
from .real import subtract
from .real import whole
from .thermal import learn_slopes
from .thermal import present


@micropython.viper
def clear(s: ptr32, c: ptr32):
    s[179] = 0
    s[180] = -4096
    s[74] = 536870911
    s[181] = 0
    s[182] = -4096
    s[75] = 536870911
    s[183] = 0
    s[184] = -4096
    s[76] = 536870911
    forget_slopes_i = 0
    forget_slopes_put_m = c[23]
    forget_slopes_put_e = c[24]
    if not forget_slopes_put_m:
        s[189] = 0
        s[190] = -4096
    else:
        while forget_slopes_put_m < 524288 and forget_slopes_put_m >= -524288:
            forget_slopes_put_m = forget_slopes_put_m << 8
            forget_slopes_put_e = forget_slopes_put_e - 8
        while forget_slopes_put_m < 134217728 and forget_slopes_put_m >= -134217728:
            forget_slopes_put_m = forget_slopes_put_m << 1
            forget_slopes_put_e = forget_slopes_put_e - 1
        while forget_slopes_put_m >= 268435456 or forget_slopes_put_m < -268435456:
            forget_slopes_put_m = forget_slopes_put_m >> 1
            forget_slopes_put_e = forget_slopes_put_e + 1
        s[189] = forget_slopes_put_m
        s[190] = forget_slopes_put_e
    while forget_slopes_i < 9:
        s[forget_slopes_i + 229] = 0
        s[forget_slopes_i + 230] = 0
        forget_slopes_pack_d = forget_slopes_i + 231
        s_forget_slopes_pack_d = ptr32(int(s) + (forget_slopes_pack_d << 2))
        forget_slopes_pack_e = s[190] + 96
        if not s[189] or forget_slopes_pack_e >> 30 or forget_slopes_pack_e > 127:
            s_forget_slopes_pack_d[0] = 0
        else:
            s_forget_slopes_pack_d[0] = (s[189] >> 5 << 7) + forget_slopes_pack_e
        forget_slopes_i = forget_slopes_i + 3
    s[68] = 0
    s[70] = 0
    s[12] = c[17]
    if c[20]:
        s[12] = c[17] + 3
    s[11] = 1 << s[12]


@micropython.viper
def know_nothing(put_m: int, put_e: int, real_copy_words: int, s: ptr32, tilt: int, c: ptr32, heading: int):
    put_m = 0
    put_e = 0
    s[149] = 0
    s[150] = -4096
    put_m = 0
    put_e = 0
    s[151] = 0
    s[152] = -4096
    put_m = 0
    put_e = 0
    s[153] = 0
    s[154] = -4096
    put_m = 0
    put_e = 0
    s[155] = 0
    s[156] = -4096
    put_m = 0
    put_e = 0
    s[157] = 0
    s[158] = -4096
    put_m = 0
    put_e = 0
    s[159] = 0
    s[160] = -4096
    put_m = c[14]
    put_e = c[15]
    if not put_m:
        s[149] = 0
        s[150] = -4096
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
        s[149] = put_m
        s[150] = put_e
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 155] = s[real_copy_words + 149]
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 159] = s[real_copy_words + 149]
    put_m = 0
    put_e = 0
    s[173] = 0
    s[174] = -4096
    put_m = tilt
    put_e = 0
    if not put_m:
        s[191] = 0
        s[192] = -4096
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
        s[191] = put_m
        s[192] = put_e
    put_m = 0
    put_e = 0
    s[175] = 0
    s[176] = -4096
    put_m = tilt
    put_e = 0
    if not put_m:
        s[193] = 0
        s[194] = -4096
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
        s[193] = put_m
        s[194] = put_e
    put_m = 0
    put_e = 0
    s[177] = 0
    s[178] = -4096
    tilt = heading
    put_m = tilt
    put_e = 0
    if not put_m:
        s[195] = 0
        s[196] = -4096
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
        s[195] = put_m
        s[196] = put_e


@micropython.viper
def start_window(s: ptr32, c: ptr32, s_, c_) -> int:
    n = s[11]
    if s[9] < n or s[10] < n >> 1:
        return 0
    if s[64]:
        s[10] = 0
        s[17] = 5
        return 0
    s[10] = 0
    s[14] = 0
    if c[20]:
        s[14] = 1
    s[16] = s[8] - n
    if s[16] >> 30:
        s[16] = s[16] + c[8]
    if n < c[16]:
        know_nothing(0, 0, 0, s_, 6711, c_, 41943)
    elif not s[68]:
        know_nothing(0, 0, 0, s_, 167772, c_, 1509949)
    else:
        real_copy_words = 6
        while real_copy_words > 0:
            real_copy_words = real_copy_words - 1
            s[real_copy_words + 173] = s[real_copy_words + 179]
    n = 0
    while n < 9:
        s[n + 214] = 0
        n = n + 1
    s[29] = 16384
    s[30] = 0
    s[31] = 0
    s[32] = 0
    return 1


@micropython.viper
def louder(s: ptr32, s_) -> int:
    put_m = s[191]
    put_e = s[192] + 8
    if not put_m:
        s[203] = 0
        s[204] = -4096
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
        s[203] = put_m
        s[204] = put_e
    subtract(s_, 223, 209, 203, s_)
    if s[209] >> 30:
        return 1
    return 0


@micropython.viper
def contradicts(put_m: int, s: ptr32, s_) -> int:
    d = 149
    put_m = s[149]
    put_e = s[150] + 4
    if not put_m:
        s[203] = 0
        s[204] = -4096
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
        s[203] = put_m
        s[204] = put_e
    subtract(s_, 173, 205, 179, s_)
    multiply(s_, 205, 205, 205)
    subtract(s_, 205, 209, 203, s_)
    if s[209] >> 30:
        less_result = 1
    else:
        less_result = 0
    if less_result:
        return 1
    d = d + 6
    put_m = s[d]
    put_e = s[d + 1] + 4
    if not put_m:
        s[203] = 0
        s[204] = -4096
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
        s[203] = put_m
        s[204] = put_e
    subtract(s_, 175, 205, 181, s_)
    multiply(s_, 205, 205, 205)
    subtract(s_, 205, 209, 203, s_)
    if s[209] >> 30:
        less_result = 1
    else:
        less_result = 0
    if less_result:
        return 1
    d = d + 4
    put_m = s[d]
    put_e = s[d + 1] + 4
    if not put_m:
        s[203] = 0
        s[204] = -4096
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
        s[203] = put_m
        s[204] = put_e
    subtract(s_, 177, 205, 183, s_)
    multiply(s_, 205, 205, 205)
    subtract(s_, 205, 209, 203, s_)
    if s[209] >> 30:
        less_result = 1
    else:
        less_result = 0
    if less_result:
        return 1
    d = d + 2
    return 0


@micropython.viper
def finish(s_, c_) -> int:
    s = ptr32(s_)
    c = ptr32(c_)
    while True:
        if s[64]:
            reason = 5
            break
        if s[65] >= c[7] << s[12]:
            verdict_moves_result = 1
        elif s[66] < c[26] << s[12] or s[66] << 1 < s[65]:
            verdict_moves_result = 0
        else:
            verdict_moves_result = 1
        if not verdict_moves_result:
            reason = 3
            break
        if c[20] or s[11] < c[16]:
            reason = 2
            break
        if (s[63] << 8) // (s[18] >> 2) < c[18]:
            reason = 6
            break
        if s[68] >= 3:
            if int(contradicts(0, s_, s_)) or int(louder(s_, s_)):
                reason = 4
                break
        reason = 2
        break
    s[17] = reason
    if reason - 2:
        refuse_i = 0
        refuse_real_copy_words = 6
        while refuse_real_copy_words > 0:
            refuse_real_copy_words = refuse_real_copy_words - 1
            s[refuse_real_copy_words + 179] = s[refuse_real_copy_words + 173]
        s[69] = s[69] + 1
        if reason - 4 and reason - 6:
            pass
        else:
            s[70] = s[70] + 1
            if s[70] < c[19]:
                pass
            else:
                s[70] = 0
                if not reason - 6:
                    s[179] = 0
                    s[180] = -4096
                    s[74] = 536870911
                    s[181] = 0
                    s[182] = -4096
                    s[75] = 536870911
                    s[183] = 0
                    s[184] = -4096
                    s[76] = 536870911
                    refuse_motion_verdict_clear_forget_slopes_i = 0
                    refuse_motion_verdict_clear_forget_slopes_put_m = c[23]
                    refuse_motion_verdict_clear_forget_slopes_put_e = c[24]
                    if not refuse_motion_verdict_clear_forget_slopes_put_m:
                        s[189] = 0
                        s[190] = -4096
                    else:
                        while refuse_motion_verdict_clear_forget_slopes_put_m < 524288 and refuse_motion_verdict_clear_forget_slopes_put_m >= -524288:
                            refuse_motion_verdict_clear_forget_slopes_put_m = refuse_motion_verdict_clear_forget_slopes_put_m << 8
                            refuse_motion_verdict_clear_forget_slopes_put_e = refuse_motion_verdict_clear_forget_slopes_put_e - 8
                        while refuse_motion_verdict_clear_forget_slopes_put_m < 134217728 and refuse_motion_verdict_clear_forget_slopes_put_m >= -134217728:
                            refuse_motion_verdict_clear_forget_slopes_put_m = refuse_motion_verdict_clear_forget_slopes_put_m << 1
                            refuse_motion_verdict_clear_forget_slopes_put_e = refuse_motion_verdict_clear_forget_slopes_put_e - 1
                        while refuse_motion_verdict_clear_forget_slopes_put_m >= 268435456 or refuse_motion_verdict_clear_forget_slopes_put_m < -268435456:
                            refuse_motion_verdict_clear_forget_slopes_put_m = refuse_motion_verdict_clear_forget_slopes_put_m >> 1
                            refuse_motion_verdict_clear_forget_slopes_put_e = refuse_motion_verdict_clear_forget_slopes_put_e + 1
                        s[189] = refuse_motion_verdict_clear_forget_slopes_put_m
                        s[190] = refuse_motion_verdict_clear_forget_slopes_put_e
                    while refuse_motion_verdict_clear_forget_slopes_i < 9:
                        s[refuse_motion_verdict_clear_forget_slopes_i + 229] = 0
                        s[refuse_motion_verdict_clear_forget_slopes_i + 230] = 0
                        refuse_motion_verdict_clear_forget_slopes_pack_d = refuse_motion_verdict_clear_forget_slopes_i + 231
                        s_refuse_motion_verdict_clear_forget_slopes_pack_d = ptr32(int(s) + (refuse_motion_verdict_clear_forget_slopes_pack_d << 2))
                        refuse_motion_verdict_clear_forget_slopes_pack_e = s[190] + 96
                        if not s[189] or refuse_motion_verdict_clear_forget_slopes_pack_e >> 30 or refuse_motion_verdict_clear_forget_slopes_pack_e > 127:
                            s_refuse_motion_verdict_clear_forget_slopes_pack_d[0] = 0
                        else:
                            s_refuse_motion_verdict_clear_forget_slopes_pack_d[0] = (s[189] >> 5 << 7) + refuse_motion_verdict_clear_forget_slopes_pack_e
                        refuse_motion_verdict_clear_forget_slopes_i = refuse_motion_verdict_clear_forget_slopes_i + 3
                    s[68] = 0
                    s[70] = 0
                    s[12] = c[17]
                    if c[20]:
                        s[12] = c[17] + 3
                    s[11] = 1 << s[12]
                else:
                    refuse_real_copy_words = 6
                    while refuse_real_copy_words > 0:
                        refuse_real_copy_words = refuse_real_copy_words - 1
                        s[refuse_real_copy_words + 191] = s[refuse_real_copy_words + 223]
                    while refuse_i < 12:
                        refuse_put_d = refuse_i + 149
                        s_refuse_put_d = ptr32(int(s) + (refuse_put_d << 2))
                        refuse_put_m = s[refuse_i + 149]
                        refuse_put_e = s[refuse_i + 150] + 8
                        if not refuse_put_m:
                            s_refuse_put_d[0] = 0
                            s_refuse_put_d[1] = -4096
                        else:
                            while refuse_put_m < 524288 and refuse_put_m >= -524288:
                                refuse_put_m = refuse_put_m << 8
                                refuse_put_e = refuse_put_e - 8
                            while refuse_put_m < 134217728 and refuse_put_m >= -134217728:
                                refuse_put_m = refuse_put_m << 1
                                refuse_put_e = refuse_put_e - 1
                            while refuse_put_m >= 268435456 or refuse_put_m < -268435456:
                                refuse_put_m = refuse_put_m >> 1
                                refuse_put_e = refuse_put_e + 1
                            s_refuse_put_d[0] = refuse_put_m
                            s_refuse_put_d[1] = refuse_put_e
                        refuse_i = refuse_i + 2
        return 0
    if s[11] < c[16]:
        s[11] = s[11] << 1
        s[12] = s[12] + 1
        s[17] = 1
        return 0
    learn_slopes(0, 0, 0, s_, s_)
    covariance(0, 0, 149, s_)
    keep_noise_i = 0
    while keep_noise_i < 6:
        keep_noise_put_m = 11469
        keep_noise_put_e = -14
        while keep_noise_put_m < 524288 and keep_noise_put_m >= -524288:
            keep_noise_put_m = keep_noise_put_m << 8
            keep_noise_put_e = keep_noise_put_e - 8
        while keep_noise_put_m < 134217728 and keep_noise_put_m >= -134217728:
            keep_noise_put_m = keep_noise_put_m << 1
            keep_noise_put_e = keep_noise_put_e - 1
        while keep_noise_put_m >= 268435456 or keep_noise_put_m < -268435456:
            keep_noise_put_m = keep_noise_put_m >> 1
            keep_noise_put_e = keep_noise_put_e + 1
        s[203] = keep_noise_put_m
        s[204] = keep_noise_put_e
        multiply(s_, keep_noise_i + 223, 203, keep_noise_i + 191)
        keep_noise_i = keep_noise_i + 2
    s[68] = s[68] + 1
    s[70] = 0
    publish(0, 0, s_, c_, s_)
    return 1


@micropython.viper
def publish(put_m: int, real_copy_words: int, s: ptr32, c: ptr32, s_):
    put_m = c[10]
    put_e = c[11]
    if not put_m:
        s[203] = 0
        s[204] = -4096
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
        s[203] = put_m
        s[204] = put_e
    present(s_, 0, s_)
    multiply(s_, 205, 203, 205)
    whole_shift = 0
    whole_m = s[205]
    whole_shift = whole_shift + s[206]
    if whole_shift > 1 and whole_m:
        whole_m = 536870911 if whole_m > 0 else -536870911
    elif not whole_shift >> 30:
        whole_m = whole_m << whole_shift
    elif whole_shift > -30:
        whole_m = (1 << -1 - whole_shift) + whole_m >> 0 - whole_shift
    else:
        whole_m = 0
    whole_result = whole_m
    s[71] = whole_result
    real_copy_a = int(place(0, 0))
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 205] = s[real_copy_a + real_copy_words]
    put(-s[205], s[206], 205, s_)
    root_of(s_, 205, 205)
    multiply(s_, 205, 203, 205)
    s[74] = int(whole(0, 205, s_))
    put_m = c[10]
    put_e = c[11]
    if not put_m:
        s[203] = 0
        s[204] = -4096
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
        s[203] = put_m
        s[204] = put_e
    present(s_, 1, s_)
    multiply(s_, 205, 203, 205)
    whole_shift = 0
    whole_m = s[205]
    whole_shift = whole_shift + s[206]
    if whole_shift > 1 and whole_m:
        whole_m = 536870911 if whole_m > 0 else -536870911
    elif not whole_shift >> 30:
        whole_m = whole_m << whole_shift
    elif whole_shift > -30:
        whole_m = (1 << -1 - whole_shift) + whole_m >> 0 - whole_shift
    else:
        whole_m = 0
    whole_result = whole_m
    s[72] = whole_result
    real_copy_a = int(place(1, 1))
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 205] = s[real_copy_a + real_copy_words]
    put(-s[205], s[206], 205, s_)
    root_of(s_, 205, 205)
    multiply(s_, 205, 203, 205)
    s[75] = int(whole(0, 205, s_))
    put_m = c[10]
    put_e = c[11]
    if not put_m:
        s[203] = 0
        s[204] = -4096
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
        s[203] = put_m
        s[204] = put_e
    present(s_, 2, s_)
    multiply(s_, 205, 203, 205)
    whole_shift = 0
    whole_m = s[205]
    whole_shift = whole_shift + s[206]
    if whole_shift > 1 and whole_m:
        whole_m = 536870911 if whole_m > 0 else -536870911
    elif not whole_shift >> 30:
        whole_m = whole_m << whole_shift
    elif whole_shift > -30:
        whole_m = (1 << -1 - whole_shift) + whole_m >> 0 - whole_shift
    else:
        whole_m = 0
    whole_result = whole_m
    s[73] = whole_result
    real_copy_a = int(place(2, 2))
    real_copy_words = 2
    while real_copy_words > 0:
        real_copy_words = real_copy_words - 1
        s[real_copy_words + 205] = s[real_copy_a + real_copy_words]
    put(-s[205], s[206], 205, s_)
    root_of(s_, 205, 205)
    multiply(s_, 205, 203, 205)
    s[76] = int(whole(0, 205, s_))
