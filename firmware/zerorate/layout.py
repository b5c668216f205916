"""Every word of every array, and every code kept in one: the only place that says where they are.

A word takes the index behind the word before it, so to add or remove one is to add or remove its
line. `make layout` writes the constants that a file uses into that file, where they cost a board
nothing, and the tables of docs/layout.md. Host tools and tests read this file; a board has no need
of it. A name stands for one thing in the whole firmware; in a firmware file it begins with `_`.

Units: LSB of the sensor unless said; a number behind a name's last `_Q` is its fractional bits.
"""


class Word:
    """One name of an array: its index, how many words it has (text where settings say), and why."""

    def __init__(self, name, index, count, unit, meaning, while_text=""):
        self.name = name
        self.index = index
        self.count = count
        self.unit = unit
        self.meaning = meaning
        self.while_text = while_text


class Overlay:
    """Words in the place of others, from the word `at` on, `while_text`: when they are theirs."""

    def __init__(self, at, while_text, *lines):
        self.at = at
        self.while_text = while_text
        self.lines = lines


class Array:
    """The words of an array or of a block in it. `array.NAME` is that word's index.

    letter: the kernels' name for the array or for the block's first word; base: where it begins.
    size_name: the constant that says how many words it has. Raises AttributeError for no word.
    """

    def __init__(self, title, letter, base, size_name, lines, overlays=(), first=0):
        self.title = title
        self.letter = letter
        self.base = base
        self.size_name = size_name
        self.words = self._placed(lines, first, "")
        last = self.words[-1]
        self.size = 0 if isinstance(last.count, str) else last.index + last.count
        for overlay in overlays:
            at = getattr(self, overlay.at)
            self.words = self.words + self._placed(overlay.lines, at, overlay.while_text)

    def _placed(self, lines, index, while_text):
        words = []
        for name, count, unit, meaning in lines:
            words.append(Word(name, index, count, unit, meaning, while_text))
            index += 0 if isinstance(count, str) else count
        return words

    def __getattr__(self, name):
        for word in self.words:
            if word.name == name:
                return word.index
        raise AttributeError(name)


class Codes:
    """Numbers that stand for something. `codes.NAME` is the number.

    owner: the file in which applications find them by name, "" where they are the kernels' own.
    """

    def __init__(self, title, owner, **numbers):
        self.title = title
        self.owner = owner
        self.numbers = numbers

    def __getattr__(self, name):
        if name in self.numbers:
            return self.numbers[name]
        raise AttributeError(name)


