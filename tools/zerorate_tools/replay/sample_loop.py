"""What `Corrector.update` does, a row at a time, as jit.compiled_run compiles it.

The kernels' names, GAP and the words of the state are put into this module before it runs;
MOTION, LEVEL, EFFECTS and REFINING say what is on. Numba leaves out what stands behind one that is
False, and with it the counting of references to arrays that nobody reads.
"""

# ruff: noqa: F821
# mypy: ignore-errors


def update(s, c, others, x, dt_us):
    """Learn from the frame and correct it in place; return what the guard says of it."""
    m, k, r, q, e = others
    kind = examine(s, c, x, dt_us)
    if EFFECTS:
        sense(s, e, x, dt_us, 0 if kind else 1)
    admit(s, c, x, kind)
    if kind == 0:
        if MOTION and in_motion(m, k, x, dt_us):
            consider(s, c, m, MOTION_BIAS_Q8, IN_MOTION)
        if LEVEL and by_level(r, q, x, dt_us):
            consider(s, c, r, GRAVITY_BIAS_Q8, ACCELEROMETER)
        if REFINING:
            attend(s, c, e)
    return finish(s, c, x, kind)


def run(s, c, others, samples, dt_us, extra, bias_q8, source, quality_q8, verdict):
    """Do so for all rows; see jit.compiled_run for the shapes."""
    for i in range(len(samples)):
        for k in range(extra.shape[1]):
            if extra[i, k] != GAP:
                others[4][CHANNELS + k] = extra[i, k]
        verdict[i] = update(s, c, others, samples[i], dt_us[i])
        for axis in range(3):
            bias_q8[i, axis] = s[OUT_Q8 + axis] + s[EFFECT_Q8 + axis]
            quality_q8[i, axis] = s[QUALITY_Q8 + axis]
            source[i, axis] = s[SOURCE + axis]
