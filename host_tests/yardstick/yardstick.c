/* Generated from firmware/zerorate by `python -m zerorate_tools.bench.c_program FILE`: edit
   those, not this. A yardstick for the benchmark; no board runs it. */
#include <stdint.h>

static inline int32_t floor_div(int32_t a, int32_t b) {
    return a / b - (a % b != 0 && (a < 0) != (b < 0));
}
static inline int32_t floor_mod(int32_t a, int32_t b) {
    int32_t rest = a % b;
    return rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest;
}
static inline int32_t shift_left(int32_t a, int32_t by) {
    return (int32_t)((uint32_t)a << by);
}

static int32_t guard_exchange(int32_t *s, int32_t *x) {
    int32_t i = 0;
    int32_t same = 0;
    i = 0;
    same = 1;
    while (i < 7) {
        if (x[i] != s[(0 + i)]) {
            same = 0;
        }
        s[(0 + i)] = x[i];
        i = (i + 1);
    }
    return same;
}

static int32_t guard_all_alike(int32_t *x) {
    int32_t i = 0;
    i = 1;
    while (i < 7) {
        if (x[i] != x[0]) {
            return 0;
        }
        i = (i + 1);
    }
    return 1;
}

static int32_t guard_at_rail(int32_t *x) {
    int32_t i = 0;
    i = 4;
    while (i < 7) {
        if ((x[i] > 32766) || (x[i] < (-32767))) {
            return 1;
        }
        i = (i + 1);
    }
    return 0;
}

static int32_t guard_check(int32_t *s, int32_t *c, int32_t *x, int32_t dt_us) {
    int32_t kind = 0;
    int32_t repeats = 0;
    int32_t step = 0;
    step = (x[3] - s[(0 + 3)]);
    repeats = guard_exchange(s, x);
    kind = 0;
    if (((x[0] == 0) || (x[0] == (-1))) && guard_all_alike(x)) {
        kind = (3 - x[0]);
    } else {
        if (s[8] == 0) {
            kind = 0;
        } else {
            if (dt_us <= 0) {
                kind = 6;
            } else {
                if (dt_us > c[1]) {
                    kind = 7;
                } else {
                    if (repeats) {
                        kind = 1;
                    } else {
                        if ((step >= c[2]) || (step <= (-c[2]))) {
                            kind = 5;
                        }
                    }
                }
            }
        }
    }
    if ((kind == 0) && guard_at_rail(x)) {
        kind = 2;
    }
    s[(8 + kind)] = ((s[(8 + kind)] + 1) & 536870911);
    if (kind > 1) {
        s[17] = 0;
        s[18] = 0;
        s[34] = 0;
    } else {
        if ((dt_us > 0) && (dt_us <= c[1])) {
            dt_us = (dt_us + s[16]);
            s[16] = ((dt_us < 536870911) ? dt_us : 536870911);
        }
    }
    return kind;
}

static int32_t step_examine(int32_t *s, int32_t *c, int32_t *x, int32_t dt_us) {
    return guard_check(s, c, x, dt_us);
}

static int32_t stillness_gather(int32_t *s, int32_t *c, int32_t *x) {
    int32_t d = 0;
    int32_t e = 0;
    int32_t i = 0;
    i = 0;
    if (s[17] == 0) {
        while (i < 7) {
            s[(19 + i)] = x[i];
            s[(26 + i)] = 0;
            i = (i + 1);
        }
        s[33] = 0;
        s[35] = 0;
        s[76] = 0;
        s[77] = 0;
        s[(77 + 1)] = 0;
        s[(77 + 2)] = 0;
        s[64] = 0;
        s[(64 + 1)] = 0;
        s[(64 + 2)] = 0;
        s[18] = 0;
    }
    s[17] = (s[17] + 1);
    if (s[18] == 0) {
        i = 0;
        while (i < 7) {
            d = (x[i] - s[(19 + i)]);
            if (((d + 512) >> 10)) {
                s[18] = (i + 1);
                d = 0;
            }
            s[(26 + i)] = (s[(26 + i)] + d);
            if (i < 3) {
                s[33] = (s[33] + (d * d));
            } else {
                if (i > 3) {
                    s[35] = (s[35] + (d * d));
                    e = (d - s[((77 - 4) + i)]);
                    s[76] = (s[76] + (e * e));
                    s[((77 - 4) + i)] = d;
                    e = s[((61 - 4) + i)];
                    s[((64 - 4) + i)] = (s[((64 - 4) + i)] + e);
                }
            }
            i = (i + 1);
        }
    } else {
        d = (x[3] - s[(19 + 3)]);
        s[(26 + 3)] = (s[(26 + 3)] + d);
    }
    if (s[17] < c[3]) {
        return 0;
    }
    return 1;
}

static int32_t step_stale(int32_t *s, int32_t *c, int32_t a) {
    int32_t d = 0;
    d = (s[47] - s[(a + 31)]);
    if (s[(a + 1)] || c[46] || (d > c[43]) || (d < (-c[43]))) {
        s[(a + 31)] = s[47];
        return 1;
    }
    return 0;
}

static int32_t recent_beyond_q8(int32_t *s, int32_t *c, int32_t a) {
    int32_t d = 0;
    int32_t sigma = 0;
    d = (shift_left(s[47], 4) - s[(a + 20)]);
    if (d < 0) {
        d = (s[(a + 19)] - shift_left(s[47], 4));
    }
    if ((d < 0) || (s[(a + 22)] == 0)) {
        return 0;
    }
    if (d > 262143) {
        d = 262143;
    }
    sigma = ((d * c[50]) >> 16);
    if (sigma > 16383) {
        sigma = 16383;
    }
    return (sigma * sigma);
}

static int32_t recent_grown_q8(int32_t *s, int32_t a) {
    int32_t seconds = 0;
    seconds = (s[(a + 28)] >> 10);
    if (seconds > 2047) {
        seconds = 2047;
    }
    return (s[(a + 25)] + (((s[(a + 26)] >> 4) * seconds) >> 4));
}

static int32_t fixed_root(int32_t square) {
    int32_t bit = 0;
    int32_t found = 0;
    int32_t more = 0;
    bit = shift_left(1, 14);
    if (square < 16777216) {
        bit = shift_left(1, 11);
    }
    found = 0;
    while (bit) {
        more = (found + bit);
        if ((more * more) <= square) {
            found = more;
        }
        bit = (bit >> 1);
    }
    return found;
}

static int32_t step_sigma_q8(int32_t *s, int32_t *c, int32_t a) {
    int32_t variance = 0;
    variance = (recent_grown_q8(s, a) + shift_left(c[37], 1));
    variance = (variance + recent_beyond_q8(s, c, a));
    if (variance < 4194303) {
        return fixed_root(shift_left(variance, 8));
    }
    return shift_left(fixed_root(variance), 4);
}

static int32_t estimators_find(int32_t *s, int32_t *c, int32_t a, int32_t temp) {
    int32_t d = 0;
    int32_t e = 0;
    int32_t half = 0;
    half = (c[27] >> 1);
    e = s[(a + 2)];
    if (e > 0) {
        d = (temp - s[(e + 0)]);
        if ((d <= (half + c[28])) && (d >= ((0 - half) - c[28]))) {
            return e;
        }
    }
    e = (a + c[14]);
    while (e < (a + c[15])) {
        d = (temp - s[(e + 0)]);
        if ((d < half) && (d >= (0 - half))) {
            return e;
        }
        e = (e + c[26]);
    }
    return 0;
}

static int32_t bias_choose(int32_t *s, int32_t *c, int32_t a, int32_t temp) {
    int32_t e = 0;
    s[(a + 29)] = 0;
    e = estimators_find(s, c, a, temp);
    if (e > 0) {
        e = s[(e + 3)];
        if ((e >= c[34]) && (e >= ((s[(a + 21)] >> 8) * c[35]))) {
            return 3;
        }
    }
    if (s[(a + 22)]) {
        e = (shift_left(temp, 4) + c[36]);
        if (e < s[(a + 19)]) {
            s[(a + 29)] = 1;
        }
        e = (shift_left(temp, 4) - c[36]);
        if (e > s[(a + 20)]) {
            s[(a + 29)] = 1;
        }
        return 2;
    }
    e = s[((a + 32) + 3)];
    if ((e >= c[31]) || ((e > 0) && (c[46] == 0))) {
        return 1;
    }
    return 0;
}

