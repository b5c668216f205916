/* zerorate in physical units: degrees, g, degC and seconds, as floats. See docs/c.md. */
#ifndef ZERORATE_UNITS_H
#define ZERORATE_UNITS_H
#include "zerorate.h"

/* An axis' bias, and its one sigma, in degrees a second. */
static inline float zerorate_bias_dps(const zerorate_t *z, int32_t axis) {
    return (float)zerorate_bias_q8(z, axis) / (256.0f * ZERORATE_GYRO_LSB_PER_DPS);
}

static inline float zerorate_quality_dps(const zerorate_t *z, int32_t axis) {
    return (float)zerorate_quality_q8(z, axis) / (256.0f * ZERORATE_GYRO_LSB_PER_DPS);
}

/* The nearest word of 16 bits; what is no number is at the rail, where the guard refuses it. */
static inline int32_t zerorate_word(float value) {
    if (!(value > -32768.0f && value < 32767.0f)) return value >= 32767.0f ? 32767 : -32768;
    return (int32_t)(value < 0.0f ? value - 0.5f : value + 0.5f);
}

/* Learn from a sample and take the bias off its rates, in place; dt_s: since the one before.
   Returns as zerorate_update. The rates keep their own resolution. */
static inline int32_t zerorate_update_dps(zerorate_t *z, float gyro_dps[3], const float accel_g[3],
                                          float temp_degc, float dt_s) {
    /* a time that fills no word, or is no number, has leapt */
    int32_t dt_us = dt_s > -2000.0f && dt_s < 2000.0f ? (int32_t)(dt_s * 1e6f + 0.5f) : 2147483647;
    int32_t sample[7], verdict;
    for (int32_t i = 0; i < 3; i++) {
        sample[i] = zerorate_word(accel_g[i] * ZERORATE_ACCEL_LSB_PER_G);
        sample[4 + i] = zerorate_word(gyro_dps[i] * ZERORATE_GYRO_LSB_PER_DPS);
    }
    sample[3] =
        zerorate_word((temp_degc - ZERORATE_TEMP_OFFSET_DEGC) * ZERORATE_TEMP_LSB_PER_DEGC);
    verdict = zerorate_update(z, sample, dt_us);
    for (int32_t i = 0; i < 3; i++) gyro_dps[i] -= zerorate_bias_dps(z, i);
    return verdict;
}
#endif
