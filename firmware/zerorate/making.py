"""Makes a Corrector: its settings, its state, and the sources beside rests that it has."""

try:
    from uarray import array  # so MicroPython does not look for it on its file system first
except ImportError:
    from array import array

from .machine_code import unload

# layout: names that a board's own compiler reads
const = int
# layout: The corrector's settings
_AXES = const(0)
_AXIS_WORDS = const(15)
_STEP_LSB = const(29)
# layout: end


def make(
    corrector, held, bins, short, long, document, every, ignore_outside, motion, gravity, limits
):
    """Give `corrector`, whose sensor is set, all else; the arguments are the Corrector's.

    held: a list that holds heap in one piece for the state. Raises ValueError.
    """
    from .settings import settings

    if every is None:
        every = document
    c, corrector._walk_q16, chosen = settings(
        corrector.sensor, bins, short, long, document, every, ignore_outside, limits
    )
    unload("zerorate", "settings")
    corrector.settings = c
    corrector._step_lsb = c[_STEP_LSB]
    # before other sources are loaded, while there is heap in one piece; a list of as many zeros
    # would want as much again
    held.clear()
    corrector.state = array("i", range(c[_AXES] + 3 * c[_AXIS_WORDS]))
    corrector.left_out = []
    if every or document:  # who asks for other rules gets those alone
        motion, gravity = bool(motion), bool(gravity)
    join(corrector, "motion", motion, document, chosen["motion_start_dps"])
    join(corrector, "gravity", gravity, document, 0)
    unload("zerorate", "ratio")


def join(corrector, part, wanted, document, start_dps):
    """Give it a source, or say in left_out why it has none. Raises what hinders a wanted one."""
    # loaded here, so that who does without it has no memory taken by it
    if wanted or wanted is None:
        package, name = "zerorate." + part, part + "_settings"
        try:
            __import__(package + "." + name, None, None, (part,)).join(
                corrector, document, start_dps
            )
            unload(package, name)
            from .others import join as join_others

            join_others(corrector)
        except ImportError:
            if wanted:
                raise ImportError(why_without(part))
            corrector.left_out.append(part)  # its sentence would take heap for ever
        except ValueError as why:
            if wanted:
                raise
            corrector.left_out.append(str(why))


def why_without(left_out):
    """Return the words of an entry of left_out, the name of a part or words already."""
    if " " in left_out:
        return left_out
    return "{0} is not on this board; zerorate flash --with {0} sends it".format(left_out)