static int32_t fixed_scaled(int32_t a, int32_t b, int32_t shift) {
    int32_t high = 0;
    int32_t middle = 0;
    high = (b >> 15);
    b = (b & 32767);
    middle = ((((a >> 15) * b) + ((a & 32767) * high)) + (((a & 32767) * b) >> 15));
    high = ((a >> 15) * high);
    return (shift_left(high, (30 - shift)) + (middle >> (shift - 15)));
}

static int32_t fit_line_q8(int32_t *s, int32_t a, int32_t temp_q4) {
    int32_t most = 0;
    int32_t u = 0;
    u = (temp_q4 - s[(a + 14)]);
    most = (134217727 >> s[(a + 18)]);
    if (u > most) {
        u = most;
    }
    if (u < (0 - most)) {
        u = (0 - most);
    }
    u = (shift_left(u, s[(a + 18)]) - s[(a + 15)]);
    u = fixed_scaled(s[(a + 17)], u, 26);
    return (((s[(a + 16)] + u) + 4) >> 3);
}

static int32_t bias_curve_q8(int32_t *s, int32_t *c, int32_t a, int32_t temp) {
    int32_t kind = 0;
    kind = bias_choose(s, c, a, temp);
    if ((kind == 3) && (c[21] == 0) && s[(a + 22)]) {
        kind = 2;
    }
    s[(a + 30)] = kind;
    if (kind == 0) {
        return 0;
    }
    if (kind == 3) {
        kind = estimators_find(s, c, a, temp);
        return s[(kind + 2)];
    }
    if (kind == 1) {
        return s[((a + 32) + 2)];
    }
    return fit_line_q8(s, a, shift_left(temp, 4));
}

static void step_publish(int32_t *s, int32_t *c, int32_t a, int32_t axis) {
    int32_t bias = 0;
    bias = (bias_curve_q8(s, c, a, s[47]) + s[(a + 24)]);
    if (s[(a + 30)] == 0) {
        return;
    }
    s[(67 + axis)] = bias;
    if (s[(73 + axis)] == 0) {
        s[(55 + axis)] = bias;
    }
    s[(73 + axis)] = (s[(a + 13)] ? s[(a + 13)] : s[(a + 30)]);
    s[(70 + axis)] = step_sigma_q8(s, c, a);
}

static int32_t histogram_most_significant(int32_t *s, int32_t h, int32_t bins) {
    int32_t best = 0;
    int32_t i = 0;
    int32_t mine = 0;
    best = h;
    i = (h + 1);
    while (i < (h + bins)) {
        mine = ((s[i] & 16383) * ((s[(best + 1)] >> 14) - (s[best] >> 14)));
        if (mine > ((s[best] & 16383) * ((s[(i + 1)] >> 14) - (s[i] >> 14)))) {
            best = i;
        }
        i = (i + 1);
    }
    return (best - h);
}

static int32_t histogram_read_out_q8(int32_t *s, int32_t h, int32_t bins) {
    int32_t count = 0;
    int32_t k = 0;
    int32_t total = 0;
    k = histogram_most_significant(s, h, bins);
    count = (s[(h + k)] & 16383);
    if (count == 0) {
        return 0;
    }
    total = s[(((h + bins) + 1) + k)];
    return (shift_left(floor_div(total, count), 8) + floor_div(shift_left(floor_mod(total, count), 8), count));
}

static int32_t histogram_population(int32_t *s, int32_t h, int32_t bins) {
    int32_t count = 0;
    count = 0;
    while (bins > 0) {
        bins = (bins - 1);
        count = (count + (s[(h + bins)] & 16383));
    }
    return count;
}

static void histogram_clear(int32_t *s, int32_t *c, int32_t h, int32_t middle) {
    int32_t i = 0;
    i = 0;
    if (c[46]) {
        middle = 0;
    }
    while (i <= c[16]) {
        s[(h + i)] = shift_left(((middle + c[17]) + (i * c[18])), 14);
        i = (i + 1);
    }
    while (i <= (c[16] + c[16])) {
        s[(h + i)] = 0;
        i = (i + 1);
    }
}

static int32_t histogram_place(int32_t *s, int32_t *c, int32_t h, int32_t reading) {
    int32_t k = 0;
    k = c[16];
    if (reading < (s[h] >> 14)) {
        if (c[22]) {
            return (-1);
        }
        s[h] = (shift_left(reading, 14) + (s[h] & 16383));
    } else {
        if (reading >= (s[(h + k)] >> 14)) {
            if (c[22]) {
                return (-1);
            }
            s[(h + k)] = shift_left((reading + 1), 14);
        }
    }
    k = (k - 1);
    while (reading < (s[(h + k)] >> 14)) {
        k = (k - 1);
    }
    return k;
}

static int32_t histogram_emptiest(int32_t *s, int32_t *c, int32_t h, int32_t j) {
    int32_t count = 0;
    int32_t found = 0;
    int32_t i = 0;
    s[7] = 1073741823;
    found = 0;
    i = h;
    while (i < ((h + c[16]) - 1)) {
        if ((i != (h + j)) && ((i + 1) != (h + j))) {
            count = (s[i] & 16383);
            count = (count + (s[(i + 1)] & 16383));
            if (c[21] == 0) {
                count = floor_div(shift_left(count, 12), ((s[(i + 2)] >> 14) - (s[i] >> 14)));
            }
            if (count < s[7]) {
                s[7] = count;
                found = (i - h);
            }
        }
        i = (i + 1);
    }
    return found;
}

static void histogram_halve(int32_t *s, int32_t h, int32_t bins) {
    int32_t count = 0;
    int32_t i = 0;
    int32_t rest = 0;
    int32_t total = 0;
    i = 0;
    while (i < bins) {
        count = (s[(h + i)] & 16383);
        if (count) {
            total = s[(((h + bins) + 1) + i)];
            rest = floor_mod(total, count);
            total = ((floor_div(total, count) * (count >> 1)) + floor_div((rest * (count >> 1)), count));
            s[(((h + bins) + 1) + i)] = total;
            count = (s[(h + i)] - ((count + 1) >> 1));
            s[(h + i)] = count;
        }
        i = (i + 1);
    }
}

static void histogram_merge(int32_t *s, int32_t h, int32_t bins, int32_t p) {
    while (((s[(h + p)] & 16383) + (s[((h + p) + 1)] & 16383)) > 16383) {
        histogram_halve(s, h, bins);
    }
    s[(h + p)] = (s[(h + p)] + (s[((h + p) + 1)] & 16383));
    s[(((h + bins) + 1) + p)] = (s[(((h + bins) + 1) + p)] + s[(((h + bins) + 2) + p)]);
    p = (p + 1);
    while (p < bins) {
        s[(h + p)] = s[((h + p) + 1)];
        if (p < (bins - 1)) {
            s[(((h + bins) + 1) + p)] = s[(((h + bins) + 2) + p)];
        }
        p = (p + 1);
    }
}

static void histogram_open_gap(int32_t *s, int32_t h, int32_t bins, int32_t j) {
    int32_t k = 0;
    int32_t width = 0;
    k = bins;
    while (k > j) {
        s[(h + k)] = s[((h + k) - 1)];
        if (k > (j + 1)) {
            s[((h + bins) + k)] = s[(((h + bins) + k) - 1)];
        }
        k = (k - 1);
    }
    width = ((s[((h + j) + 2)] >> 14) - (s[(h + j)] >> 14));
    s[((h + j) + 1)] = shift_left(((s[(h + j)] >> 14) + (width >> 1)), 14);
}

static int32_t histogram_fullest(int32_t *s, int32_t h, int32_t bins) {
    int32_t j = 0;
    j = 0;
    while (bins > 0) {
        bins = (bins - 1);
        if ((s[(h + bins)] & 16383) >= (s[(h + j)] & 16383)) {
            j = bins;
        }
    }
    return j;
}

static int32_t histogram_recentre(int32_t *s, int32_t *c, int32_t h, int32_t k) {
    int32_t by = 0;
    int32_t width = 0;
    if ((k == 0) || (k == (c[16] - 1))) {
        return 0;
    }
    h = (h + k);
    width = ((s[(h + 1)] >> 14) - (s[h] >> 14));
    k = (s[h] & 16383);
    if ((k < c[23]) || (width >= (4 * c[19]))) {
        return 0;
    }
    by = ((floor_div(s[((h + 1) + c[16])], k) - (s[h] >> 14)) - (width >> 1));
    if (width < 32) {
        width = 32;
    }
    if ((by < (width >> 4)) && (by > (-(width >> 4)))) {
        return 0;
    }
    if ((((s[h] >> 14) + by) <= (s[(h - 1)] >> 14)) || (((s[(h + 1)] >> 14) + by) >= (s[(h + 2)] >> 14))) {
        return 0;
    }
    s[h] = (s[h] + shift_left(by, 14));
    s[(h + 1)] = (s[(h + 1)] + shift_left(by, 14));
    return 1;
}