STATE = Array(
    "The corrector's state",
    "s",
    "`Corrector.state`",
    "",
    (
        ("FRAME", 7, "LSB", "the frame before: ax ay az temp gx gy gz"),
        ("SCRATCH", 1, "", "what a kernel leaves for the next one"),
        ("COUNTS", 8, "frames", "how many frames the guard gave each verdict"),
        ("ELAPSED_US", 1, "us", "since the window before ended"),
        ("WINDOW_N", 1, "samples", "in the window so far"),
        ("DIRTY", 1, "", "channel that left ten bits, from 1: the window is no rest"),
        ("REFERENCE", 7, "LSB", "the window's first frame"),
        ("WINDOW_SUM", 7, "LSB", "sums of the window less its reference"),
        ("SQUARE_ACCEL", 1, "LSB^2", "sum of squares, three axes together"),
        ("REST", 1, "", "1 while a rest is watched, whose gravity is the anchor"),
        ("SQUARE_GYRO", 1, "LSB^2", "sum of squares, three axes together"),
        ("ANCHOR_Q4", 3, "LSB", "mean acceleration where the rest began"),
        ("FIRST_RATE_Q4", 3, "LSB", "mean rate of the segment's first window"),
        ("SEGMENT_TOTAL", 3, "LSB", "sums of the rates of the segment, less the effects"),
        ("SEGMENT_TEMP", 1, "LSB", "sum of the temperatures of the segment's windows"),
        ("STILLNESS", 1, "code", "what the latest window was"),
        ("TEMP", 1, "LSB", "temperature at the latest window"),
        ("SEGMENT_WINDOWS", 1, "windows", "in the segment so far"),
        ("NOISE_Q8", 1, "LSB^2", "variance of a still sample, three axes together, smoothed"),
        ("TEMP_LEVEL_Q8", 1, "LSB", "temperature at the latest window, smoothed over eight"),
        ("TEMP_RISE_Q12", 1, "LSB", "by how much it rises from window to window"),
        ("TEMP_WINDOWS", 1, "windows", "that it was smoothed over, at most eight"),
        ("TIP_Q8", 1, "LSB^2", "how far gravity has moved since the rest began"),
        ("LEARN_TEMP", 1, "LSB", "temperature of the segment that is being learned"),
        ("WORK", 1, "", "next piece of the work that a window left, 0: none"),
        ("RESTS", 1, "segments", "absorbed since power-on, up to INSIST"),
        ("OUT_Q8", 3, "LSB", "learned bias that is subtracted now"),
        ("CARRY_Q8", 3, "LSB", "what rounding left over for the next sample"),
        ("EFFECT_Q8", 3, "LSB", "sum of the effect slots, subtracted as well"),
        ("EFFECT_SUM_Q8", 3, "LSB", "sum of that over the window"),
        ("TARGET_Q8", 3, "LSB", "learned bias that OUT_Q8 is on its way to"),
        ("QUALITY_Q8", 3, "LSB", "one sigma of it"),
        ("SOURCE", 3, "code", "where it comes from"),
        ("SQUARE_STEP", 1, "LSB^2", "sum of squared steps of the rates, sample to sample"),
        ("LAST_RATE", 3, "LSB", "latest rates of the window less its reference"),
        ("FIT_SUM_T", 1, "LSB", "weighted mean temperature, shifted to fill 26 bits"),
        ("FIT_SUM_B_Q11", 1, "LSB", "weighted mean bias"),
        ("FIT_SUM_TT", 2, "float", "weighted variance of temperature: mantissa, shift"),
        ("FIT_SUM_TB", 2, "float", "weighted covariance with the bias: mantissa, shift"),
        ("FIT_FIRST_T_Q4", 1, "LSB", "temperature that the sums are less"),
        ("FIT_FIRST_B_Q8", 1, "LSB", "bias that the sums are less"),
        ("FIT_LOW_Q4", 1, "LSB", "lowest temperature"),
        ("FIT_HIGH_Q4", 1, "LSB", "highest temperature"),
        ("FIT_SAMPLES", 1, "samples", "all estimators together"),
        ("FIT_POINTS", 1, "", "estimators with enough samples"),
        ("FIT_WEIGHTS", "ESTIMATOR_COUNT", "", "one an estimator"),
    ),
    (
        Overlay(
            "SCRATCH",
            "a histogram looks for its emptiest pair of bins",
            ("EMPTIEST", 1, "", "readings, or readings for their width, of the emptiest pair"),
        ),
        Overlay(
            "SCRATCH",
            "a long-term estimator is chosen to be replaced",
            ("CANDIDATE_THIRD", 1, "0..2", "third of the range in which the candidate lies"),
        ),
        Overlay(
            "SCRATCH",
            "another source's bias is considered",
            ("OFFERED_SOURCE", 1, "code", "the source"),
        ),
        Overlay(
            "FIT_SUM_T",
            "a segment is absorbed",
            ("MEAN_NOISE_Q8", 1, "LSB^2", "variance of the segment's mean"),
            ("GROWN_Q8", 1, "LSB^2", "variance of the offset now, with what it has walked"),
        ),
        Overlay(
            "FIT_SUM_T",
            "the line is bent",
            ("BEND_SQUARE_Q14", 1, "", "weighted mean square of the points' temperatures"),
            ("BEND_CUBE_Q14", 1, "", "their weighted mean cube"),
            ("BEND_NORM_Q18", 1, "", "weighted mean square of the bow"),
            ("BEND_DOT_Q12", 1, "LSB", "its weighted mean product with what the line leaves"),
            ("BEND_LEFT_Q6", 1, "LSB^2", "weighted mean square of what the line leaves"),
        ),
        Overlay(
            "FIT_SUM_T",
            "a long-term estimator is chosen to be replaced",
            ("NEAREST", 1, "LSB", "distance of the most crowded estimator's neighbour"),
        ),
        Overlay(
            "FIT_WEIGHTS",
            "a line is fitted (the first estimator is for any temperature and has no weight)",
            ("FIT_SUM_W", 1, "", "sum of the weights"),
        ),
    ),
)

TURN_ON = Array(
    "The last words before the axes",
    "c[_AXES]",
    "the first axis block",
    "",
    (("TURN_ON_OFFSET_Q8", 3, "LSB", "turn-on offset of each axis, kept out of its curve"),),
    first=-3,
)

AXIS = Array(
    "An axis",
    "a",
    "`c[_AXES] + axis * c[_AXIS_WORDS]`",
    "",
    (
        ("WAITING_SUM", 1, "LSB", "sum of the readings that wait to be learned"),
        ("WAITING_N", 1, "readings", "how many they are, 0: none"),
        ("CURRENT", 1, "word", "estimator in use, 0: none"),
        ("COLDEST", 1, "LSB", "lowest temperature learned"),
        ("HOTTEST", 1, "LSB", "highest temperature learned"),
        ("LEARNED_N", 1, "readings", "learned since the counts were halved"),
        ("ORDER", 6, "words", "the short-term estimators, latest used first"),
        ("OFFER", 1, "", "another source's variance, LSB^2 Q4, times 8, and its code; 0: a rest"),
        ("OFFSET_FROM", 1, "code", "source that the offset was adopted from, 0: rests"),
        ("LINE_T0_Q4", 1, "LSB", "temperature from which the line counts"),
        ("LINE_MEAN_T", 1, "LSB", "mean temperature beyond it, shifted by LINE_SHIFT"),
        ("LINE_MEAN_B_Q11", 1, "LSB", "mean bias"),
        ("LINE_SLOPE_Q26", 1, "", "slope, of shifted temperatures"),
        ("LINE_SHIFT", 1, "bits", "shift that makes the range of temperatures fill 26 bits"),
        ("LINE_LOW_Q4", 1, "LSB", "lowest temperature of the line's points"),
        ("LINE_HIGH_Q4", 1, "LSB", "highest temperature of the line's points"),
        ("LINE_SAMPLES", 1, "samples", "that the points stand for"),
        ("LINE_POINTS", 1, "", "points, 0: no line"),
        ("BOW_Q6", 1, "LSB", "of the parabola beside the line, over a range of its points"),
        ("BOW_MEAN_Q14", 1, "", "mean square of temperatures from the mean, in such ranges"),
        ("BOW_LEAN_Q14", 1, "", "mean cube of them for their mean square"),
        ("CURVE_BEFORE_Q8", 1, "LSB", "what the curve said before it learned the segment"),
        ("OFFSET_Q8", 1, "LSB", "offset of this power-on from the curve"),
        ("OFFSET_VARIANCE_Q8", 1, "LSB^2", "its variance when it was last learned"),
        ("WALK_Q16", 1, "LSB^2/s", "how fast that variance grows, learned"),
        ("SUSPECT", 1, "segments", "implausible ones in a row; -1: the first of all"),
        ("OFFSET_AGE_MS", 1, "ms", "since the offset was last learned"),
        ("BEYOND", 1, "", "1 where the temperature lies beyond the line's points"),
        ("KIND", 1, "code", "what of the curve speaks for this temperature"),
        ("LINE_TEMP", 1, "LSB", "temperature for which the line was last fitted"),
        ("ESTIMATORS", "ESTIMATOR_COUNT * ESTIMATOR_WORDS", "", "any temperature, short, long"),
    ),
)

