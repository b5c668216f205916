/* For hosts: all rows of a recording in one call. bias_q8, quality_q8 and source: n of each axis,
   one axis behind the other. Where learn is 0, the settings are those of frozen; it may be null. */
#ifdef _WIN32
#define SHOWN __declspec(dllexport)
/* Nothing is to begin: the library has no C library in it. */
int DllMainCRTStartup(void *library, uint32_t reason, void *reserved) {
    (void)library, (void)reason, (void)reserved;
    return 1;
}
#else
#define SHOWN __attribute__((visibility("default")))
#endif

SHOWN void zerorate_run(int32_t *s, int32_t *c, int32_t *m, int32_t *k, int32_t *r, int32_t *q,
                        int32_t *e, int32_t *frames, const int32_t *dt_us, int64_t n,
                        const int32_t *extra, int64_t channels, int32_t *bias_q8, int8_t *source,
                        int32_t *quality_q8, int8_t *verdict, int32_t *frozen,
                        const int8_t *learn) {
    for (int64_t i = 0; i < n; i++) {
        for (int64_t j = 0; j < channels; j++)
            if (extra[i * channels + j] != GAP) e[CHANNELS + j] = extra[i * channels + j];
        int32_t *own = learn && !learn[i] ? frozen : c;
        verdict[i] = (int8_t)zerorate_update(s, own, m, k, r, q, e, frames + 7 * i, dt_us[i]);
        for (int axis = 0; axis < 3; axis++) {
            bias_q8[axis * n + i] = s[OUT_Q8 + axis] + s[EFFECT_Q8 + axis];
            quality_q8[axis * n + i] = s[QUALITY_Q8 + axis];
            source[axis * n + i] = (int8_t)s[SOURCE + axis];
        }
    }
}

/* One source on its own: words (n, 2, 3), what stands at `bias` and `sigma` when it last learned. */
SHOWN void zerorate_source(int32_t gravity, int32_t *s, int32_t *c, int32_t *frames,
                           const int32_t *dt_us, int64_t n, int32_t bias, int32_t sigma,
                           int8_t *learned, int32_t *words) {
    int32_t held[6] = {0};
    for (int64_t i = 0; i < n; i++) {
        int32_t *x = frames + 7 * i;
        learned[i] = (int8_t)(gravity ? gravity_update(s, c, x, dt_us[i])
                                      : in_motion_update(s, c, x, dt_us[i]));
        for (int axis = 0; learned[i] && axis < 3; axis++) {
            held[axis] = s[bias + axis];
            held[3 + axis] = s[sigma + axis];
        }
        for (int j = 0; j < 6; j++) words[6 * i + j] = held[j];
    }
}