static int32_t histogram_crowded(int32_t *s, int32_t *c, int32_t h, int32_t j, int32_t p) {
    int32_t count = 0;
    int32_t pair = 0;
    j = (j + h);
    p = (p + h);
    count = (s[j] & 16383);
    pair = ((s[p] & 16383) + (s[(p + 1)] & 16383));
    if (count < c[23]) {
        return 0;
    }
    if (c[21] == 0) {
        count = floor_div(shift_left(count, 12), ((s[(j + 1)] >> 14) - (s[j] >> 14)));
        pair = floor_div(shift_left(pair, 12), ((s[(p + 2)] >> 14) - (s[p] >> 14)));
    }
    if (count > (c[20] * pair)) {
        return 1;
    }
    return 0;
}

static void histogram_share_evenly(int32_t *s, int32_t h, int32_t bins, int32_t j) {
    int32_t count = 0;
    int32_t total = 0;
    int32_t upper = 0;
    count = (s[(h + j)] & 16383);
    total = s[(((h + bins) + 1) + j)];
    upper = (count >> 1);
    s[(h + j)] = (s[(h + j)] - upper);
    s[((h + j) + 1)] = (s[((h + j) + 1)] + upper);
    if (count) {
        upper = ((floor_div(total, count) * upper) + floor_div((floor_mod(total, count) * upper), count));
    }
    s[(((h + bins) + 2) + j)] = upper;
    s[(((h + bins) + 1) + j)] = (total - upper);
}

static void histogram_share_by_mean(int32_t *s, int32_t h, int32_t bins, int32_t j) {
    int32_t count = 0;
    int32_t total = 0;
    count = (s[(h + j)] & 16383);
    total = s[(((h + bins) + 1) + j)];
    if (total >= ((s[((h + j) + 1)] >> 14) * count)) {
        s[(h + j)] = (s[(h + j)] - count);
        s[((h + j) + 1)] = (s[((h + j) + 1)] + count);
        s[(((h + bins) + 1) + j)] = 0;
        s[(((h + bins) + 2) + j)] = total;
    } else {
        s[(((h + bins) + 2) + j)] = 0;
    }
}

static int32_t histogram_adapt(int32_t *s, int32_t *c, int32_t h, int32_t k) {
    int32_t pair = 0;
    if (c[21]) {
        k = histogram_fullest(s, h, c[16]);
    } else {
        if (histogram_recentre(s, c, h, k)) {
            histogram_halve(s, h, c[16]);
            return 1;
        }
    }
    if (((s[((h + k) + 1)] >> 14) - (s[(h + k)] >> 14)) < (2 * c[19])) {
        return 0;
    }
    pair = histogram_emptiest(s, c, h, k);
    if (histogram_crowded(s, c, h, k, pair) == 0) {
        return 0;
    }
    histogram_merge(s, h, c[16], pair);
    if (pair < k) {
        k = (k - 1);
    }
    histogram_open_gap(s, h, c[16], k);
    if (c[21]) {
        histogram_share_evenly(s, h, c[16], k);
    } else {
        histogram_share_by_mean(s, h, c[16], k);
        histogram_halve(s, h, c[16]);
    }
    return 1;
}

static int32_t histogram_add(int32_t *s, int32_t *c, int32_t h, int32_t a) {
    int32_t k = 0;
    k = floor_div(s[(a + 0)], s[(a + 1)]);
    k = histogram_place(s, c, h, k);
    if (k < 0) {
        return 0;
    }
    while (((s[(h + k)] & 16383) + s[(a + 1)]) > 16383) {
        histogram_halve(s, h, c[16]);
    }
    s[(h + k)] = (s[(h + k)] + s[(a + 1)]);
    s[(((h + k) + 1) + c[16])] = (s[(((h + k) + 1) + c[16])] + s[(a + 0)]);
    histogram_adapt(s, c, h, k);
    return 1;
}

static void estimators_feed(int32_t *s, int32_t *c, int32_t a, int32_t e) {
    int32_t k = 0;
    if (s[(e + 3)] == 0) {
        k = floor_div(s[(a + 0)], s[(a + 1)]);
        histogram_clear(s, c, (e + 4), k);
        s[(e + 1)] = shift_left(s[52], 4);
    }
    if (histogram_add(s, c, (e + 4), a) == 0) {
        return;
    }
    if (s[(e + 3)] < 33554431) {
        s[(e + 3)] = (s[(e + 3)] + s[(a + 1)]);
    }
    s[(e + 2)] = histogram_read_out_q8(s, (e + 4), c[16]);
    k = histogram_population(s, (e + 4), c[16]);
    if (k < s[(a + 1)]) {
        k = s[(a + 1)];
    }
    k = floor_div(((shift_left(s[52], 4) - s[(e + 1)]) * s[(a + 1)]), k);
    s[(e + 1)] = (s[(e + 1)] + k);
}

static void estimators_learn_anywhere(int32_t *s, int32_t *c, int32_t a) {
    int32_t temp = 0;
    temp = s[52];
    if (temp < s[(a + 3)]) {
        s[(a + 3)] = temp;
    }
    if (temp > s[(a + 4)]) {
        s[(a + 4)] = temp;
    }
    estimators_feed(s, c, a, (a + 32));
}

static void estimators_touch(int32_t *s, int32_t *c, int32_t a, int32_t e) {
    int32_t d = 0;
    int32_t held = 0;
    int32_t k = 0;
    if (e < (a + c[47])) {
        k = (a + 6);
        held = e;
        while (s[k] != e) {
            d = s[k];
            s[k] = held;
            held = d;
            k = (k + 1);
        }
        s[k] = held;
    }
}

static int32_t estimators_third(int32_t *s, int32_t a, int32_t e) {
    int32_t part = 0;
    int32_t span = 0;
    span = ((s[(a + 4)] - s[(a + 3)]) + 1);
    part = floor_div(((s[(e + 0)] - s[(a + 3)]) * 3), span);
    if (part < 0) {
        return 0;
    }
    if (part > 2) {
        return 2;
    }
    return part;
}

static int32_t estimators_distance(int32_t *s, int32_t *c, int32_t a, int32_t e) {
    int32_t d = 0;
    int32_t gap = 0;
    int32_t nearest = 0;
    nearest = 1048575;
    d = (a + c[47]);
    while (d < (a + c[15])) {
        gap = (s[(d + 0)] - s[(e + 0)]);
        if (gap < 0) {
            gap = (-gap);
        }
        if ((d != e) && (gap < nearest)) {
            nearest = gap;
        }
        d = (d + c[26]);
    }
    return nearest;
}

static int32_t estimators_outermost(int32_t *s, int32_t *c, int32_t a, int32_t e) {
    int32_t colder = 0;
    int32_t d = 0;
    int32_t hotter = 0;
    colder = 1;
    hotter = 1;
    d = (a + c[47]);
    while (d < (a + c[15])) {
        if ((s[(d + 0)] != (-1048576)) && (s[(d + 0)] < s[(e + 0)])) {
            colder = 0;
        }
        if (s[(d + 0)] > s[(e + 0)]) {
            hotter = 0;
        }
        d = (d + c[26]);
    }
    return (colder | hotter);
}

static int32_t estimators_richest(int32_t *s, int32_t *c, int32_t a, int32_t part) {
    int32_t best = 0;
    int32_t e = 0;
    best = 0;
    e = (a + c[47]);
    while (e < (a + c[15])) {
        if ((s[(e + 0)] != (-1048576)) && (estimators_third(s, a, e) == part)) {
            if ((best == 0) || (s[(e + 3)] > s[(best + 3)])) {
                best = e;
            }
        }
        e = (e + c[26]);
    }
    return best;
}

static int32_t estimators_protected(int32_t *s, int32_t *c, int32_t a, int32_t e) {
    int32_t part = 0;
    part = estimators_third(s, a, e);
    if (part == s[7]) {
        return 0;
    }
    if (estimators_richest(s, c, a, part) == e) {
        return 1;
    }
    return 0;
}

static int32_t estimators_most_crowded(int32_t *s, int32_t *c, int32_t a, int32_t e) {
    int32_t d = 0;
    int32_t found = 0;
    found = e;
    s[80] = estimators_distance(s, c, a, e);
    d = (a + c[47]);
    while (d < (a + c[15])) {
        if ((estimators_distance(s, c, a, d) < s[80]) && (estimators_outermost(s, c, a, d) == 0)) {
            if (estimators_protected(s, c, a, d) == 0) {
                s[80] = estimators_distance(s, c, a, d);
                found = d;
            }
        }
        d = (d + c[26]);
    }
    return found;
}