ESTIMATOR = Array(
    "An estimator",
    "e",
    "`a + _ESTIMATORS + i * c[_ESTIMATOR_WORDS]`",
    "",
    (
        ("EST_TEMP", 1, "LSB", "temperature it is for, or FREE"),
        ("EST_MEAN_TEMP_Q4", 1, "LSB", "mean temperature of its readings"),
        ("EST_BIAS_Q8", 1, "LSB", "its bias"),
        ("EST_READINGS", 1, "readings", "it stands for"),
        ("EST_HISTOGRAM", "2 * BINS + 1", "", "bins + 1 words `edge << 14 | readings`, bins sums"),
    ),
)

SETTINGS = Array(
    "The corrector's settings",
    "c",
    "`Corrector.settings`",
    "SETTINGS_WORDS",
    (
        ("AXES", 1, "word", "where the axis blocks begin in the state"),
        ("LEAP_US", 1, "us", "a longer time between two samples is a fault"),
        ("JUMP_LSB", 1, "LSB", "a larger step of the temperature is a fault"),
        ("WINDOW", 1, "samples", "a window"),
        ("WINDOW_SHIFT", 1, "bits", "its power of two"),
        ("SEGMENT", 1, "windows", "a segment"),
        ("SPARE_SETTING", 1, "", "unused"),
        ("STILL_GYRO_Q8", 1, "LSB^2", "most variance of a still window's rates"),
        ("STILL_ACCEL_Q8", 1, "LSB^2", "most variance of a still window's accelerations"),
        ("TIP_LIMIT_Q8", 1, "LSB^2", "most that gravity may move in a rest"),
        ("CHANGE_LIMIT_Q8", 1, "LSB^2", "most that the rate may change in a segment"),
        ("SLEW_Q8", 1, "LSB", "most that the bias moves from a sample to the next"),
        ("WORK_A_SAMPLE", 1, "pieces", "of work that a sample does"),
        ("AXIS_WORDS", 1, "words", "an axis block"),
        ("FIRST_SHORT", 1, "words", "from the axis' first to its first short-term estimator"),
        ("ESTIMATORS_END", 1, "words", "from the axis' first to behind its last estimator"),
        ("BINS", 1, "", "bins of a histogram"),
        ("LOW_LSB", 1, "LSB", "lowest edge of an empty histogram"),
        ("WIDTH_LSB", 1, "LSB", "width of its bins"),
        ("NARROWEST_LSB", 1, "LSB", "no bin gets narrower"),
        ("SPLIT_RATIO", 1, "", "a bin this much fuller than the emptiest pair is split"),
        ("LITERAL", 1, "", "1: the literal rules of US 9,354,080"),
        ("IGNORE_OUTSIDE", 1, "", "1: readings outside a histogram are ignored"),
        ("ENOUGH_TO_SPLIT", 1, "readings", "a bin of fewer is not split"),
        ("SHORT", 1, "", "short-term estimators"),
        ("ESTIMATOR_COUNT", 1, "", "estimators of an axis"),
        ("ESTIMATOR_WORDS", 1, "words", "an estimator"),
        ("STEP_LSB", 1, "LSB", "an estimator's range of temperature"),
        ("MARGIN_LSB", 1, "LSB", "how far beyond it the one in use stays in use"),
        ("PROMOTE", 1, "readings", "a short-term estimator of fewer is not kept long-term"),
        ("HALVE_AFTER", 1, "readings", "counts are halved every so many"),
        ("ENOUGH_TO_FIT", 1, "readings", "an estimator of fewer is no point of the line"),
        ("MOST_COUNTED", 1, "readings", "more of them weigh no more"),
        ("LOCAL", 1, "", "squared width of the line's neighbourhood, 0: a line through all"),
        ("STABLE", 1, "readings", "an estimator of fewer does not speak for its temperature"),
        ("SHARE_Q8", 1, "", "nor one of a smaller share of the line's samples"),
        ("BEYOND_Q4", 1, "LSB", "how far outside the line's points a temperature is beyond"),
        ("FLOOR_Q8", 1, "LSB^2", "variance that no mean of a rest is better than"),
        ("GATE_Q4", 1, "LSB", "a segment this near to what was expected is plausible"),
        ("INSIST", 1, "segments", "so many implausible ones in a row are believed"),
        ("WALK_LEAST_Q16", 1, "LSB^2/s", "the offset walks no slower"),
        ("WALK_MOST_Q16", 1, "LSB^2/s", "and no faster"),
        ("LOCAL_SHIFT", 1, "bits", "from temperatures to LOCAL's unit"),
        ("STALE_LSB", 1, "LSB", "the line is fitted again where the temperature moved so far"),
        ("PROVISIONAL_Q8", 1, "LSB", "one sigma of a bias published before it is learned"),
        ("TURN_ON_VARIANCE_Q8", 1, "LSB^2", "variance of the turn-on offset"),
        ("EVERY", 1, "", "1: every reading is learned, moving or still"),
        ("FIRST_LONG", 1, "words", "from the axis' first to its first long-term estimator"),
        ("MOST_SIGMA_Q6", 1, "LSB", "another source's bias less known than this teaches nothing"),
        ("FULL_WEIGHT_Q12", 1, "LSB^2", "its variance at which it counts as one reading"),
        ("SLOPE_Q16", 1, "LSB/LSB", "how fast the bias leaves the line beyond its points"),
        ("NEAR", 1, "", "scale of the line's local weights"),
    ),
)

