# Generated from zerorate/histogram.py by `make viper`: edit that file, not this one.
"""The adaptive histogram: few bins that crowd where the readings do."""

import micropython


@micropython.viper
def clear(s: ptr32, c: ptr32, h: int, middle: int):
    i = 0
    if c[46]:
        middle = 0
    while i <= c[16]:
        s[h + i] = middle + c[17] + i * c[18] << 14
        i = i + 1
    while i <= c[16] + c[16]:
        s[h + i] = 0
        i = i + 1


@micropython.viper
def halve(h: int, s: ptr32, bins: int):
    i = 0
    while i < bins:
        count = s[h + i] & 16383
        if count:
            total = s[h + bins + 1 + i]
            rest = total % count
            total = total // count * (count >> 1) + (count >> 1) * rest // count
            s[h + bins + 1 + i] = total
            count = s[h + i] - (count + 1 >> 1)
            s[h + i] = count
        i = i + 1


@micropython.viper
def merge(halve_i: int, halve_count: int, h: int, s: ptr32, bins: int, p: int):
    while (s[h + p] & 16383) + (s[h + p + 1] & 16383) > 16383:
        halve_i = 0
        while halve_i < bins:
            halve_count = s[h + halve_i] & 16383
            if halve_count:
                halve_total = s[h + bins + 1 + halve_i]
                halve_rest = halve_total % halve_count
                halve_total = halve_total // halve_count * (halve_count >> 1) + (halve_count >> 1) * halve_rest // halve_count
                s[h + bins + 1 + halve_i] = halve_total
                halve_count = s[h + halve_i] - (halve_count + 1 >> 1)
                s[h + halve_i] = halve_count
            halve_i = halve_i + 1
    s[h + p] += s[h + p + 1] & 16383
    s[h + bins + 1 + p] += s[h + bins + 2 + p]
    p = p + 1
    while p < bins:
        s[h + p] = s[h + p + 1]
        if p < bins - 1:
            s[h + bins + 1 + p] = s[h + bins + 2 + p]
        p = p + 1


@micropython.viper
def open_gap(h: int, s: ptr32, j: int, bins: int):
    k = bins
    while k > j:
        s[h + k] = s[h + k - 1]
        if k > j + 1:
            s[h + bins + k] = s[h + bins + k - 1]
        k = k - 1
    width = (s[h + j + 2] >> 14) - (s[h + j] >> 14)
    s[h + j + 1] = (s[h + j] >> 14) + (width >> 1) << 14


@micropython.viper
def share_evenly(h: int, j: int, s: ptr32, bins: int):
    count = s[h + j] & 16383
    total = s[h + bins + 1 + j]
    upper = count >> 1
    s[h + j] -= upper
    s[h + j + 1] += upper
    if count:
        upper = total // count * upper + total % count * upper // count
    s[h + bins + 2 + j] = upper
    s[h + bins + 1 + j] = total - upper


@micropython.viper
def share_by_mean(h: int, j: int, s: ptr32, bins: int):
    count = s[h + j] & 16383
    total = s[h + bins + 1 + j]
    if total >= (s[h + j + 1] >> 14) * count:
        s[h + j] -= count
        s[h + j + 1] += count
        s[h + bins + 1 + j] = 0
        s[h + bins + 2 + j] = total
    else:
        s[h + bins + 2 + j] = 0


@micropython.viper
def crowded(j: int, p: int, s: ptr32, h: int, c: ptr32) -> int:
    s_p = ptr32(int(s) + (p << 2))
    j = j + h
    p = p + h
    s_p = ptr32(int(s) + (p << 2))
    count = s[j] & 16383
    pair = (s_p[0] & 16383) + (s_p[1] & 16383)
    if count < c[23]:
        return 0
    if not c[21]:
        count = (count << 12) // ((s[j + 1] >> 14) - (s[j] >> 14))
        pair = (pair << 12) // ((s_p[2] >> 14) - (s_p[0] >> 14))
    if count > c[20] * pair:
        return 1
    return 0


