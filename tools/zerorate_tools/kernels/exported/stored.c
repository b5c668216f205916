/* What Corrector.power_on, Store and is_sound do, in C: the same records and the same reasons. */
enum { HEADER = 20, BEHIND = 4, ALL = 4 * (ZERORATE_STATE_WORDS + ZERORATE_SETTINGS_WORDS) };

void zerorate_power_on(zerorate_t *z, int32_t same) {
    int32_t *s = z->state, *c = z->settings;
    begin_effects(z);
    for (int32_t i = 0; i < c[SETTINGS_AXES]; i++) s[i] = 0;
    for (int32_t axis = 0; axis < 3; axis++) {
        int32_t *a = s + c[SETTINGS_AXES] + axis * c[SETTINGS_AXIS_WORDS];
        int32_t offset = a[AXIS_OFFSET_Q8];
        a[AXIS_WAITING_N] = 0;
        a[AXIS_SUSPECT] = 0;
        a[AXIS_LINE_TEMP] = -32768;
        if (!same) {
            /* what is beyond the gate was a jump, and stays */
            if ((offset < 0 ? -offset : offset) >> 4 < c[SETTINGS_GATE_Q4]) a[AXIS_OFFSET_Q8] >>= 1;
            /* what motion left unsure is no surer after having been off */
            int32_t usual = c[SETTINGS_TURN_ON_VARIANCE_Q8];
            if (!a[AXIS_OFFSET_FROM] || a[AXIS_OFFSET_VARIANCE_Q8] < usual) {
                a[AXIS_OFFSET_VARIANCE_Q8] = usual;
                a[AXIS_LEFT_Q4] = NO_VALUE;
            }
            a[AXIS_OFFSET_AGE_MS] = 0;
        }
        /* TURN_ON_OFFSET_Q8: else what is held back until it insists would be the curve's */
        s[c[SETTINGS_AXES] - 3 + axis] = a[AXIS_OFFSET_Q8];
    }
}

static uint32_t crc_on(uint32_t crc, const uint8_t *data, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        crc ^= data[i];
        for (int32_t bit = 0; bit < 8; bit++) crc = (crc >> 1) ^ (crc & 1u ? 0xedb88320u : 0u);
    }
    return crc;
}

static void put_word(uint8_t *at, uint32_t word) {
    for (int32_t i = 0; i < 4; i++) at[i] = (uint8_t)(word >> (8 * i));
}