MOTION = Array(
    "The state of the source in motion",
    "s",
    "`Corrector.motion`",
    "",
    (
        ("NODE_ELAPSED_US", 1, "us", "of the node so far"),
        ("NODE_N", 1, "samples", "in the node so far"),
        ("NODE_ANGLE_Q24", 3, "rad", "turned in the node"),
        ("NODE_FORCE_Q12", 3, "g", "sum of the forces in the node"),
        ("HEAD", 1, "node", "of the ring that is written next"),
        ("FILLED", 1, "nodes", "in the ring"),
        ("NEW_NODES", 1, "nodes", "since the last window began"),
        ("LENGTH", 1, "nodes", "a window"),
        ("STAGE", 1, "bits", "its power of two"),
        ("JOB", 1, "code", "what is being done: IDLE, TRAVERSE, SOLVE"),
        ("PASS", 1, "", "number of this integration of the window"),
        ("PROGRESS", 1, "", "next node of the traversal, or next piece of the algebra"),
        ("FIRST_NODE", 1, "node", "of the ring where the window begins"),
        ("MOTION_REASON", 1, "code", "what the latest window taught, or why nothing"),
        ("TAPER_SUM", 1, "Q10", "sum of the taper"),
        ("HALF", 3, "rad Q14", "half the node's turn, then the step's vector part, Q16"),
        ("REAL", 1, "Q16", "the step's real part, less one"),
        ("LAST_HEADING_Q12", 1, "rad", "of the node before"),
        ("HEADING_TURNS", 1, "turns", "of heading, whole"),
        ("Q", 1, "Q28", "orientation, body to tilt frame: real part"),
        ("QX", 1, "Q28", "its x"),
        ("QY", 1, "Q28", "its y"),
        ("QZ", 1, "Q28", "its z"),
        ("START", 1, "Q14", "orientation of the window's first node: real part"),
        ("START_X", 1, "Q14", "its x"),
        ("START_Y", 1, "Q14", "its y"),
        ("START_Z", 1, "Q14", "its z"),
        ("R", 9, "Q14", "rotation matrix, by rows"),
        ("SUM_R", 9, "Q14", "its running sum: the regressors"),
        ("Y", 3, "rad Q12", "the node's two tilts and heading"),
        ("BIAS_CARRY_Q24", 3, "rad", "what removing the bias left over for the next node"),
        ("BIAS_Q24", 3, "rad", "bias that this pass removes, a node"),
        ("TAPER", 1, "Q10", "the node's weight"),
        ("SHAPE_2", 1, "Q10", "second shape times the taper"),
        ("SHAPE_3", 1, "Q10", "third shape times the taper"),
        ("UP", 1, "g Q12", "tapered sum of the force along the vertical"),
        ("FAST", 1, "nodes", "until none in the ring turned faster than a node holds"),
        ("TRAFFIC", 1, "rad Q14", "sum of the half turns, each axis' absolute"),
        ("TILTED", 1, "rad Q14", "the same of the turns about two level axes"),
        ("AGE_NODES", 1, "nodes", "since what is known was carried to the present"),
        ("ACCEPTED", 1, "windows", "learned"),
        ("REFUSED", 1, "windows", "refused"),
        ("AGAINST", 1, "windows", "in a row that contradicted what is known"),
        ("MOTION_BIAS_Q8", 3, "LSB", "bias found in motion"),
        ("MOTION_QUALITY_Q8", 3, "LSB", "one sigma of it"),
        ("NOTED_SLOPES_Q8", 9, "LSB", "slopes of the first, second and last pass, three axes each"),
        ("SUMS", 63, "", "of the straight-line fit: a block of 21 for each component"),
        ("KNOWN_P", 12, "real", "covariance of the bias: 00 01 02 11 12 22"),
        ("PRIOR", 12, "real", "its inverse"),
        ("PRIOR_MEAN", 6, "real", "bias known before this window"),
        ("BIAS", 6, "real", "bias, rad Q24 a node"),
        ("SLOPE", 6, "real", "this pass' slope: what its bias was still wrong by"),
        ("HELD_NOISE", 6, "real", "noise energies held from earlier windows"),
        ("OMEGA", 6, "real", "noise energies of this window, then their weights"),
        ("T", 2, "real", "scratch"),
        ("T1", 2, "real", "scratch"),
        ("T2", 2, "real", "scratch"),
        ("T3", 2, "real", "scratch"),
        ("FRAME_FORCE_Q12", 3, "g", "force of the sample, scratch"),
        ("CENTRE", 9, "", "where the next traversal's regressors begin"),
        ("NOISE_ENERGY", 6, "real", "noise energies in use"),
        ("TEMP_SLOPES", 9, "packed", "an axis: slope over temperature, covariance, variance"),
        ("TEMP_Q8", 1, "LSB", "temperature in the middle of a window"),
        ("THEN_TEMP_Q8", 1, "LSB", "the same at the window before"),
        ("NOW_TEMP_Q8", 1, "LSB", "temperature now"),
        ("NODES_RING", "3 * NODES", "", "a node and axis: turn, rad Q13, above force, g Q12"),
    ),
    (
        Overlay(
            "HALF",
            "a sample is gathered",
            ("FRAME_ANGLE_Q24", 3, "rad", "turned in the sample"),
        ),
        Overlay(
            "R",
            "the algebra runs",
            ("G", 20, "real", "normal equations: 00 01 02 0y 11 12 1y 22 2y yy"),
        ),
        Overlay(
            "SUMS",
            "the first traversal has ended",
            ("TILT_FIT", 12, "", "first component's block up to SUM_Y"),
            ("TILT", 1, "rad Q12", "its mean: one tilt"),
            ("TILT_FIT_REST", 20, "", "up to the second component's SUM_Y"),
            ("OTHER_TILT", 1, "rad Q12", "the other tilt"),
        ),
        Overlay(
            "PRIOR",
            "what is known is carried to a window",
            ("BENT", 2, "real", "variance that a bend of the curve adds"),
        ),
        Overlay(
            "SLOPE",
            "the slope over temperature of an axis is at work",
            ("TEMP_SLOPE", 2, "real", "the slope"),
            ("TEMP_SLOPE_COVARIANCE", 2, "real", "its covariance with the bias"),
            ("TEMP_SLOPE_VARIANCE", 2, "real", "its variance"),
        ),
        Overlay(
            "T",
            "a node is added to the sums",
            ("M", 3, "", "a row of regressors"),
            ("WM", 3, "", "the same times the taper"),
        ),
        Overlay(
            "T",
            "a sample is gathered",
            ("CONING_Q24", 3, "rad", "half the cross product of turn and increment"),
            ("SCULLING_Q12", 3, "g", "what turning back to the node's start adds to the force"),
        ),
        Overlay(
            "T",
            "the tilt frame is found",
            ("LOOK", 4, "", "quaternion to be brought to length one"),
        ),
    ),
)