@micropython.viper
def adapt(h: int, s: ptr32, c: ptr32, k: int, s_, c_) -> int:
    if c[21]:
        fullest_bins = c[16]
        fullest_j = 0
        while fullest_bins > 0:
            fullest_bins = fullest_bins - 1
            if s[h + fullest_bins] & 16383 >= s[h + fullest_j] & 16383:
                fullest_j = fullest_bins
        k = fullest_j
    else:
        recentre_h = h
        s_recentre_h = ptr32(int(s) + (recentre_h << 2))
        recentre_k = k
        if not recentre_k or not recentre_k - (c[16] - 1):
            recentre_result = 0
        else:
            recentre_h = recentre_h + recentre_k
            s_recentre_h = ptr32(int(s) + (recentre_h << 2))
            recentre_width = (s_recentre_h[1] >> 14) - (s_recentre_h[0] >> 14)
            recentre_k = s_recentre_h[0] & 16383
            if recentre_k < c[23] or recentre_width >= 4 * c[19]:
                recentre_result = 0
            else:
                recentre_by = s[recentre_h + 1 + c[16]] // recentre_k - (s_recentre_h[0] >> 14) - (recentre_width >> 1)
                if recentre_width < 32:
                    recentre_width = 32
                if recentre_by < recentre_width >> 4 and recentre_by > -(recentre_width >> 4):
                    recentre_result = 0
                elif (s_recentre_h[0] >> 14) + recentre_by <= s[recentre_h - 1] >> 14 or (s_recentre_h[1] >> 14) + recentre_by >= s_recentre_h[2] >> 14:
                    recentre_result = 0
                else:
                    s_recentre_h[0] = (recentre_by << 14) + s_recentre_h[0]
                    s_recentre_h[1] = (recentre_by << 14) + s_recentre_h[1]
                    recentre_result = 1
        if recentre_result:
            halve_bins = c[16]
            halve_i = 0
            while halve_i < halve_bins:
                halve_count = s[h + halve_i] & 16383
                if halve_count:
                    halve_total = s[h + halve_bins + 1 + halve_i]
                    halve_rest = halve_total % halve_count
                    halve_total = halve_total // halve_count * (halve_count >> 1) + (halve_count >> 1) * halve_rest // halve_count
                    s[h + halve_bins + 1 + halve_i] = halve_total
                    halve_count = s[h + halve_i] - (halve_count + 1 >> 1)
                    s[h + halve_i] = halve_count
                halve_i = halve_i + 1
            return 1
    if (s[h + k + 1] >> 14) - (s[h + k] >> 14) < 2 * c[19]:
        return 0
    s[7] = 1073741823
    emptiest_found = 0
    emptiest_i = h
    s_emptiest_i = ptr32(int(s) + (emptiest_i << 2))
    while emptiest_i < h + c[16] - 1:
        if emptiest_i - (h + k) and emptiest_i + 1 - (h + k):
            emptiest_count = s_emptiest_i[0] & 16383
            emptiest_count = (s_emptiest_i[1] & 16383) + emptiest_count
            if not c[21]:
                emptiest_count = (emptiest_count << 12) // ((s_emptiest_i[2] >> 14) - (s_emptiest_i[0] >> 14))
            if emptiest_count < s[7]:
                s[7] = emptiest_count
                emptiest_found = emptiest_i - h
        emptiest_i = emptiest_i + 1
        s_emptiest_i = ptr32(int(s_emptiest_i) + 4)
    pair = emptiest_found
    if not int(crowded(k, pair, s_, h, c_)):
        return 0
    merge(0, 0, h, s_, c[16], pair)
    if pair < k:
        k = k - 1
    open_gap(h, s_, k, c[16])
    if c[21]:
        share_evenly(h, k, s_, c[16])
    else:
        share_by_mean(h, k, s_, c[16])
        halve(h, s_, c[16])
    return 1