static int32_t estimators_poorest(int32_t *s, int32_t *c, int32_t a, int32_t e) {
    int32_t d = 0;
    int32_t found = 0;
    found = e;
    d = (a + c[47]);
    while (d < (a + c[15])) {
        if ((s[(d + 3)] < s[(found + 3)]) && (estimators_protected(s, c, a, d) == 0)) {
            found = d;
        }
        d = (d + c[26]);
    }
    return found;
}

static int32_t estimators_victim(int32_t *s, int32_t *c, int32_t a, int32_t e) {
    int32_t d = 0;
    s[7] = estimators_third(s, a, e);
    d = (a + c[47]);
    while (d < (a + c[15])) {
        if (s[(d + 0)] == (-1048576)) {
            return d;
        }
        d = (d + c[26]);
    }
    if (c[21]) {
        return estimators_poorest(s, c, a, e);
    }
    return estimators_most_crowded(s, c, a, e);
}

static void estimators_copy(int32_t *s, int32_t *c, int32_t to, int32_t e) {
    int32_t i = 0;
    i = 0;
    while (i < c[26]) {
        s[(to + i)] = s[(e + i)];
        i = (i + 1);
    }
}

static int32_t estimators_make_room(int32_t *s, int32_t *c, int32_t a, int32_t temp) {
    int32_t e = 0;
    int32_t k = 0;
    e = s[(((a + 6) - 1) + c[24])];
    if ((s[(e + 0)] != (-1048576)) && (s[(e + 3)] >= c[29])) {
        k = estimators_victim(s, c, a, e);
        if (k != e) {
            estimators_copy(s, c, k, e);
        }
    }
    s[(e + 0)] = (floor_div((temp + (c[27] >> 1)), c[27]) * c[27]);
    s[(e + 1)] = shift_left(temp, 4);
    s[(e + 3)] = 0;
    return e;
}

static void estimators_age(int32_t *s, int32_t *c, int32_t a) {
    int32_t e = 0;
    e = (a + c[47]);
    while (e < (a + c[15])) {
        histogram_halve(s, (e + 4), c[16]);
        s[(e + 3)] = (s[(e + 3)] >> 1);
        e = (e + c[26]);
    }
}

static void estimators_learn_here(int32_t *s, int32_t *c, int32_t a) {
    int32_t e = 0;
    int32_t temp = 0;
    temp = s[52];
    e = estimators_find(s, c, a, temp);
    if (e == 0) {
        e = estimators_make_room(s, c, a, temp);
    }
    estimators_touch(s, c, a, e);
    s[(a + 2)] = e;
    estimators_feed(s, c, a, e);
    s[(a + 5)] = (s[(a + 5)] + s[(a + 1)]);
    if (s[(a + 5)] >= c[30]) {
        s[(a + 5)] = 0;
        estimators_age(s, c, a);
    }
}

static void fit_weigh(int32_t *s, int32_t *c, int32_t a) {
    int32_t d = 0;
    int32_t e = 0;
    int32_t i = 0;
    int32_t w = 0;
    w = 80;
    while (w <= 92) {
        s[w] = 0;
        w = (w + 1);
    }
    i = (92 + 1);
    e = (a + c[14]);
    while (e < (a + c[15])) {
        w = 0;
        if ((s[(e + 0)] != (-1048576)) && (s[(e + 3)] >= c[31])) {
            w = s[(e + 3)];
            s[90] = (s[90] + w);
            if (w > c[32]) {
                w = c[32];
            }
            if (c[33]) {
                d = ((s[(e + 1)] - shift_left(s[47], 4)) >> c[42]);
                if ((d > 16383) || (d < (-16383))) {
                    d = 16383;
                }
                w = (floor_div((w * c[51]), (c[33] + (d * d))) + 1);
            }
            if (s[91] == 0) {
                s[86] = s[(e + 1)];
                s[87] = s[(e + 2)];
                s[88] = s[(e + 1)];
                s[89] = s[(e + 1)];
            }
            if (s[(e + 1)] < s[88]) {
                s[88] = s[(e + 1)];
            }
            if (s[(e + 1)] > s[89]) {
                s[89] = s[(e + 1)];
            }
            s[91] = (s[91] + 1);
        }
        s[i] = w;
        s[92] = (s[92] + w);
        i = (i + 1);
        e = (e + c[26]);
    }
}

static int32_t fixed_room(int32_t value) {
    int32_t shift = 0;
    if (value < 0) {
        value = (0 - value);
    }
    shift = 0;
    if (value == 0) {
        return 27;
    }
    if (value < 2048) {
        value = shift_left(value, 16);
        shift = 16;
    }
    if (value < 524288) {
        value = shift_left(value, 8);
        shift = (shift + 8);
    }
    if (value < 8388608) {
        value = shift_left(value, 4);
        shift = (shift + 4);
    }
    if (value < 33554432) {
        value = shift_left(value, 2);
        shift = (shift + 2);
    }
    if (value < 67108864) {
        shift = (shift + 1);
    }
    return shift;
}

static int32_t fixed_ratio_q26(int32_t a, int32_t b) {
    int32_t i = 0;
    int32_t q = 0;
    int32_t sign = 0;
    sign = 1;
    if (a < 0) {
        a = (-a);
        sign = (-1);
    }
    if (b == 0) {
        return 0;
    }
    if ((a >> 2) >= b) {
        return (sign * 268435455);
    }
    q = floor_div(a, b);
    a = floor_mod(a, b);
    i = 0;
    while (i < 26) {
        a = shift_left(a, 1);
        q = shift_left(q, 1);
        if (a >= b) {
            a = (a - b);
            q = (q + 1);
        }
        i = (i + 1);
    }
    return (sign * q);
}

static int32_t fixed_floating_ratio_q26(int32_t a, int32_t b, int32_t exponent) {
    int32_t shift = 0;
    if ((a == 0) || (b <= 0)) {
        return 0;
    }
    while ((a > 134217727) || (a < (-134217727))) {
        a = (a >> 1);
        exponent = (exponent + 1);
    }
    while (b > 134217727) {
        b = (b >> 1);
        exponent = (exponent - 1);
    }
    shift = fixed_room(a);
    a = shift_left(a, shift);
    exponent = (exponent - shift);
    shift = fixed_room(b);
    b = shift_left(b, shift);
    exponent = (exponent + shift);
    a = fixed_ratio_q26(a, b);
    while (exponent > 0) {
        if ((a > 134217727) || (a < (-134217727))) {
            return ((a > 0) ? 268435455 : (-268435455));
        }
        a = shift_left(a, 1);
        exponent = (exponent - 1);
    }
    return (a >> ((exponent > (-30)) ? (0 - exponent) : 30));
}

static int32_t fit_stretch(int32_t *s) {
    int32_t w = 0;
    w = (s[89] - s[88]);
    w = fixed_room(w);
    return (w - 1);
}

static void fit_settle(int32_t *s, int32_t *c, int32_t a) {
    int32_t slope = 0;
    s[(a + 22)] = s[91];
    s[(a + 21)] = s[90];
    s[(a + 14)] = s[86];
    s[(a + 15)] = s[80];
    s[(a + 16)] = (shift_left(s[87], 3) + s[81]);
    slope = (s[(82 + 1)] - s[(84 + 1)]);
    slope = fixed_floating_ratio_q26(s[84], s[82], slope);
    s[(a + 17)] = slope;
    s[(a + 18)] = fit_stretch(s);
    s[(a + 19)] = s[88];
    s[(a + 20)] = s[89];
}

static int32_t fixed_fraction_q27(int32_t a, int32_t b) {
    int32_t i = 0;
    int32_t q = 0;
    q = 0;
    i = 0;
    while (i < 3) {
        a = shift_left(a, 9);
        q = (shift_left(q, 9) + floor_div(a, b));
        a = floor_mod(a, b);
        i = (i + 1);
    }
    return q;
}

static int32_t fit_within(int32_t *s, int32_t t) {
    if (t < s[88]) {
        return s[88];
    }
    if (t > s[89]) {
        return s[89];
    }
    return t;
}

