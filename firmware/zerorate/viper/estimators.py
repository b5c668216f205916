# Generated from zerorate/estimators.py by `make viper`: edit that file, not this one.
"""The estimators of one axis: any temperature, short term and long term."""

import micropython

from .histogram import adapt


@micropython.viper
def reset(s: ptr32, c: ptr32, a: int):
    s_a = ptr32(int(s) + (a << 2))
    s_a[2] = 0
    s_a[3] = 32767
    s_a[4] = -32768
    s_a[5] = 0
    i = 0
    e = a + 32
    s_e = ptr32(int(s) + (e << 2))
    while e < a + c[15]:
        s_e[0] = -1048576
        s_e[1] = 0
        s_e[2] = 0
        s_e[3] = 0
        histogram_clear_h = e + 4
        histogram_clear_i = 0
        if c[46]:
            pass
        while histogram_clear_i <= c[16]:
            s[histogram_clear_h + histogram_clear_i] = histogram_clear_i * c[18] + c[17] << 14
            histogram_clear_i = histogram_clear_i + 1
        while histogram_clear_i <= c[16] + c[16]:
            s[histogram_clear_h + histogram_clear_i] = 0
            histogram_clear_i = histogram_clear_i + 1
        if i > 0 and i <= c[24]:
            s[a + 6 + i - 1] = e
        e = e + c[26]
        s_e = ptr32(int(s) + (e << 2))
        i = i + 1


@micropython.viper
def protected(c: ptr32, s: ptr32, a: int, e: int) -> int:
    s_a = ptr32(int(s) + (a << 2))
    third_span = s_a[4] - s_a[3] + 1
    third_part = (s[e] - s_a[3]) * 3 // third_span
    if third_part >> 30:
        part = 0
    elif third_part > 2:
        part = 2
    else:
        part = third_part
    if not part - s[7]:
        return 0
    richest_best = 0
    richest_e = a + c[47]
    while richest_e < a + c[15]:
        if s[richest_e] - -1048576:
            richest_third_span = s_a[4] - s_a[3] + 1
            richest_third_part = (s[richest_e] - s_a[3]) * 3 // richest_third_span
            if richest_third_part >> 30:
                richest_third_result = 0
            elif richest_third_part > 2:
                richest_third_result = 2
            else:
                richest_third_result = richest_third_part
            if not richest_third_result - part:
                if not richest_best or s[richest_e + 3] > s[richest_best + 3]:
                    richest_best = richest_e
        richest_e = richest_e + c[26]
    richest_result = richest_best
    if not richest_result - e:
        return 1
    return 0


@micropython.viper
def most_crowded(distance_d: int, distance_gap: int, c: ptr32, s: ptr32, a: int, e: int, s_, c_) -> int:
    found = e
    distance_nearest = 1048575
    distance_d = a + c[47]
    while distance_d < a + c[15]:
        distance_gap = s[distance_d] - s[e]
        if distance_gap >> 30:
            distance_gap = -distance_gap
        if distance_d - e and distance_gap < distance_nearest:
            distance_nearest = distance_gap
        distance_d = distance_d + c[26]
    distance_result = distance_nearest
    s[80] = distance_result
    d = a + c[47]
    s_d = ptr32(int(s) + (d << 2))
    while d < a + c[15]:
        distance_nearest = 1048575
        distance_d = a + c[47]
        while distance_d < a + c[15]:
            distance_gap = s[distance_d] - s_d[0]
            if distance_gap >> 30:
                distance_gap = -distance_gap
            if distance_d - d and distance_gap < distance_nearest:
                distance_nearest = distance_gap
            distance_d = distance_d + c[26]
        distance_result = distance_nearest
        if distance_result < s[80]:
            outermost_colder = 1
            outermost_hotter = 1
            outermost_d = a + c[47]
            while outermost_d < a + c[15]:
                if s[outermost_d] - -1048576 and s[outermost_d] < s_d[0]:
                    outermost_colder = 0
                if s[outermost_d] > s_d[0]:
                    outermost_hotter = 0
                outermost_d = outermost_d + c[26]
            outermost_result = outermost_colder | outermost_hotter
            if not outermost_result:
                if not int(protected(c_, s_, a, d)):
                    distance_nearest = 1048575
                    distance_d = a + c[47]
                    while distance_d < a + c[15]:
                        distance_gap = s[distance_d] - s_d[0]
                        if distance_gap >> 30:
                            distance_gap = -distance_gap
                        if distance_d - d and distance_gap < distance_nearest:
                            distance_nearest = distance_gap
                        distance_d = distance_d + c[26]
                    distance_result = distance_nearest
                    s[80] = distance_result
                    found = d
        d = d + c[26]
        s_d = ptr32(int(s) + (d << 2))
    return found


@micropython.viper
def copy(s: ptr32, c: ptr32, to: int, e: int):
    i = 0
    while i < c[26]:
        s[to + i] = s[e + i]
        i = i + 1