COMPONENT = Array(
    "The sums of one component",
    "a",
    "`_SUMS + i * _COMPONENT_WORDS`",
    "COMPONENT_WORDS",
    (
        ("SUM_MM", 6, "", "weighted M M': 00 01 02 11 12 22"),
        ("SUM_MY", 3, "", "weighted M y"),
        ("SUM_M", 3, "", "weighted M"),
        ("SUM_Y", 1, "", "weighted y, then its mean"),
        ("SHAPES_M", 6, "", "M times the second, then the third shape"),
        ("SHAPES_Y", 2, "", "y times both shapes"),
    ),
)

MOTION_SETTINGS = Array(
    "The settings of the source in motion",
    "c",
    "`Corrector.motion_settings`",
    "MOTION_SETTINGS_WORDS",
    (
        ("NODE_US", 1, "us", "a node"),
        ("MOTION_GAIN", 1, "", "from us to the factor of a rate"),
        ("MOTION_GAIN_SHIFT", 1, "bits", "its shift"),
        ("MOTION_SHIFT", 1, "bits", "shift of the product to rad Q24"),
        ("FORCE_GAIN", 1, "", "from LSB to g Q12, Q13"),
        ("VISITS", 1, "nodes", "of a traversal that a sample does"),
        ("MOTION_GAP_US", 1, "us", "a longer time between two samples ends the window"),
        ("LEAST_TRAFFIC", 1, "rad Q14", "a node: a window of less hardly moves"),
        ("NODES", 1, "nodes", "of the ring"),
        ("PASSES", 1, "", "most integrations of a window"),
        ("LSB_A_UNIT", 2, "real", "LSB Q8 of rad Q24 a node"),
        ("BIAS_WALK", 2, "real", "variance that the bias walks in a node"),
        ("START_VARIANCE", 2, "real", "of the bias before anything is known"),
        ("LONGEST", 1, "nodes", "the full window"),
        ("SHORTEST_STAGE", 1, "bits", "power of two of the first window"),
        ("LEAST_UP", 1, "g Q12", "mean force along the vertical: of less the window is lost"),
        ("PATIENCE", 1, "windows", "that contradict in a row are believed"),
        ("MOTION_DOCUMENT", 1, "", "1: the literal rules of US 10,451,438"),
        ("SLOPE_SPREAD", 1, "", "variance of a window's slope over its noise energy"),
        ("SETTLED", 1, "rad Q24", "a node: a slope below this needs no further pass"),
        ("TEMP_SLOPE_START", 2, "real", "variance of the slope over temperature, not yet known"),
        ("BEND", 1, "bits", "temperature over which it grows as much again"),
        ("LEAST_TILT", 1, "rad Q14", "a node: a slow window that tilts less teaches nothing"),
    ),
)