static void fit_centre(int32_t *s, int32_t *c, int32_t a, int32_t i) {
    int32_t d = 0;
    int32_t w = 0;
    w = s[(92 + i)];
    if (w == 0) {
        return;
    }
    d = s[92];
    w = fixed_fraction_q27(w, d);
    a = (a + ((i * c[26]) + 32));
    d = s[(a + 1)];
    d = (fit_within(s, d) - s[86]);
    d = shift_left(d, fit_stretch(s));
    d = fixed_scaled(w, d, 27);
    s[80] = (s[80] + d);
    d = (s[(a + 2)] - s[87]);
    d = fixed_scaled(w, shift_left(d, 3), 27);
    s[81] = (s[81] + d);
}

static void fit_add_product(int32_t *s, int32_t k, int32_t p, int32_t r) {
    int32_t h = 0;
    int32_t i = 0;
    h = (k >> 7);
    k = (k & 127);
    if ((p == 0) || (r == 0)) {
        return;
    }
    i = fixed_room(r);
    p = fixed_scaled(p, shift_left(r, i), 27);
    h = (h + (i - 2));
    i = fixed_room(p);
    p = (shift_left(p, i) >> 2);
    h = (h + i);
    if (s[k] == 0) {
        s[(k + 1)] = h;
    }
    i = (h - s[(k + 1)]);
    if (i >= 0) {
        p = (p >> ((i < 30) ? i : 30));
    } else {
        s[k] = (s[k] >> ((i > (-30)) ? (0 - i) : 30));
        s[(k + 1)] = h;
    }
    s[k] = (s[k] + p);
}

static void fit_lean(int32_t *s, int32_t *c, int32_t a, int32_t i) {
    int32_t k = 0;
    int32_t w = 0;
    w = s[(92 + i)];
    a = (a + ((i * c[26]) + 32));
    i = s[(a + 1)];
    i = (fit_within(s, i) - s[86]);
    i = (shift_left(i, fit_stretch(s)) - s[80]);
    a = (shift_left((s[(a + 2)] - s[87]), 3) - s[81]);
    k = fixed_room(w);
    w = fixed_scaled(shift_left(w, k), shift_left(i, fixed_room(i)), 27);
    k = (shift_left((k + fixed_room(i)), 7) + 82);
    fit_add_product(s, k, w, i);
    fit_add_product(s, ((k + 84) - 82), w, a);
}

static void fit_draw_line(int32_t *s, int32_t *c, int32_t a) {
    int32_t i = 0;
    fit_weigh(s, c, a);
    i = 1;
    while (i < c[25]) {
        fit_centre(s, c, a, i);
        i = (i + 1);
    }
    i = 1;
    while (i < c[25]) {
        if (s[(92 + i)]) {
            fit_lean(s, c, a, i);
        }
        i = (i + 1);
    }
    fit_settle(s, c, a);
}

static void recent_hand_over(int32_t *s, int32_t *c, int32_t a) {
    int32_t after = 0;
    if (s[(a + 27)] < 0) {
        s[(a + 27)] = 0;
    } else {
        after = s[52];
        after = bias_curve_q8(s, c, a, after);
        s[(a + 24)] = (s[(a + 24)] + (s[(a + 23)] - after));
    }
}

static int32_t recent_error_q4(int32_t *s, int32_t *c, int32_t a) {
    int32_t before = 0;
    int32_t mean = 0;
    before = s[52];
    before = bias_curve_q8(s, c, a, before);
    s[(a + 23)] = before;
    mean = floor_mod(s[(a + 0)], s[(a + 1)]);
    mean = floor_div(shift_left(mean, 8), s[(a + 1)]);
    mean = (mean + shift_left(floor_div(s[(a + 0)], s[(a + 1)]), 8));
    return (((mean - before) - s[(a + 24)]) >> 4);
}

static int32_t recent_gain_q14(int32_t variance, int32_t noise) {
    while ((variance + noise) > 32767) {
        variance = (variance >> 1);
        noise = (noise >> 1);
    }
    return floor_div(shift_left(variance, 14), ((variance + noise) + 1));
}

static int32_t recent_level_q8(int32_t *s, int32_t *c, int32_t a) {
    int32_t k = 0;
    int32_t off = 0;
    int32_t usual = 0;
    k = ((c[0] + (-3)) + floor_div((a - c[0]), c[13]));
    if (s[54] < c[39]) {
        off = (s[(a + 24)] >> 4);
        if (off > 16383) {
            off = 16383;
        }
        if (off < (-16383)) {
            off = (-16383);
        }
        usual = (off * off);
        if (usual < c[45]) {
            usual = c[45];
        }
        s[k] = recent_beyond_q8(s, c, a);
        usual = recent_gain_q14(s[k], usual);
        s[k] = (s[(a + 24)] - ((off * usual) >> 10));
    }
    return s[k];
}

static void recent_let_learn(int32_t *s, int32_t *c, int32_t a) {
    int32_t n = 0;
    int32_t off = 0;
    if ((a == c[0]) && (s[54] < c[39])) {
        s[54] = (s[54] + 1);
    }
    off = recent_level_q8(s, c, a);
    n = s[(a + 1)];
    s[(a + 0)] = (s[(a + 0)] - (((off >> 8) * n) + ((((off & 255) * n) + 128) >> 8)));
}

static int32_t recent_plausible(int32_t *s, int32_t *c, int32_t a, int32_t error) {
    int32_t far = 0;
    far = ((error >= 0) ? error : (0 - error));
    if (far > 32767) {
        far = 32767;
    }
    if (far <= c[38]) {
        far = 0;
    }
    if (floor_div((far * far), 36) <= ((s[81] + s[80]) + recent_beyond_q8(s, c, a))) {
        s[(a + 27)] = 0;
        return 1;
    }
    s[(a + 27)] = (s[(a + 27)] + 1);
    if (s[(a + 27)] < c[39]) {
        return 0;
    }
    s[(a + 27)] = 0;
    s[(a + 24)] = (s[(a + 24)] + shift_left(error, 4));
    return 2;
}

static int32_t recent_adopt(int32_t *s, int32_t *c, int32_t a, int32_t error) {
    int32_t noise = 0;
    noise = ((s[(a + 12)] >> 3) + c[37]);
    if (s[(a + 30)] == 0) {
        s[(a + 27)] = (-1);
        s[54] = c[39];
    } else {
        if ((noise >= recent_grown_q8(s, a)) && (s[(a + 13)] != (s[(a + 12)] & 7))) {
            return 1;
        } else {
            s[(a + 24)] = (s[(a + 24)] + shift_left(error, 4));
        }
    }
    s[(a + 13)] = (s[(a + 12)] & 7);
    s[(a + 25)] = noise;
    s[(a + 28)] = 0;
    return 1;
}

static void recent_rewalk(int32_t *s, int32_t *c, int32_t a, int32_t excess) {
    int32_t age = 0;
    int32_t share = 0;
    int32_t speed = 0;
    age = ((s[(a + 28)] >> 6) + 1);
    if (excess > 2097151) {
        excess = 2097151;
    }
    if (excess < (-2097151)) {
        excess = (-2097151);
    }
    speed = floor_div(shift_left(excess, 8), age);
    if (speed > 33554431) {
        speed = 33554431;
    }
    if (speed < (-33554431)) {
        speed = (-33554431);
    }
    speed = shift_left(speed, 4);
    if (speed > c[41]) {
        speed = c[41];
    }
    if (age > 1023) {
        age = 1023;
    }
    speed = ((speed - s[(a + 26)]) >> 4);
    share = (age * age);
    share = floor_div(share, ((share + 1048576) >> 10));
    if (share < 40) {
        share = 40;
    }
    speed = shift_left(((speed * share) >> 10), 4);
    s[(a + 26)] = (s[(a + 26)] + speed);
    if (s[(a + 26)] < c[40]) {
        s[(a + 26)] = c[40];
    }
}

static void recent_follow(int32_t *s, int32_t *c, int32_t a, int32_t error) {
    int32_t excess = 0;
    int32_t gain = 0;
    if (error > 16383) {
        error = 16383;
    }
    if (error < (-16383)) {
        error = (-16383);
    }
    excess = ((error * error) - s[(a + 25)]);
    excess = (excess - s[80]);
    recent_rewalk(s, c, a, excess);
    gain = recent_gain_q14(s[81], s[80]);
    s[(a + 24)] = (s[(a + 24)] + ((gain * error) >> 10));
    excess = ((gain * (s[80] & 16383)) >> 14);
    s[(a + 25)] = ((gain * (s[80] >> 14)) + excess);
}

