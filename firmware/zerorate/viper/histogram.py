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
def halve(s: ptr32, h: int, bins: int):
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
def share_evenly(s: ptr32, h: int, bins: int, j: int):
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
def share_by_mean(s: ptr32, h: int, bins: int, j: int):
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
def adapt(s_, c: ptr32, h: int, k: int) -> int:
    s = ptr32(s_)
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
            recentre_by = s[recentre_h + recentre_k + 1 + c[16]]
            recentre_h = recentre_h + recentre_k
            s_recentre_h = ptr32(int(s) + (recentre_h << 2))
            recentre_width = (s_recentre_h[1] >> 14) - (s_recentre_h[0] >> 14)
            recentre_k = s_recentre_h[0] & 16383
            if recentre_k < c[23] or recentre_width >= 4 * c[19]:
                recentre_result = 0
            else:
                recentre_by = recentre_by // recentre_k - (s_recentre_h[0] >> 14) - (recentre_width >> 1)
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
        s_emptiest_i = ptr32(int(s) + (emptiest_i << 2))
    pair = emptiest_found
    crowded_j = k
    crowded_p = pair
    s_crowded_p = ptr32(int(s) + (crowded_p << 2))
    while True:
        crowded_j = crowded_j + h
        crowded_p = crowded_p + h
        s_crowded_p = ptr32(int(s) + (crowded_p << 2))
        crowded_count = s[crowded_j] & 16383
        crowded_pair = (s_crowded_p[0] & 16383) + (s_crowded_p[1] & 16383)
        if not c[21]:
            if crowded_count < c[23]:
                crowded_result = 0
                break
            crowded_count = (crowded_count << 12) // ((s[crowded_j + 1] >> 14) - (s[crowded_j] >> 14))
            crowded_pair = (crowded_pair << 12) // ((s_crowded_p[2] >> 14) - (s_crowded_p[0] >> 14))
        if crowded_count > c[20] * crowded_pair:
            crowded_result = 1
            break
        crowded_result = 0
        break
    if not crowded_result:
        return 0
    merge_bins = c[16]
    merge_p = pair
    s[h + merge_p] += s[h + merge_p + 1] & 16383
    s[h + merge_bins + 1 + merge_p] += s[h + merge_bins + 2 + merge_p]
    merge_p = merge_p + 1
    while merge_p < merge_bins:
        s[h + merge_p] = s[h + merge_p + 1]
        if merge_p < merge_bins - 1:
            s[h + merge_bins + 1 + merge_p] = s[h + merge_bins + 2 + merge_p]
        merge_p = merge_p + 1
    if pair < k:
        k = k - 1
    open_gap_bins = c[16]
    open_gap_k = open_gap_bins
    while open_gap_k > k:
        s[h + open_gap_k] = s[h + open_gap_k - 1]
        if open_gap_k > k + 1:
            s[h + open_gap_bins + open_gap_k] = s[h + open_gap_bins + open_gap_k - 1]
        open_gap_k = open_gap_k - 1
    open_gap_width = (s[h + k + 2] >> 14) - (s[h + k] >> 14)
    s[h + k + 1] = (s[h + k] >> 14) + (open_gap_width >> 1) << 14
    if c[21]:
        share_evenly(s_, h, c[16], k)
    else:
        share_by_mean(s_, h, c[16], k)
        halve(s_, h, c[16])
    return 1