GRAVITY = Array(
    "The state of the source against gravity",
    "s",
    "`Corrector.gravity`",
    "GRAVITY_WORDS",
    (
        ("UNIT_ELAPSED_US", 1, "us", "of the sub-unit so far"),
        ("UNIT_N", 1, "samples", "in the sub-unit so far"),
        ("ANGLE_Q22", 3, "rad", "turned in the sub-unit"),
        ("ANGLE_SUM_Q13", 3, "rad", "sum of that over its samples"),
        ("FORCE_SUM", 3, "LSB", "sum of the forces, then their mean, g Q12"),
        ("LAST_ANGLE_Q13", 3, "rad", "mean angle of the sub-unit before"),
        ("LAST_PAIR_Q13", 3, "rad", "angle of its pair's force"),
        ("LAST_COUPLED_Q13", 3, "rad", "what the other axes turned its pair by"),
        ("LAST_GOOD", 1, "bits", "an axis: the sub-unit before may be compared"),
        ("UNIT_COUNT", 1, "sub-units", "of the interval so far"),
        ("COUNTER", 3, "", "signs of the deviations, added up"),
        ("COUNTED", 3, "sub-units", "that counted for the axis"),
        ("GRAVITY_BIAS_Q8", 3, "LSB", "bias found against gravity"),
        ("GRAVITY_QUALITY_Q8", 3, "LSB", "one sigma of it"),
        ("STEP_Q8", 3, "LSB", "by which it moves"),
        ("OBSERVED", 3, "sub-units", "in which gravity showed the axis"),
        ("SIGN", 3, "", "of the latest step"),
        ("SIGN_TURNS", 3, "", "how often it turned"),
        ("RIPPLE_Q8", 3, "LSB", "mean of the latest steps"),
        ("GRAVITY_REASON", 1, "code", "what the latest sub-unit was"),
        ("SKIPPED", 1, "sub-units", "without 1 g"),
        ("MEAN_ALONG_Q20", 3, "rad", "mean turn of the other axes about gravity"),
        ("SPREAD_Q21", 1, "rad", "mean size of the deviations"),
    ),
)

GRAVITY_SETTINGS = Array(
    "The settings of the source against gravity",
    "c",
    "`Corrector.gravity_settings`",
    "GRAVITY_SETTINGS_WORDS",
    (
        ("SUB_UNIT_US", 1, "us", "a sub-unit"),
        ("GRAVITY_GAIN", 1, "", "from us to the factor of a rate"),
        ("GRAVITY_GAIN_SHIFT", 1, "bits", "its shift"),
        ("GRAVITY_SHIFT", 1, "bits", "shift of the product to rad Q22"),
        ("UNITS", 1, "sub-units", "an interval"),
        ("THRESHOLD", 1, "", "what a counter must pass"),
        ("DEAD_Q13", 1, "rad", "a smaller deviation does not count"),
        ("COARSE_Q8", 1, "LSB", "first step"),
        ("FINE_Q8", 1, "LSB", "smallest step"),
        ("ONE_G_LSB", 1, "LSB", "1 g"),
        ("GRAVITY_GAP_US", 1, "us", "a longer time between two samples ends the sub-unit"),
        ("PUSH_Q2", 1, "", "LSB Q8 of a deviation that pushes one way, 0: the literal rules"),
    ),
)