static int32_t recent_believe(int32_t *s, int32_t *c, int32_t a, int32_t error) {
    int32_t verdict = 0;
    if (s[(a + 12)]) {
        return recent_adopt(s, c, a, error);
    }
    s[(a + 13)] = 0;
    if (s[(a + 30)] == 0) {
        s[(a + 27)] = (-1);
        s[54] = c[39];
        s[(a + 24)] = 0;
        s[(a + 25)] = s[80];
        s[(a + 28)] = 0;
        return 1;
    }
    s[81] = recent_grown_q8(s, a);
    verdict = recent_plausible(s, c, a, error);
    if (verdict == 0) {
        return 0;
    }
    if (verdict == 1) {
        recent_follow(s, c, a, error);
    } else {
        s[(a + 25)] = s[80];
    }
    s[(a + 28)] = 0;
    return 1;
}

static int32_t recent_absorb(int32_t *s, int32_t *c, int32_t a) {
    int32_t error = 0;
    s[80] = (floor_div(s[49], (3 * s[(a + 1)])) + c[37]);
    error = recent_error_q4(s, c, a);
    if (recent_believe(s, c, a, error) == 0) {
        return 0;
    }
    recent_let_learn(s, c, a);
    return 1;
}

static void step_advance(int32_t *s, int32_t *c) {
    int32_t a = 0;
    int32_t axis = 0;
    int32_t busy = 0;
    int32_t piece = 0;
    axis = floor_div((s[53] - 1), 3);
    piece = floor_mod((s[53] - 1), 3);
    busy = 0;
    while ((busy == 0) && (axis < 3)) {
        a = (c[0] + (axis * c[13]));
        if (piece == 0) {
            busy = s[(a + 1)];
            if (busy && (recent_absorb(s, c, a) == 0)) {
                s[(a + 1)] = 0;
            }
            if (s[(a + 1)]) {
                estimators_learn_anywhere(s, c, a);
            }
        } else {
            if (piece == 1) {
                estimators_learn_here(s, c, a);
                busy = 1;
            }
        }
        if (s[(a + 1)] && (piece < 2)) {
            piece = (piece + 1);
        } else {
            if (step_stale(s, c, a)) {
                fit_draw_line(s, c, a);
                busy = 1;
            }
            if (s[(a + 1)] && (c[46] == 0)) {
                recent_hand_over(s, c, a);
            }
            s[(a + 1)] = 0;
            step_publish(s, c, a, axis);
            axis = (axis + 1);
            piece = 0;
        }
    }
    s[53] = ((axis < 3) ? (((axis * 3) + piece) + 1) : 0);
}

static int32_t stillness_spread_q8(int32_t *s, int32_t *c, int32_t first, int32_t square) {
    int32_t i = 0;
    int32_t mean_q4 = 0;
    i = 0;
    while (i < 3) {
        mean_q4 = (shift_left(s[(first + i)], 4) >> c[4]);
        square = (square - ((mean_q4 * s[(first + i)]) >> 4));
        i = (i + 1);
    }
    if (square < 0) {
        square = 0;
    }
    return shift_left(square, (8 - c[4]));
}

static int32_t stillness_tip_q8(int32_t *s, int32_t *c) {
    int32_t d = 0;
    int32_t i = 0;
    int32_t square = 0;
    i = 0;
    square = 0;
    while (i < 3) {
        d = ((shift_left(s[(19 + i)], 4) + (shift_left(s[(26 + i)], 4) >> c[4])) - s[(36 + i)]);
        if (d > 8191) {
            d = 8191;
        }
        if (d < (-8191)) {
            d = (-8191);
        }
        square = (square + (d * d));
        i = (i + 1);
    }
    return square;
}

static int32_t stillness_change_q4(int32_t *s, int32_t *c) {
    int32_t d = 0;
    int32_t i = 0;
    int32_t most = 0;
    i = 0;
    most = 0;
    while (i < 3) {
        d = ((shift_left(s[((19 + 4) + i)], 4) + (shift_left(s[((26 + 4) + i)], 4) >> c[4])) - s[(39 + i)]);
        if (d < 0) {
            d = (-d);
        }
        if (d > most) {
            most = d;
        }
        i = (i + 1);
    }
    return most;
}

static int32_t stillness_white(int32_t *s, int32_t *c, int32_t spread) {
    int32_t step = 0;
    step = shift_left(s[76], (8 - c[4]));
    spread = (spread >> 4);
    step = (step >> 4);
    if ((step > ((spread + (spread >> 1)) - (spread >> 3))) && (step < ((3 * spread) - (spread >> 2)))) {
        return 1;
    }
    return 0;
}

static int32_t stillness_look(int32_t *s, int32_t *c) {
    int32_t change = 0;
    int32_t noise_q8 = 0;
    int32_t shake_q8 = 0;
    if (s[18] > 3) {
        return 2;
    }
    if (s[18]) {
        return 4;
    }
    noise_q8 = stillness_spread_q8(s, c, (26 + 4), s[35]);
    if ((noise_q8 > c[7]) && (stillness_white(s, c, noise_q8) == 0)) {
        return 2;
    }
    shake_q8 = stillness_spread_q8(s, c, 26, s[33]);
    if (shake_q8 > c[8]) {
        return 4;
    }
    s[49] = (s[49] + ((noise_q8 - s[49]) >> 3));
    if (s[34] == 0) {
        return 1;
    }
    s[51] = stillness_tip_q8(s, c);
    if (s[51] > (c[9] + (6 * (shake_q8 >> c[4])))) {
        return 3;
    }
    if (s[48]) {
        change = stillness_change_q4(s, c);
        if (change > 32767) {
            return 5;
        }
        if ((change * change) > (c[10] + (14 * (noise_q8 >> c[4])))) {
            return 5;
        }
    }
    return 1;
}

static void stillness_begin(int32_t *s, int32_t *c, int32_t anchored) {
    int32_t i = 0;
    i = 0;
    while (i < 3) {
        if (anchored == 0) {
            s[(36 + i)] = (shift_left(s[(19 + i)], 4) + (shift_left(s[(26 + i)], 4) >> c[4]));
        }
        s[(39 + i)] = (shift_left(s[((19 + 4) + i)], 4) + (shift_left(s[((26 + 4) + i)], 4) >> c[4]));
        s[(42 + i)] = 0;
        i = (i + 1);
    }
    s[45] = 0;
    s[48] = 0;
    s[34] = 1;
}

static int32_t stillness_judge(int32_t *s, int32_t *c) {
    int32_t i = 0;
    int32_t state = 0;
    int32_t total = 0;
    state = stillness_look(s, c);
    s[46] = state;
    s[47] = (s[(19 + 3)] + (s[(26 + 3)] >> c[4]));
    s[17] = 0;
    if ((state == 2) || (state == 4)) {
        s[34] = 0;
        return 0;
    }
    if ((state != 1) || (s[34] == 0)) {
        stillness_begin(s, c, 0);
    } else {
        if (s[48] == 0) {
            stillness_begin(s, c, 1);
        }
    }
    i = 0;
    while (i < 3) {
        total = shift_left(s[((19 + 4) + i)], c[4]);
        total = (total - ((s[(64 + i)] + 128) >> 8));
        total = (total + s[((26 + 4) + i)]);
        s[(42 + i)] = (s[(42 + i)] + total);
        i = (i + 1);
    }
    s[45] = (s[45] + s[47]);
    s[48] = (s[48] + 1);
    if (s[48] < c[5]) {
        return 0;
    }
    s[48] = 0;
    return 1;
}

static void step_foresay(int32_t *s, int32_t axis, int32_t bias, int32_t quality) {
    s[(67 + axis)] = bias;
    s[(55 + axis)] = bias;
    s[(70 + axis)] = quality;
    s[(73 + axis)] = 1;
}

static void step_foretell(int32_t *s, int32_t *c, int32_t axis) {
    int32_t level = 0;
    int32_t n = 0;
    if (s[(73 + axis)] > 1) {
        return;
    }
    if ((s[46] == 1) && (s[48] > 1)) {
        n = shift_left(s[48], c[4]);
        level = shift_left(floor_div(s[(42 + axis)], n), 8);
        level = (level + floor_div(shift_left(floor_mod(s[(42 + axis)], n), 8), n));
        step_foresay(s, axis, level, c[44]);
    } else {
        if (s[(73 + axis)] == 1) {
            step_foresay(s, axis, 0, 0);
            s[(73 + axis)] = 0;
        }
    }
}

