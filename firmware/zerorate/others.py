"""What a power-on does to the sources that need no rest: their windows hold what was before."""


def forget(corrector):
    """Make the state of each as new."""
    if corrector.motion is not None:
        from .native import motion

        clear(corrector.motion, motion.clear, corrector.motion_settings)
    if corrector.gravity is not None:
        from .native import gravity

        clear(corrector.gravity, gravity.clear, corrector.gravity_settings)


def clear(state, begin, settings):
    """Make a source's state as new, in place: a copy of it would want as much heap again."""
    for i in range(len(state)):
        state[i] = 0
    begin(state, settings)