EFFECTS = Array(
    "The effect model and its running state",
    "e",
    "`EffectModel.e`",
    "EFFECTS_WORDS",
    (
        ("SLOT_COUNT", 1, "", "slots in use, 0: no model"),
        ("INPUT_COUNT", 1, "", "inputs in use"),
        ("TICK_US", 1, "us", "a tick"),
        ("TICK_ELAPSED_US", 1, "us", "of the tick so far"),
        ("TICKS_DUE", 1, "ticks", "that slots are still to be computed for"),
        ("NEXT_SLOT", 1, "", "slot to compute next, plays behind the slots"),
        ("SLOTS_A_SAMPLE", 1, "", "slots and plays that a sample computes"),
        ("HALF_TICKS", 1, "", "middle of the tick, half ticks since power-on"),
        ("RUNNING", 1, "", "0 before the first sample, 1, 2 in the first tick, then 3"),
        ("INSTANT_SLOTS", 1, "", "slots that follow the sample itself"),
        ("SUM_Q14", 3, "LSB", "sum of the slots computed so far"),
        ("HELD_Q14", 3, "LSB", "sum of the tick before, held"),
        ("NOW_Q14", 3, "LSB", "the same with the sample's own slots"),
        ("PLAY_COUNT", 1, "", "play operators in use"),
        ("SLOW_Q8", 3, "LSB", "slow part of the acceleration"),
        ("SQUARES", 2, "LSB^2", "sum of the rest squared: low 15 bits, others"),
        ("SLOW_BEGUN", 1, "", "1 once the slow part has begun"),
        ("REFINE_ON", 1, "", "1: the coefficients go on learning"),
        ("BOUND_EIGHTHS", 1, "", "how far they may go, in eighths of the slot's largest"),
        ("SPARE_EFFECTS", 4, "", "unused"),
        ("INPUTS", 72, "", "12 blocks of an input"),
        ("CHANNELS", 8, "", "what the application last said of each"),
        ("SLOTS", 320, "", "8 blocks of a slot"),
        ("TABLES", 18, "Q24", "2 of 9 points"),
        ("RINGS", 132, "", "2 blocks of a delay"),
        ("REFINE_WORK", 1, "", "next piece of refinement, 0: none"),
        ("STATES", 1, "", "of the filter: offset, line, one a slot"),
        ("RATE_Q8", 3, "LSB", "of the still segment"),
        ("FIRST_TEMP", 1, "LSB", "of the first segment"),
        ("SEEN", 1, "segments", "since power-on"),
        ("SPARE_REFINE", 1, "", "unused"),
        ("REFINE_A", 2, "real", "scratch"),
        ("REFINE_B", 2, "real", "scratch"),
        ("INNOVATION", 2, "real", "variance of what the segment was expected to say"),
        ("MISS", 6, "real", "by how much each axis' rate missed it"),
        ("REGRESSORS", 20, "real", "what each state is multiplied by"),
        ("REFINE_GAIN", 20, "real", "covariance times regressors"),
        ("THETA", 60, "real", "the states of the three axes"),
        ("REFINE_P", 200, "real", "their covariance, by rows"),
        ("PLAYS", 90, "", "6 blocks of a play operator"),
    ),
)

INPUT = Array(
    "An input of the effect model",
    "a",
    "`_INPUTS + i * _INPUT_WORDS`",
    "INPUT_WORDS",
    (
        ("INPUT_KIND", 1, "code", "which source"),
        ("INPUT_SHIFT", 1, "bits", "by which its values are shifted right to fit 16 bits"),
        ("INPUT_OFFSET", 1, "", "taken from a channel first"),
        ("INPUT_SUM", 1, "", "over the tick"),
        ("INPUT_N", 1, "samples", "of the tick"),
        ("INPUT_VALUE_Q8", 1, "", "mean over the tick before"),
    ),
)

SLOT = Array(
    "An effect slot",
    "a",
    "`_SLOTS + i * _SLOT_WORDS`",
    "SLOT_WORDS",
    (
        ("SLOT_SOURCE", 1, "word", "its input's value"),
        ("SLOT_LOWEST_Q8", 1, "", "the source is held above"),
        ("SLOT_HIGHEST_Q8", 1, "", "and below"),
        ("SLOT_CENTRE_Q8", 1, "", "taken from it"),
        ("SLOT_SHIFT", 1, "bits", "left, to Q24"),
        ("SLOT_POWER", 1, "", "1..3"),
        ("SLOT_POWER_FIRST", 1, "", "1: before the memory"),
        ("SLOT_MEMORY", 1, "code", "lag, difference, rate, backlash, peak; 0: none"),
        ("SLOT_LAG", 2, "", "mantissa and shift of a tick's share of the way"),
        ("SLOT_HALF_WIDTH", 1, "Q24", "half the backlash"),
        ("SLOT_KNOT", 1, "Q24", "0 below it, or NO_VALUE"),
        ("SLOT_SECOND", 5, "", "second source: word (0: none), lowest, highest, centre, shift"),
        ("SLOT_DECAY", 2, "", "mantissa and shift of a tick's decay, 0: none"),
        ("SLOT_TABLE", 1, "word", "its table, 0: none"),
        ("SLOT_TABLE_FIRST", 1, "Q24", "the table's first point"),
        ("SLOT_TABLE_SCALE", 2, "", "mantissa and shift to its nine"),
        ("SLOT_COEFFICIENT_SHIFT", 1, "bits", "right, to LSB Q14"),
        ("SLOT_COEFFICIENT", 3, "", "mantissas, an axis each"),
        ("SLOT_RING", 1, "word", "its delay's ring, 0: none"),
        ("SLOT_DELAY", 1, "ticks", "of delay"),
        ("SLOT_RING_STEP", 1, "ticks", "from one kept to the next"),
        ("SLOT_OWN", 3, "", "the model's own coefficients"),
        ("SLOT_INSTANT", 1, "code", "what of the sample itself it follows, 0: nothing"),
        ("SLOT_STARTED", 1, "", "1 once its memory has begun"),
        ("SLOT_STATE", 2, "Q24", "memory, and what is below a unit of it"),
        ("SLOT_DECAYED", 2, "Q24", "what is left of the decay, and below a unit"),
        ("SLOT_VALUE", 1, "Q24", "what the coefficients are multiplied by"),
    ),
)

