static int32_t later(int32_t late_us, int32_t dt_us) {
    int32_t most = 0x1FFFFFFF, more = dt_us < 0 ? 0 : dt_us < most ? dt_us : most;
    return late_us + more < most ? late_us + more : most;
}

/* What Corrector.update does with a sample; a null pointer is a source or a model that is off. */
int32_t zerorate_update(int32_t *s, int32_t *c, int32_t *m, int32_t *k, int32_t *r, int32_t *q,
                        int32_t *e, int32_t *x, int32_t dt_us) {
    int32_t kind = guard_check(s, c, x, dt_us);
    if (e) effects_sense(s, e, x, dt_us, kind == 0);
    step_admit(s, c, x, kind);
    if (kind == 0 && s[STILLNESS] != SILENT) {
        int32_t *sensed = e ? e : x;
        if (m && in_motion_update(m, k, sensed, dt_us))
            step_consider(s, c, m, MOTION_BIAS_Q8, IN_MOTION);
        if (r && gravity_update(r, q, sensed, dt_us))
            step_consider(s, c, r, GRAVITY_BIAS_Q8, GRAVITY);
        if (e && e[REFINE_ON]) effect_refine_attend(s, c, e);
    } else {
        if (m) m[LATE_US] = later(m[LATE_US], dt_us);
        if (r) r[GRAVITY_LATE_US] = later(r[GRAVITY_LATE_US], dt_us);
    }
    return step_finish(s, c, x, kind);
}
