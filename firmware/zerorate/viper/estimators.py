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
def protected(s: ptr32, c: ptr32, a: int, e: int) -> int:
    s_a = ptr32(int(s) + (a << 2))
    third_temp = s[e]
    third_span = s_a[4] - s_a[3] + 1
    third_part = (third_temp - s_a[3]) * 3 // third_span
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
            richest_third_temp = s[richest_e]
            richest_third_span = s_a[4] - s_a[3] + 1
            richest_third_part = (richest_third_temp - s_a[3]) * 3 // richest_third_span
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
def copy(s: ptr32, c: ptr32, to: int, e: int):
    i = 0
    while i < c[26]:
        s[to + i] = s[e + i]
        i = i + 1


@micropython.viper
def feed(s_, c_, a: int, e: int):
    s = ptr32(s_)
    c = ptr32(c_)
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
        adapt(s_, c_, histogram_add_h, histogram_add_k)
        histogram_add_result = 1
    if not histogram_add_result:
        return
    population_h = e + 4
    population_bins = c[16]
    population_count = 0
    while population_bins > 0:
        population_bins = population_bins - 1
        population_count = (s[population_h + population_bins] & 16383) + population_count
    k = population_count
    s_e[3] = k
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
    if k < s_a[1]:
        k = s_a[1]
    k = ((s[52] << 4) - s_e[1]) * s_a[1] // k
    s_e[1] = s_e[1] + k


@micropython.viper
def age(s: ptr32, c: ptr32, a: int):
    e = a + c[47]
    while e < a + c[15]:
        halve_h = e + 4
        halve_bins = c[16]
        halve_i = 0
        while halve_i < halve_bins:
            halve_count = s[halve_h + halve_i] & 16383
            if halve_count:
                halve_total = s[halve_h + halve_bins + 1 + halve_i]
                halve_rest = halve_total % halve_count
                halve_total = halve_total // halve_count * (halve_count >> 1) + (halve_count >> 1) * halve_rest // halve_count
                s[halve_h + halve_bins + 1 + halve_i] = halve_total
                halve_count = s[halve_h + halve_i] - (halve_count + 1 >> 1)
                s[halve_h + halve_i] = halve_count
            halve_i = halve_i + 1
        population_h = e + 4
        population_bins = c[16]
        population_count = 0
        while population_bins > 0:
            population_bins = population_bins - 1
            population_count = (s[population_h + population_bins] & 16383) + population_count
        population_result = population_count
        s[e + 3] = population_result
        e = e + c[26]


