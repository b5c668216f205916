/* zerorate: keeps a gyroscope's bias at zero. Made by `zerorate export c`; see docs/c.md.
   Integers of 32 bits only: no heap, no float, no library. MIT licence. */
#ifndef ZERORATE_H
#define ZERORATE_H
#include <stdint.h>

#define ZERORATE_VERSION "@VERSION@"
#define ZERORATE_VERSION_MAJOR @MAJOR@
#define ZERORATE_VERSION_MINOR @MINOR@
#define ZERORATE_VERSION_PATCH @PATCH@

/* what the samples are: exported for these alone */
#define ZERORATE_ODR_HZ @ODR_HZ@f
#define ZERORATE_GYRO_LSB_PER_DPS @GYRO@f
#define ZERORATE_ACCEL_LSB_PER_G @ACCEL@f
#define ZERORATE_TEMP_LSB_PER_DEGC @TEMP@f
#define ZERORATE_TEMP_OFFSET_DEGC @OFFSET@f

#define ZERORATE_STATE_WORDS @STATE_WORDS@
#define ZERORATE_SETTINGS_WORDS @SETTINGS_WORDS@
#define ZERORATE_EFFECTS_WORDS @EFFECTS_WORDS@
/* one of the two slots of a store */
#define ZERORATE_RECORD_BYTES (24 + 4 * (ZERORATE_STATE_WORDS + ZERORATE_SETTINGS_WORDS))

typedef struct {
    int32_t state[ZERORATE_STATE_WORDS]; /* what was learned */
    int32_t settings[ZERORATE_SETTINGS_WORDS];
@EFFECTS@} zerorate_t;

/* Where what was learned survives a power cut: two slots from byte base on, pitch bytes apart, each
   of ZERORATE_RECORD_BYTES. read and write return 0 when it is done; write erases first where the
   memory needs that, and returns when all is durable. binding: codes of chip and ranges, or zeros.
   Records are those of LearnedStore in Python. */
typedef struct {
    int32_t (*read)(void *context, uint32_t at, uint8_t *data, uint32_t count);
    int32_t (*write)(void *context, uint32_t at, const uint8_t *data, uint32_t count);
    void *context;
    uint32_t base, pitch;
    uint8_t binding[4];
    uint8_t record[ZERORATE_RECORD_BYTES]; /* room to work in */
} zerorate_store_t;

/* what zerorate_load returns */
enum {
@REASONS@
};

#ifdef __cplusplus
extern "C" {
#endif
/* Forget everything. */
void zerorate_begin(zerorate_t *z);
/* sample: ax ay az temp gx gy gz, raw LSB, rates corrected in place; dt_us: since the one before.
   Returns 0 for a good reading, else what is wrong with the frame (1 repeated ... 7 time leapt). */
int32_t zerorate_update(zerorate_t *z, int32_t sample[7], int32_t dt_us);
/* Begin a power-on with what the state holds; same: the chip kept its power, the program did not.
   zerorate_load does it. */
void zerorate_power_on(zerorate_t *z, int32_t same);
/* Begin a power-on with what the store holds: ZERORATE_LOADED, or why the state is as it was. */
int32_t zerorate_load(zerorate_t *z, zerorate_store_t *store, int32_t same);
/* Write what was learned into the older slot; 1 when it stands there. Save when zerorate_learned,
   and best at a rest. */
int32_t zerorate_save(const zerorate_t *z, zerorate_store_t *store);
/* Whether every axis has a bias that was learned; whether the device was still just now. */
int32_t zerorate_learned(const zerorate_t *z);
int32_t zerorate_rests(const zerorate_t *z);
/* Of an axis: what is subtracted and its one sigma, both in 1/256 LSB, and where it comes from. */
int32_t zerorate_bias_q8(const zerorate_t *z, int32_t axis);
int32_t zerorate_quality_q8(const zerorate_t *z, int32_t axis);
int32_t zerorate_source(const zerorate_t *z, int32_t axis);
@CHANNELS@#ifdef __cplusplus
}
#endif
#endif