@micropython.viper
def make_room(victim_d: int, c: ptr32, victim_poorest_d: int, a: int, s: ptr32, temp: int, s_, c_) -> int:
    s_a = ptr32(int(s) + (a << 2))
    e = s[a + 5 + c[24]]
    s_e = ptr32(int(s) + (e << 2))
    if s_e[0] - -1048576 and s_e[3] >= c[29]:
        while True:
            victim_third_span = s_a[4] - s_a[3] + 1
            victim_third_part = (s_e[0] - s_a[3]) * 3 // victim_third_span
            if victim_third_part >> 30:
                victim_third_result = 0
            elif victim_third_part > 2:
                victim_third_result = 2
            else:
                victim_third_result = victim_third_part
            s[7] = victim_third_result
            victim_d = a + c[47]
            victim_left = 0
            while victim_d < a + c[15]:
                if not s[victim_d] - -1048576:
                    k = victim_d
                    victim_left = 1
                    break
                victim_d = victim_d + c[26]
            if victim_left:
                break
            if c[21]:
                victim_poorest_found = e
                victim_poorest_d = a + c[47]
                while victim_poorest_d < a + c[15]:
                    if s[victim_poorest_d + 3] < s[victim_poorest_found + 3]:
                        if not int(protected(c_, s_, a, victim_poorest_d)):
                            victim_poorest_found = victim_poorest_d
                    victim_poorest_d = victim_poorest_d + c[26]
                k = victim_poorest_found
                break
            k = int(most_crowded(0, 0, c_, s_, a, e, s_, c_))
            break
        if k - e:
            estimators_copy_i = 0
            while estimators_copy_i < c[26]:
                s[k + estimators_copy_i] = s[e + estimators_copy_i]
                estimators_copy_i = estimators_copy_i + 1
    s_e[0] = ((c[27] >> 1) + temp) // c[27] * c[27]
    s_e[1] = temp << 4
    s_e[3] = 0
    return e