PLAY = Array(
    "A play operator",
    "a",
    "`_PLAYS + i * _PLAY_WORDS`",
    "PLAY_WORDS",
    (
        ("PLAY_SOURCE", 5, "", "as a slot's source: word, lowest, highest, centre, shift"),
        ("PLAY_RADIUS", 1, "Q24", "how far behind its source it stays"),
        ("PLAY_SHIFT", 1, "bits", "of its coefficients right, to LSB Q14"),
        ("PLAY_COEFFICIENT", 3, "", "mantissas, an axis each, of where it stands"),
        ("PLAY_OF_SQUARE", 3, "", "mantissas, an axis each, of the square of that"),
        ("PLAY_STARTED", 1, "", "1 once it stands somewhere"),
        ("PLAY_STATE", 1, "Q24", "where it stands"),
    ),
)

RING = Array(
    "A delay's ring",
    "ring",
    "`_RINGS + i * _RING_WORDS`",
    "RING_WORDS",
    (
        ("RING_NEWEST", 1, "", "place of the newest value"),
        ("RING_AGE", 1, "ticks", "since it was kept"),
        ("RING_KEPT", 64, "Q24", "values"),
    ),
)

ARRAYS = (
    STATE,
    TURN_ON,
    AXIS,
    ESTIMATOR,
    SETTINGS,
    MOTION,
    COMPONENT,
    MOTION_SETTINGS,
    GRAVITY,
    GRAVITY_SETTINGS,
    EFFECTS,
    INPUT,
    SLOT,
    PLAY,
    RING,
)

GUARD = Codes(
    "What the guard says of a frame",
    "guard",
    GOOD=0,
    REPEAT=1,
    RAIL=2,
    ALL_ZERO=3,
    ALL_ONES=4,
    TEMPERATURE_JUMP=5,
    TIME_STOOD_STILL=6,
    TIME_LEAPT=7,
)
STILLNESS = Codes(
    "What a window was",
    "",
    UNKNOWN=0,
    STILL=1,
    MOVING=2,
    TURNING=3,
    SHAKEN=4,
    SHIFTED=5,
)
SOURCE = Codes(
    "Where a bias comes from",
    "bias",
    NONE=0,
    ANY_TEMPERATURE=1,
    FIT=2,
    HERE=3,
    IN_MOTION=4,
    GRAVITY=5,
)
JOB = Codes("What the source in motion is doing", "", IDLE=0, TRAVERSE=1, SOLVE=2)
MOTION_REASON = Codes(
    "What a window in motion taught",
    "",
    NO_WINDOW=0,
    GROWING=1,
    LEARNED=2,
    HARDLY_MOVES=3,
    TURNED=4,
    TOO_FAST=5,
    LOST=6,
    MOTION_GAP=7,
)
GRAVITY_REASON = Codes(
    "What a sub-unit against gravity was",
    "",
    NO_SUB_UNIT=0,
    COUNTING=1,
    NOT_ONE_G=2,
    GRAVITY_GAP=3,
)
INPUT_KIND = Codes(
    "Sources of effects: an acceleration, the temperature, a mean rate, ..., a channel",
    "",
    KIND_ACCEL=0,
    KIND_TEMP=3,
    KIND_RATE=4,
    KIND_VIBRATION=7,
    KIND_TIME=8,
    KIND_ONE=9,
    KIND_INSTANT=10,
    KIND_CHANNEL=16,
)
MEMORY = Codes(
    "An effect slot's memory",
    "",
    MEMORY_LAG=1,
    MEMORY_DIFFERENCE=2,
    MEMORY_RATE=3,
    MEMORY_BACKLASH=4,
    MEMORY_PEAK=5,
)
INSTANT = Codes("What of the sample itself a slot follows", "", OF_RATE=1, OF_ACCELERATION=2)
MARKS = Codes(
    "Values that stand for none",
    "",
    FREE=-1048576,  # temperature of a free estimator
    NO_VALUE=-0x3FFFFFFF,  # of an input that nothing was heard of, of a slot without a knot
    UNKNOWN_Q8=0x1FFFFFFF,  # one sigma of a bias that is not known
)
LIMITS = Codes(
    "How many of each an effect model has at most",
    "",
    MOST_SLOTS=8,
    MOST_INPUTS=12,
    MOST_CHANNELS=8,
    MOST_PLAYS=6,
    MOST_TABLES=2,
    MOST_RINGS=2,
    TABLE_POINTS=9,
)

CODES = (
    GUARD,
    STILLNESS,
    SOURCE,
    JOB,
    MOTION_REASON,
    GRAVITY_REASON,
    INPUT_KIND,
    MEMORY,
    INSTANT,
    MARKS,
    LIMITS,
)


def axis_at(settings, axis):
    """Return the first word of an axis of the corrector's state."""
    return settings[SETTINGS.AXES] + axis * settings[SETTINGS.AXIS_WORDS]


def slot_at(slot):
    """Return the first word of an effect slot."""
    return EFFECTS.SLOTS + slot * SLOT.size


def names():
    """Return all names as a dict: name -> (number, title of what it belongs to)."""
    found = {}
    for array in ARRAYS:
        for word in array.words:
            found[word.name] = (word.index, array.title)
        if array.size_name:
            found[array.size_name] = (array.size, array.title)
    for codes in CODES:
        for name in codes.numbers:
            found[name] = (codes.numbers[name], codes.title)
    return found