static void step_close(int32_t *s, int32_t *c) {
    int32_t a = 0;
    int32_t i = 0;
    int32_t still = 0;
    while (s[53]) {
        step_advance(s, c);
    }
    still = stillness_judge(s, c);
    if (still) {
        s[52] = floor_div(s[45], c[5]);
    }
    i = 0;
    while (i < 3) {
        a = (c[0] + (i * c[13]));
        s[(a + 28)] = (s[(a + 28)] + floor_div(s[16], 1000));
        if (s[(a + 28)] > 67108863) {
            s[(a + 28)] = 67108863;
        }
        if ((still == 0) && (s[(a + 30)] == 0) && (c[46] == 0)) {
            step_foretell(s, c, i);
        }
        if (still && (c[46] == 0)) {
            s[(a + 0)] = s[(42 + i)];
            s[(a + 1)] = shift_left(c[5], c[4]);
            s[(a + 12)] = 0;
        }
        i = (i + 1);
    }
    s[16] = 0;
    s[53] = 1;
}

static void step_learn_at_once(int32_t *s, int32_t *c, int32_t *x) {
    int32_t a = 0;
    int32_t i = 0;
    s[52] = x[3];
    i = 0;
    while (i < 3) {
        a = (c[0] + (i * c[13]));
        s[(a + 0)] = x[(4 + i)];
        s[(a + 1)] = 1;
        estimators_learn_anywhere(s, c, a);
        estimators_learn_here(s, c, a);
        s[(a + 1)] = 0;
        i = (i + 1);
    }
}

static int32_t step_admit(int32_t *s, int32_t *c, int32_t *x, int32_t kind) {
    int32_t i = 0;
    if (kind == 0) {
        if (stillness_gather(s, c, x)) {
            step_close(s, c);
        }
        if ((s[8] == 1) || (c[3] == 4)) {
            s[47] = x[3];
            s[53] = 1;
            while (s[53]) {
                step_advance(s, c);
            }
        }
        if (c[46]) {
            step_learn_at_once(s, c, x);
        }
    }
    i = c[12];
    while ((i > 0) && s[53]) {
        step_advance(s, c);
        i = (i - 1);
    }
    return kind;
}

static int32_t step_finish(int32_t *s, int32_t *c, int32_t *x, int32_t kind) {
    int32_t d = 0;
    int32_t i = 0;
    i = 0;
    if (kind > 2) {
        return kind;
    }
    while (i < 3) {
        d = (s[(67 + i)] - s[(55 + i)]);
        if (d > c[11]) {
            d = c[11];
        } else {
            if (d < (-c[11])) {
                d = (-c[11]);
            }
        }
        s[(55 + i)] = (s[(55 + i)] + d);
        d = (((shift_left(x[(4 + i)], 8) - s[(55 + i)]) - s[(61 + i)]) + s[(58 + i)]);
        x[(4 + i)] = ((d + 128) >> 8);
        s[(58 + i)] = (d - shift_left(x[(4 + i)], 8));
        i = (i + 1);
    }
    return kind;
}

static int32_t step_step(int32_t *s, int32_t *c, int32_t *x, int32_t dt_us) {
    int32_t kind = 0;
    kind = step_examine(s, c, x, dt_us);
    step_admit(s, c, x, kind);
    return step_finish(s, c, x, kind);
}

static int32_t block_stretch(int32_t *s, int32_t *c, int32_t *r) {
    int32_t i = 0;
    int32_t n = 0;
    if (s[53] || c[46] || (c[3] == 4) || (c[1] > 2097151)) {
        return 0;
    }
    if ((s[8] == 0) || (s[8] > 536870400)) {
        return 0;
    }
    if ((s[55] != s[67]) || (s[(55 + 1)] != s[(67 + 1)])) {
        return 0;
    }
    if (s[(55 + 2)] != s[(67 + 2)]) {
        return 0;
    }
    i = ((c[3] - 1) - s[17]);
    n = ((r[8] - r[7]) >> 3);
    return ((i < n) ? i : n);
}

static int32_t block_plain(int32_t *s, int32_t *f, int32_t *c, int32_t p) {
    int32_t d = 0;
    d = (f[(p + 4)] - s[(0 + 3)]);
    if ((f[p] <= 0) || (f[p] > c[1]) || (d >= c[2]) || (d <= (-c[2]))) {
        return 0;
    }
    if ((f[(p + 5)] == s[(0 + 4)]) && (f[(p + 6)] == s[(0 + 5)]) && (f[(p + 7)] == s[(0 + 6)])) {
        return 0;
    }
    if ((f[(p + 5)] == f[(p + 6)]) && (f[(p + 6)] == f[(p + 7)])) {
        return 0;
    }
    if ((f[(p + 5)] > 32000) || (f[(p + 6)] > 32000) || (f[(p + 7)] > 32000)) {
        return 0;
    }
    if ((f[(p + 5)] < (-32000)) || (f[(p + 6)] < (-32000)) || (f[(p + 7)] < (-32000))) {
        return 0;
    }
    return 1;
}

static int32_t block_edge(int32_t *s, int32_t *f, int32_t *c, int32_t *r, int32_t k) {
    int32_t d = 0;
    int32_t i = 0;
    int32_t p = 0;
    p = r[7];
    if (k) {
        k = block_plain(s, f, c, p);
    }
    if (k) {
        i = 0;
        while (i < 7) {
            r[i] = f[((p + 1) + i)];
            s[(0 + i)] = r[i];
            i = (i + 1);
        }
        s[8] = (s[8] + 1);
        i = (s[16] + f[p]);
        s[16] = ((i < 536870911) ? i : 536870911);
    }
    if (k) {
        stillness_gather(s, c, r);
    }
    if (k) {
        i = 0;
        while (i < 3) {
            d = ((((shift_left(r[(4 + i)], 8) - s[(55 + i)]) - s[(61 + i)]) + s[(58 + i)]) + 128);
            f[((p + 5) + i)] = (d >> 8);
            s[(58 + i)] = ((d & 255) - 128);
            i = (i + 1);
        }
        f[p] = 0;
        r[7] = (p + 8);
    }
    return k;
}

static void block_account(int32_t *s, int32_t *f, int32_t p, int32_t taken, int32_t elapsed_us) {
    s[0] = f[(p - 7)];
    s[(0 + 1)] = f[(p - 6)];
    s[(0 + 2)] = f[(p - 5)];
    s[(0 + 3)] = f[(p - 4)];
    s[8] = (s[8] + taken);
    s[17] = (s[17] + taken);
    elapsed_us = (elapsed_us + s[16]);
    s[16] = ((elapsed_us < 536870911) ? elapsed_us : 536870911);
}