static uint32_t word_at(const uint8_t *at) {
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

/* Range and filter as the user names them, then CRC-32 of the settings before a model changed one,
   exclusive or that of the model. */
static void binding_of(const zerorate_t *z, const zerorate_store_t *store, uint8_t binding[8]) {
    uint32_t crc = 0xffffffffu;
    for (int32_t i = 0; i < ZERORATE_SETTINGS_WORDS; i++) {
        uint8_t word[4];
        put_word(word, (uint32_t)(i == SETTINGS_STEP_LSB ? OWN_STEP_LSB : z->settings[i]));
        crc = crc_on(crc, word, 4);
    }
    for (int32_t i = 0; i < 4; i++) binding[i] = store->binding[i];
    put_word(binding + 4, ~crc ^ MODEL_CRC);
}

/* Whether length bytes from `at` on end in their own CRC-32; 1, 0, or -1 where they cannot be read.
   The first of them stay in the record. */
static int32_t is_whole(zerorate_store_t *store, uint32_t at, uint32_t length) {
    uint8_t piece[64];
    uint32_t crc = 0xffffffffu;
    for (uint32_t done = 0; done < length;) {
        uint32_t count = length - done < sizeof piece ? length - done : (uint32_t)sizeof piece;
        if (store->read(store->context, at + done, piece, count)) return -1;
        for (uint32_t i = 0; done == 0 && i < HEADER; i++) store->record[i] = piece[i];
        crc = crc_on(crc, piece, count);
        done += count;
    }
    return ~crc == 0x2144df1cu;
}

static int32_t judge(const zerorate_t *z, zerorate_store_t *store, int32_t slot) {
    const uint8_t *h = store->record;
    uint32_t at = store->base + (uint32_t)slot * store->pitch, size;
    uint8_t binding[8];
    int32_t whole = is_whole(store, at, HEADER + ALL + BEHIND);
    if (whole < 0) return ZERORATE_UNREADABLE;
    if (h[0] != 'Z' || h[1] != 'R' || h[2] != 'S') {
        int32_t blank = (h[0] == 0 || h[0] == 0xff) && h[0] == h[1] && h[1] == h[2];
        return blank ? ZERORATE_EMPTY : ZERORATE_DAMAGED;
    }
    size = (uint32_t)h[6] | (uint32_t)h[7] << 8;
    if (size != ALL) {
        uint32_t length = HEADER + size + BEHIND;
        whole = length <= store->pitch ? is_whole(store, at, length) : 0;
        if (whole < 0) return ZERORATE_UNREADABLE;
    }
    if (!whole) return ZERORATE_DAMAGED;
    if (size != ALL) return h[4] != RECORD_VERSION ? ZERORATE_OTHER_VERSION : ZERORATE_OTHER_SIZE;
    if (h[3] != 1) return ZERORATE_OTHER_VERSION;
    binding_of(z, store, binding);
    for (int32_t i = 0; i < 8; i++)
        if (h[12 + i] != binding[i]) return ZERORATE_OTHER_BINDING;
    return h[4] == RECORD_VERSION ? ZERORATE_LOADED : ZERORATE_OTHER_VERSION;
}

/* The slot to load, or -1 and why; newest: the newest whole one of any kind, or -1. */
static int32_t find(const zerorate_t *z, zerorate_store_t *store, int32_t *newest,
                    uint32_t *sequence, int32_t *reason) {
    int32_t fits = -1;
    uint32_t fits_at = 0;
    *newest = -1, *sequence = 0, *reason = ZERORATE_EMPTY;
    for (int32_t slot = 0; slot < 2; slot++) {
        int32_t judged = judge(z, store, slot);
        uint32_t number = word_at(store->record + 8);
        if (judged == ZERORATE_UNREADABLE) {
            *reason = judged;
            return -1;
        }
        if (judged == ZERORATE_EMPTY || judged == ZERORATE_DAMAGED) {
            if (*newest < 0 && judged > *reason) *reason = judged;
            continue;
        }
        if (*newest < 0 || number > *sequence) {
            *newest = slot, *sequence = number, *reason = judged;
        }
        if (judged == ZERORATE_LOADED && (fits < 0 || number > fits_at)) {
            fits = slot, fits_at = number;
        }
    }
    return fits;
}

static int32_t is_within(const int32_t *words, const char *bits) {
    for (; *bits; bits++, words++) {
        int32_t rest = *words >> (*bits & 31);
        if (rest != 0 && rest != -((*bits >> 5) & 1)) return 0;
    }
    return 1;
}

static int32_t is_one_of(int32_t value, int32_t first, int32_t end, int32_t step) {
    return value >= first && value < end && (value - first) % step == 0;
}

static int32_t orders(const int32_t *c, const int32_t *order, int32_t current, int32_t a) {
    int32_t step = c[SETTINGS_ESTIMATOR_WORDS], first = a + c[SETTINGS_FIRST_SHORT];
    for (int32_t i = 0; i < c[SETTINGS_SHORT]; i++) {
        if (!is_one_of(order[i], first, a + c[SETTINGS_FIRST_LONG], step)) return 0;
        for (int32_t j = 0; j < i; j++)
            if (order[j] == order[i]) return 0;
    }
    return current == 0 || is_one_of(current, first, a + c[SETTINGS_ESTIMATORS_END], step);
}

static int32_t spans(const int32_t *c, const int32_t *axis) {
    if (c[SETTINGS_EVERY] && axis[AXIS_OFFSET_Q8] && axis[AXIS_OFFSET_FROM] == 0) return 0;
    if (axis[AXIS_COLDEST] <= axis[AXIS_HOTTEST]) return 1;
    return axis[AXIS_COLDEST] == 32767 && axis[AXIS_HOTTEST] == -32768;
}

static int32_t lies(const int32_t *c, const int32_t *axis, const int32_t *e) {
    int32_t temp = e[ESTIMATOR_TEMP], mean = e[ESTIMATOR_MEAN_TEMP_Q4] >> 4;
    int32_t most = (c[SETTINGS_STEP_LSB] << 5) + c[SETTINGS_MARGIN_LSB];
    int32_t readings = e[ESTIMATOR_READINGS], is_first = e == axis + AXIS_ESTIMATORS;
    if (readings && (mean < axis[AXIS_COLDEST] || mean > axis[AXIS_HOTTEST])) return 0;
    if (temp == FREE) return is_first || readings == 0;
    return !is_first && mean - temp >= -most && mean - temp <= most;
}

static int32_t counts(const int32_t *c, const int32_t *e) {
    const int32_t *h = e + ESTIMATOR_HISTOGRAM;
    int32_t bins = c[SETTINGS_BINS], low = h[0] >> 14, high = h[bins] >> 14;
    int32_t known = 0, near_one = 0, bias = e[ESTIMATOR_BIAS_Q8];
    if (h[bins] & 0x3fff) return 0;
    for (int32_t k = 0; k < bins; k++) {
        int32_t count = h[k] & 0x3fff;
        int64_t total = h[k + bins + 1];
        known += count;
        if (h[k] >> 14 >= h[k + 1] >> 14) return 0;
        if ((int64_t)low * count > total || total > (int64_t)high * count) return 0;
        if (count) {
            int64_t sum = total * 256, mean = sum / count;
            if (sum % count < 0) mean--;
            near_one |= mean - bias > -NEAR_Q8 && mean - bias < NEAR_Q8;
        } else if (bins > 1) {
            near_one = 1; /* the bin that the bias was the mean of may have been halved away */
        }
    }
    if (e[ESTIMATOR_READINGS] && (low * 256 > bias || bias > high * 256)) return 0;
    return known <= e[ESTIMATOR_READINGS] && (near_one || !known);
}

static int32_t is_sound(const int32_t *s, const int32_t *c) {
    for (int32_t i = 0; i < 3; i++) {
        int32_t a = c[SETTINGS_AXES] + i * c[SETTINGS_AXIS_WORDS];
        const int32_t *axis = s + a;
        if (!is_within(axis, AXIS_BITS) || !spans(c, axis)) return 0;
        if (!orders(c, axis + AXIS_ORDER, axis[AXIS_CURRENT], a)) return 0;
        for (int32_t e = AXIS_ESTIMATORS; e < c[SETTINGS_ESTIMATORS_END];
             e += c[SETTINGS_ESTIMATOR_WORDS])
            if (!is_within(axis + e, ESTIMATOR_BITS) || !lies(c, axis, axis + e) ||
                !counts(c, axis + e))
                return 0;
    }
    return 1;
}

int32_t zerorate_load(zerorate_t *z, zerorate_store_t *store, int32_t same) {
    int32_t newest, reason, slot;
    uint32_t sequence, at;
    slot = find(z, store, &newest, &sequence, &reason);
    if (slot < 0) return reason;
    at = store->base + (uint32_t)slot * store->pitch;
    if (store->read(store->context, at, store->record, sizeof store->record) ||
        ~crc_on(0xffffffffu, store->record, sizeof store->record) != 0x2144df1cu)
        return ZERORATE_UNREADABLE;
    for (int32_t i = 0; i < ZERORATE_STATE_WORDS; i++)
        z->state[i] = (int32_t)word_at(store->record + HEADER + 4 * i);
    if (!is_sound(z->state, z->settings)) {
        begin_state(z);
        return ZERORATE_OUT_OF_RANGE;
    }
    zerorate_power_on(z, same);
    return ZERORATE_LOADED;
}

int32_t zerorate_save(const zerorate_t *z, zerorate_store_t *store) {
    int32_t newest, reason, slot;
    uint32_t sequence, at = HEADER;
    uint8_t *record = store->record;
    (void)find(z, store, &newest, &sequence, &reason);
    if (reason == ZERORATE_UNREADABLE) return 0;
    slot = newest == 0 ? 1 : 0;
    sequence++;
    record[0] = 'Z', record[1] = 'R', record[2] = 'S', record[3] = 1;
    record[4] = RECORD_VERSION, record[5] = 0;
    record[6] = ALL & 0xff, record[7] = ALL >> 8;
    put_word(record + 8, sequence);
    binding_of(z, store, record + 12);
    for (int32_t i = 0; i < ZERORATE_STATE_WORDS; i++, at += 4)
        put_word(record + at, (uint32_t)z->state[i]);
    for (int32_t i = 0; i < ZERORATE_SETTINGS_WORDS; i++, at += 4)
        put_word(record + at, (uint32_t)z->settings[i]);
    put_word(record + at, ~crc_on(0xffffffffu, record, at));
    at = store->base + (uint32_t)slot * store->pitch;
    if (store->write(store->context, at, record, sizeof store->record)) return 0;
    return judge(z, store, slot) == ZERORATE_LOADED && word_at(record + 8) == sequence;
}

int32_t zerorate_learned(const zerorate_t *z) {
    for (int32_t axis = 0; axis < 3; axis++)
        if (z->state[STATE_SOURCE + axis] <= ANY_TEMPERATURE) return 0;
    return 1;
}

int32_t zerorate_rests(const zerorate_t *z) { return z->state[STATE_STILLNESS] == STILL; }

int32_t zerorate_source(const zerorate_t *z, int32_t axis) { return z->state[STATE_SOURCE + axis]; }

int32_t zerorate_bias_q8(const zerorate_t *z, int32_t axis) {
    return z->state[STATE_OUT_Q8 + axis] + z->state[STATE_EFFECT_Q8 + axis];
}

int32_t zerorate_quality_q8(const zerorate_t *z, int32_t axis) {
    return z->state[STATE_QUALITY_Q8 + axis];
}