@micropython.viper
def feed(histogram_add_histogram_place_k: int, histogram_add_halve_i: int, s: ptr32, c: ptr32, e: int, a: int, s_, c_):
    s_a = ptr32(int(s) + (a << 2))
    s_e = ptr32(int(s) + (e << 2))
    if not s_e[3]:
        k = s_a[0] // s_a[1]
        histogram_clear_h = e + 4
        histogram_clear_middle = k
        histogram_clear_i = 0
        if c[46]:
            histogram_clear_middle = 0
        while histogram_clear_i <= c[16]:
            s[histogram_clear_h + histogram_clear_i] = histogram_clear_middle + c[17] + histogram_clear_i * c[18] << 14
            histogram_clear_i = histogram_clear_i + 1
        while histogram_clear_i <= c[16] + c[16]:
            s[histogram_clear_h + histogram_clear_i] = 0
            histogram_clear_i = histogram_clear_i + 1
        s_e[1] = s[52] << 4
    histogram_add_h = e + 4
    s_histogram_add_h = ptr32(int(s) + (histogram_add_h << 2))
    histogram_add_k = s_a[0] // s_a[1]
    while True:
        histogram_add_histogram_place_k = c[16]
        if histogram_add_k < s_histogram_add_h[0] >> 14:
            if c[22]:
                histogram_add_k = -1
                break
            s_histogram_add_h[0] = (histogram_add_k << 14) + (s_histogram_add_h[0] & 16383)
        elif histogram_add_k >= s[histogram_add_h + histogram_add_histogram_place_k] >> 14:
            if c[22]:
                histogram_add_k = -1
                break
            s[histogram_add_h + histogram_add_histogram_place_k] = histogram_add_k + 1 << 14
        histogram_add_histogram_place_k = histogram_add_histogram_place_k - 1
        while histogram_add_k < s[histogram_add_h + histogram_add_histogram_place_k] >> 14:
            histogram_add_histogram_place_k = histogram_add_histogram_place_k - 1
        histogram_add_k = histogram_add_histogram_place_k
        break
    if histogram_add_k >> 30:
        histogram_add_result = 0
    else:
        while (s[histogram_add_h + histogram_add_k] & 16383) + s_a[1] > 16383:
            histogram_add_halve_bins = c[16]
            histogram_add_halve_i = 0
            while histogram_add_halve_i < histogram_add_halve_bins:
                histogram_add_halve_count = s[histogram_add_h + histogram_add_halve_i] & 16383
                if histogram_add_halve_count:
                    histogram_add_halve_total = s[histogram_add_h + histogram_add_halve_bins + 1 + histogram_add_halve_i]
                    histogram_add_halve_rest = histogram_add_halve_total % histogram_add_halve_count
                    histogram_add_halve_total = histogram_add_halve_total // histogram_add_halve_count * (histogram_add_halve_count >> 1) + (histogram_add_halve_count >> 1) * histogram_add_halve_rest // histogram_add_halve_count
                    s[histogram_add_h + histogram_add_halve_bins + 1 + histogram_add_halve_i] = histogram_add_halve_total
                    histogram_add_halve_count = s[histogram_add_h + histogram_add_halve_i] - (histogram_add_halve_count + 1 >> 1)
                    s[histogram_add_h + histogram_add_halve_i] = histogram_add_halve_count
                histogram_add_halve_i = histogram_add_halve_i + 1
        s[histogram_add_h + histogram_add_k] += s_a[1]
        s[histogram_add_h + histogram_add_k + 1 + c[16]] += s_a[0]
        adapt(histogram_add_h, s_, c_, histogram_add_k, s_, c_)
        histogram_add_result = 1
    if not histogram_add_result:
        return
    if s_e[3] < 33554431:
        s_e[3] = s_e[3] + s_a[1]
    read_out_q8_h = e + 4
    read_out_q8_bins = c[16]
    read_out_q8_most_significant_best = read_out_q8_h
    read_out_q8_most_significant_i = read_out_q8_h + 1
    while read_out_q8_most_significant_i < read_out_q8_h + read_out_q8_bins:
        read_out_q8_most_significant_mine = (s[read_out_q8_most_significant_i] & 16383) * ((s[read_out_q8_most_significant_best + 1] >> 14) - (s[read_out_q8_most_significant_best] >> 14))
        if read_out_q8_most_significant_mine > (s[read_out_q8_most_significant_best] & 16383) * ((s[read_out_q8_most_significant_i + 1] >> 14) - (s[read_out_q8_most_significant_i] >> 14)):
            read_out_q8_most_significant_best = read_out_q8_most_significant_i
        read_out_q8_most_significant_i = read_out_q8_most_significant_i + 1
    read_out_q8_k = read_out_q8_most_significant_best - read_out_q8_h
    read_out_q8_count = s[read_out_q8_h + read_out_q8_k] & 16383
    if not read_out_q8_count:
        read_out_q8_result = 0
    else:
        read_out_q8_total = s[read_out_q8_h + read_out_q8_bins + 1 + read_out_q8_k]
        read_out_q8_result = (read_out_q8_total // read_out_q8_count << 8) + (read_out_q8_total % read_out_q8_count << 8) // read_out_q8_count
    s_e[2] = read_out_q8_result
    population_h = e + 4
    population_bins = c[16]
    population_count = 0
    while population_bins > 0:
        population_bins = population_bins - 1
        population_count = (s[population_h + population_bins] & 16383) + population_count
    k = population_count
    if k < s_a[1]:
        k = s_a[1]
    k = ((s[52] << 4) - s_e[1]) * s_a[1] // k
    s_e[1] = s_e[1] + k


@micropython.viper
def learn_here(find_e: int, age_halve_i: int, age_halve_count: int, s: ptr32, c: ptr32, a: int, s_, c_):
    s_a = ptr32(int(s) + (a << 2))
    temp = s[52]
    while True:
        find_half = c[27] >> 1
        find_e = s_a[2]
        if find_e > 0:
            find_d = temp - s[find_e]
            if find_d <= find_half + c[28] and find_d >= 0 - find_half - c[28]:
                e = find_e
                break
        find_e = a + c[14]
        find_left = 0
        while find_e < a + c[15]:
            find_d = temp - s[find_e]
            if find_d < find_half and find_d >= 0 - find_half:
                e = find_e
                find_left = 1
                break
            find_e = find_e + c[26]
        if find_left:
            break
        e = 0
        break
    if not e:
        e = int(make_room(0, c_, 0, a, s_, temp, s_, c_))
    if e < a + c[47]:
        touch_k = a + 6
        s_touch_k = ptr32(int(s) + (touch_k << 2))
        touch_held = e
        while s_touch_k[0] - e:
            touch_d = s_touch_k[0]
            s_touch_k[0] = touch_held
            touch_held = touch_d
            touch_k = touch_k + 1
            s_touch_k = ptr32(int(s_touch_k) + 4)
        s_touch_k[0] = touch_held
    s_a[2] = e
    feed(0, 0, s_, c_, e, a, s_, c_)
    s_a[5] = s_a[5] + s_a[1]
    if s_a[5] >= c[30]:
        s_a[5] = 0
        age_e = a + c[47]
        while age_e < a + c[15]:
            age_halve_h = age_e + 4
            age_halve_bins = c[16]
            age_halve_i = 0
            while age_halve_i < age_halve_bins:
                age_halve_count = s[age_halve_h + age_halve_i] & 16383
                if age_halve_count:
                    age_halve_total = s[age_halve_h + age_halve_bins + 1 + age_halve_i]
                    age_halve_rest = age_halve_total % age_halve_count
                    age_halve_total = age_halve_total // age_halve_count * (age_halve_count >> 1) + (age_halve_count >> 1) * age_halve_rest // age_halve_count
                    s[age_halve_h + age_halve_bins + 1 + age_halve_i] = age_halve_total
                    age_halve_count = s[age_halve_h + age_halve_i] - (age_halve_count + 1 >> 1)
                    s[age_halve_h + age_halve_i] = age_halve_count
                age_halve_i = age_halve_i + 1
            s[age_e + 3] = s[age_e + 3] >> 1
            age_e = age_e + c[26]