static void block_take(int32_t *s, int32_t *f, int32_t *c, int32_t *r) {
    int32_t a = 0;
    int32_t b = 0;
    int32_t bias_x = 0;
    int32_t bias_y = 0;
    int32_t bias_z = 0;
    int32_t d = 0;
    int32_t due_x = 0;
    int32_t due_y = 0;
    int32_t due_z = 0;
    int32_t dx = 0;
    int32_t dy = 0;
    int32_t dz = 0;
    int32_t elapsed_us = 0;
    int32_t far = 0;
    int32_t g = 0;
    int32_t i = 0;
    int32_t last_t = 0;
    int32_t last_x = 0;
    int32_t last_y = 0;
    int32_t last_z = 0;
    int32_t leap_us = 0;
    int32_t least_jump = 0;
    int32_t left = 0;
    int32_t most_jump = 0;
    int32_t moving = 0;
    int32_t n = 0;
    int32_t near = 0;
    int32_t near_bits = 0;
    int32_t p = 0;
    int32_t ref_a = 0;
    int32_t ref_b = 0;
    int32_t ref_c = 0;
    int32_t ref_t = 0;
    int32_t ref_x = 0;
    int32_t ref_y = 0;
    int32_t ref_z = 0;
    int32_t since = 0;
    int32_t square_accel = 0;
    int32_t square_gyro = 0;
    int32_t square_step = 0;
    int32_t sum_a = 0;
    int32_t sum_b = 0;
    int32_t sum_c = 0;
    int32_t sum_t = 0;
    int32_t sum_x = 0;
    int32_t sum_y = 0;
    int32_t sum_z = 0;
    int32_t t = 0;
    int32_t usual_us = 0;
    int32_t x = 0;
    int32_t y = 0;
    int32_t z = 0;
    left = block_stretch(s, c, r);
    d = ((left && (s[17] == 0)) ? 1 : 0);
    n = block_edge(s, f, c, r, d);
    if (d) {
        left = (n ? (left - 1) : 0);
    }
    p = r[7];
    n = left;
    moving = s[18];
    leap_us = c[1];
    usual_us = leap_us;
    since = p;
    elapsed_us = 0;
    most_jump = (c[2] - 1);
    least_jump = (1 - c[2]);
    near = ((c[2] > 256) ? 256 : 0);
    near_bits = (near ? 9 : 0);
    last_t = s[(0 + 3)];
    last_x = s[(0 + 4)];
    last_y = s[(0 + 5)];
    last_z = s[(0 + 6)];
    ref_a = s[19];
    ref_b = s[(19 + 1)];
    ref_c = s[(19 + 2)];
    ref_t = s[(19 + 3)];
    ref_x = s[(19 + 4)];
    ref_y = s[(19 + 5)];
    ref_z = s[(19 + 6)];
    sum_a = s[26];
    sum_b = s[(26 + 1)];
    sum_c = s[(26 + 2)];
    sum_t = s[(26 + 3)];
    sum_x = s[(26 + 4)];
    sum_y = s[(26 + 5)];
    sum_z = s[(26 + 6)];
    square_accel = s[33];
    square_gyro = s[35];
    square_step = s[76];
    bias_x = (s[55] + s[61]);
    bias_y = (s[(55 + 1)] + s[(61 + 1)]);
    bias_z = (s[(55 + 2)] + s[(61 + 2)]);
    due_x = ((s[58] + 128) - bias_x);
    due_y = ((s[(58 + 1)] + 128) - bias_y);
    due_z = ((s[(58 + 2)] + 128) - bias_z);
    while (left) {
        if (f[p] != usual_us) {
            if ((f[p] <= 0) || (f[p] > leap_us)) {
                break;
            }
            elapsed_us = (elapsed_us + (((p - since) >> 3) * usual_us));
            since = p;
            usual_us = f[p];
        }
        t = f[(p + 4)];
        d = (t - last_t);
        if (((d + near) >> near_bits)) {
            if ((d > most_jump) || (d < least_jump)) {
                break;
            }
        }
        x = f[(p + 5)];
        y = f[(p + 6)];
        z = f[(p + 7)];
        if ((x == last_x) && (y == last_y) && (z == last_z)) {
            break;
        }
        if ((x == y) && (y == z)) {
            break;
        }
        if (moving) {
            if (((((x + 16384) | (y + 16384)) | (z + 16384)) >> 15)) {
                if ((x > 32766) || (y > 32766) || (z > 32766)) {
                    break;
                }
                if ((x < (-32767)) || (y < (-32767)) || (z < (-32767))) {
                    break;
                }
            }
            sum_t = (sum_t + (t - ref_t));
        } else {
            a = (f[(p + 1)] - ref_a);
            b = (f[(p + 2)] - ref_b);
            g = (f[(p + 3)] - ref_c);
            d = (t - ref_t);
            dx = (x - ref_x);
            dy = (y - ref_y);
            dz = (z - ref_z);
            far = ((((a + 512) | (b + 512)) | (g + 512)) | (d + 512));
            if ((((((dx + 512) | (dy + 512)) | (dz + 512)) | far) >> 10)) {
                break;
            }
            sum_a = (sum_a + a);
            sum_b = (sum_b + b);
            sum_c = (sum_c + g);
            sum_t = (sum_t + d);
            sum_x = (sum_x + dx);
            sum_y = (sum_y + dy);
            sum_z = (sum_z + dz);
            square_accel = (square_accel + (((a * a) + (b * b)) + (g * g)));
            square_gyro = (square_gyro + (((dx * dx) + (dy * dy)) + (dz * dz)));
            a = (x - last_x);
            b = (y - last_y);
            g = (z - last_z);
            square_step = (square_step + (((a * a) + (b * b)) + (g * g)));
        }
        last_t = t;
        last_x = x;
        last_y = y;
        last_z = z;
        f[(p + 5)] = ((due_x >> 8) + x);
        due_x = ((due_x & 255) - bias_x);
        f[(p + 6)] = ((due_y >> 8) + y);
        due_y = ((due_y & 255) - bias_y);
        f[(p + 7)] = ((due_z >> 8) + z);
        due_z = ((due_z & 255) - bias_z);
        f[p] = 0;
        p = (p + 8);
        left = (left - 1);
    }
    r[7] = p;
    n = (n - left);
    elapsed_us = (elapsed_us + (((p - since) >> 3) * usual_us));
    if (n) {
        block_account(s, f, p, n, elapsed_us);
        s[(0 + 4)] = last_x;
        s[(0 + 5)] = last_y;
        s[(0 + 6)] = last_z;
        s[(26 + 3)] = sum_t;
        s[58] = ((due_x + bias_x) - 128);
        s[(58 + 1)] = ((due_y + bias_y) - 128);
        s[(58 + 2)] = ((due_z + bias_z) - 128);
    }
    if (n && (moving == 0)) {
        s[26] = sum_a;
        s[(26 + 1)] = sum_b;
        s[(26 + 2)] = sum_c;
        s[(26 + 4)] = sum_x;
        s[(26 + 5)] = sum_y;
        s[(26 + 6)] = sum_z;
        s[33] = square_accel;
        s[35] = square_gyro;
        s[76] = square_step;
        s[77] = (last_x - ref_x);
        s[(77 + 1)] = (last_y - ref_y);
        s[(77 + 2)] = (last_z - ref_z);
        i = 0;
        while (i < 3) {
            s[(64 + i)] = (s[(64 + i)] + (s[(61 + i)] * n));
            i = (i + 1);
        }
    }
    block_edge(s, f, c, r, left);
}

static void block_one(int32_t *s, int32_t *f, int32_t *c, int32_t *r) {
    int32_t i = 0;
    int32_t p = 0;
    p = r[7];
    i = 0;
    while (i < 7) {
        r[i] = f[((p + 1) + i)];
        i = (i + 1);
    }
    i = f[p];
    f[p] = step_step(s, c, r, i);
    i = 0;
    while (i < 7) {
        f[((p + 1) + i)] = r[i];
        i = (i + 1);
    }
    r[7] = (p + 8);
}

static void block_block(int32_t *s, int32_t *f, int32_t *c, int32_t *r, int32_t n) {
    r[7] = 0;
    r[8] = shift_left(n, 3);
    while (r[7] < r[8]) {
        n = r[7];
        if ((s[53] == 0) && (s[17] < (c[3] - 1))) {
            block_take(s, f, c, r);
        }
        if (r[7] == n) {
            block_one(s, f, c, r);
        }
    }
}

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static size_t words;

static int32_t *whole(const char *name) {
    FILE *file = fopen(name, "rb");
    if (!file) exit(2);
    fseek(file, 0, SEEK_END);
    words = (size_t)ftell(file) / 4;
    rewind(file);
    int32_t *content = malloc(words * 4);
    if (!content || fread(content, 4, words, file) != words) exit(2);
    fclose(file);
    return content;
}

static void keep(const char *name, const int32_t *content, size_t count) {
    FILE *file = fopen(name, "wb");
    if (!file || fwrite(content, 4, count, file) != count || fclose(file)) exit(2);
}

int main(int argc, char **argv) {
    int32_t *c = whole("settings.bin");
    int32_t *s = whole("state.bin");
    size_t state_words = words;
    int32_t *frames = whole("frames.bin");
    size_t count = argc > 2 ? (size_t)atoi(argv[1]) : 0;
    int call = argc > 2 && atoi(argv[2]);
    size_t at_once = argc > 3 ? (size_t)atoi(argv[3]) : 1;
    int times = argc > 4 ? atoi(argv[4]) : 1;
    int32_t x[9];
    if (count > words / 8) exit(2);
    int32_t *first_state = malloc(state_words * 4);
    int32_t *first_frames = malloc(words * 4);
    if (!first_state || !first_frames) exit(2);
    memcpy(first_state, s, state_words * 4);
    memcpy(first_frames, frames, words * 4);
again:
    for (size_t i = 0; at_once > 1 && i < count; i += at_once) {
        int32_t most = (int32_t)(count - i < at_once ? count - i : at_once);
        if (call) block_block(s, frames + 8 * i, c, x, most);
    }
    for (size_t i = 0; at_once == 1 && i < count; i++) {
        int32_t *frame = frames + 8 * i;
        memcpy(x, frame + 1, 7 * sizeof *x);
        if (call) frame[0] = step_step(s, c, x, frame[0]);
        memcpy(frame + 1, x, 7 * sizeof *x);
    }
    if (--times > 0) {
        memcpy(s, first_state, state_words * 4);
        memcpy(frames, first_frames, words * 4);
        goto again;
    }
    keep("state.out", s, state_words);
    keep("frames.out", frames, words);
    return 0;
}