@micropython.viper
def learn_here(s_, c_, a: int):
    s = ptr32(s_)
    c = ptr32(c_)
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
        make_room_e = s[a + 5 + c[24]]
        s_make_room_e = ptr32(int(s) + (make_room_e << 2))
        if s_make_room_e[0] - -1048576 and s_make_room_e[3] >= c[29]:
            while True:
                make_room_victim_third_temp = s_make_room_e[0]
                make_room_victim_third_span = s_a[4] - s_a[3] + 1
                make_room_victim_third_part = (make_room_victim_third_temp - s_a[3]) * 3 // make_room_victim_third_span
                if make_room_victim_third_part >> 30:
                    make_room_victim_third_result = 0
                elif make_room_victim_third_part > 2:
                    make_room_victim_third_result = 2
                else:
                    make_room_victim_third_result = make_room_victim_third_part
                s[7] = make_room_victim_third_result
                make_room_victim_d = a + c[47]
                make_room_victim_left = 0
                while make_room_victim_d < a + c[15]:
                    if not s[make_room_victim_d] - -1048576:
                        make_room_k = make_room_victim_d
                        make_room_victim_left = 1
                        break
                    make_room_victim_d = make_room_victim_d + c[26]
                if make_room_victim_left:
                    break
                if c[21]:
                    make_room_victim_poorest_found = make_room_e
                    make_room_victim_poorest_d = a + c[47]
                    while make_room_victim_poorest_d < a + c[15]:
                        if s[make_room_victim_poorest_d + 3] < s[make_room_victim_poorest_found + 3]:
                            if not int(protected(s_, c_, a, make_room_victim_poorest_d)):
                                make_room_victim_poorest_found = make_room_victim_poorest_d
                        make_room_victim_poorest_d = make_room_victim_poorest_d + c[26]
                    make_room_k = make_room_victim_poorest_found
                    break
                make_room_victim_most_crowded_found = make_room_e
                make_room_victim_most_crowded_distance_nearest = 1048575
                make_room_victim_most_crowded_distance_d = a + c[47]
                while make_room_victim_most_crowded_distance_d < a + c[15]:
                    make_room_victim_most_crowded_distance_gap = s[make_room_victim_most_crowded_distance_d] - s_make_room_e[0]
                    if make_room_victim_most_crowded_distance_gap >> 30:
                        make_room_victim_most_crowded_distance_gap = -make_room_victim_most_crowded_distance_gap
                    if make_room_victim_most_crowded_distance_d - make_room_e and make_room_victim_most_crowded_distance_gap < make_room_victim_most_crowded_distance_nearest:
                        make_room_victim_most_crowded_distance_nearest = make_room_victim_most_crowded_distance_gap
                    make_room_victim_most_crowded_distance_d = make_room_victim_most_crowded_distance_d + c[26]
                make_room_victim_most_crowded_distance_result = make_room_victim_most_crowded_distance_nearest
                s[80] = make_room_victim_most_crowded_distance_result
                make_room_victim_most_crowded_d = a + c[47]
                s_make_room_victim_most_crowded_d = ptr32(int(s) + (make_room_victim_most_crowded_d << 2))
                while make_room_victim_most_crowded_d < a + c[15]:
                    make_room_victim_most_crowded_distance_nearest = 1048575
                    make_room_victim_most_crowded_distance_d = a + c[47]
                    while make_room_victim_most_crowded_distance_d < a + c[15]:
                        make_room_victim_most_crowded_distance_gap = s[make_room_victim_most_crowded_distance_d] - s_make_room_victim_most_crowded_d[0]
                        if make_room_victim_most_crowded_distance_gap >> 30:
                            make_room_victim_most_crowded_distance_gap = -make_room_victim_most_crowded_distance_gap
                        if make_room_victim_most_crowded_distance_d - make_room_victim_most_crowded_d and make_room_victim_most_crowded_distance_gap < make_room_victim_most_crowded_distance_nearest:
                            make_room_victim_most_crowded_distance_nearest = make_room_victim_most_crowded_distance_gap
                        make_room_victim_most_crowded_distance_d = make_room_victim_most_crowded_distance_d + c[26]
                    make_room_victim_most_crowded_distance_result = make_room_victim_most_crowded_distance_nearest
                    if make_room_victim_most_crowded_distance_result < s[80]:
                        make_room_victim_most_crowded_outermost_colder = 1
                        make_room_victim_most_crowded_outermost_hotter = 1
                        make_room_victim_most_crowded_outermost_d = a + c[47]
                        while make_room_victim_most_crowded_outermost_d < a + c[15]:
                            if s[make_room_victim_most_crowded_outermost_d] - -1048576 and s[make_room_victim_most_crowded_outermost_d] < s_make_room_victim_most_crowded_d[0]:
                                make_room_victim_most_crowded_outermost_colder = 0
                            if s[make_room_victim_most_crowded_outermost_d] > s_make_room_victim_most_crowded_d[0]:
                                make_room_victim_most_crowded_outermost_hotter = 0
                            make_room_victim_most_crowded_outermost_d = make_room_victim_most_crowded_outermost_d + c[26]
                        make_room_victim_most_crowded_outermost_result = make_room_victim_most_crowded_outermost_colder | make_room_victim_most_crowded_outermost_hotter
                        if not make_room_victim_most_crowded_outermost_result:
                            if not int(protected(s_, c_, a, make_room_victim_most_crowded_d)):
                                make_room_victim_most_crowded_distance_nearest = 1048575
                                make_room_victim_most_crowded_distance_d = a + c[47]
                                while make_room_victim_most_crowded_distance_d < a + c[15]:
                                    make_room_victim_most_crowded_distance_gap = s[make_room_victim_most_crowded_distance_d] - s_make_room_victim_most_crowded_d[0]
                                    if make_room_victim_most_crowded_distance_gap >> 30:
                                        make_room_victim_most_crowded_distance_gap = -make_room_victim_most_crowded_distance_gap
                                    if make_room_victim_most_crowded_distance_d - make_room_victim_most_crowded_d and make_room_victim_most_crowded_distance_gap < make_room_victim_most_crowded_distance_nearest:
                                        make_room_victim_most_crowded_distance_nearest = make_room_victim_most_crowded_distance_gap
                                    make_room_victim_most_crowded_distance_d = make_room_victim_most_crowded_distance_d + c[26]
                                make_room_victim_most_crowded_distance_result = make_room_victim_most_crowded_distance_nearest
                                s[80] = make_room_victim_most_crowded_distance_result
                                make_room_victim_most_crowded_found = make_room_victim_most_crowded_d
                    make_room_victim_most_crowded_d = make_room_victim_most_crowded_d + c[26]
                    s_make_room_victim_most_crowded_d = ptr32(int(s) + (make_room_victim_most_crowded_d << 2))
                make_room_k = make_room_victim_most_crowded_found
                break
            if make_room_k - make_room_e:
                make_room_estimators_copy_i = 0
                while make_room_estimators_copy_i < c[26]:
                    s[make_room_k + make_room_estimators_copy_i] = s[make_room_e + make_room_estimators_copy_i]
                    make_room_estimators_copy_i = make_room_estimators_copy_i + 1
        s_make_room_e[0] = ((c[27] >> 1) + temp) // c[27] * c[27]
        s_make_room_e[1] = temp << 4
        s_make_room_e[3] = 0
        e = make_room_e
    if e < a + c[47]:
        touch_k = a + 6
        s_touch_k = ptr32(int(s) + (touch_k << 2))
        touch_held = e
        while s_touch_k[0] - e:
            touch_d = s_touch_k[0]
            s_touch_k[0] = touch_held
            touch_held = touch_d
            touch_k = touch_k + 1
            s_touch_k = ptr32(int(s) + (touch_k << 2))
        s_touch_k[0] = touch_held
    s_a[2] = e
    feed(s_, c_, a, e)
    s_a[5] = s_a[5] + s_a[1]
    if s_a[5] >= c[30]:
        s_a[5] = 0
        age(s_, c_, a)
