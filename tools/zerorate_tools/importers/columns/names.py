"""What columns are usually called: `gyro_x`, `imu.gyro.x`, `AngVelX`, `GyroX [deg/s]`, `wx`."""

import os
import re
import unicodedata

from .units import RAW, unit_in_name, without_unit

_AXIS = "([xyz])"
#: After the axis: calibrated or not, or a mean of many readings; of registers, OUT.
_MADE = "(?:cal|raw|mean|avg|out)?"
#: A sensor's number, or its part: gx1, accelerometer_lsm6ds3.x.
_NUMBER = r"\d?"
_CHIP = r"(?:(?:bm[agi]|i[ai]m|icm|lis|lsm|mpu)\d[a-z0-9]*?)?"
_GYRO = re.compile(
    r"(?:.*(?:gyroscope|giroscopio|gyrorotation|g[iy]ro|gyr|angularvelocity|ang(?:le|ular)?rate|angl?vel|rot(?:ation)?rate|omega|angular)"
    rf"\d?{_CHIP}(?:uncalibrated|uncalib|uncal|calibrated|corrected|unfilt|adc|raw|rad|data|rate|dps|dof|values?|v"
    r"|static|noise|sensor){0,2}"
    r"|(?:.*imu\d*|raw)?(?:gy|[wg]|wb|pqr|absr|rate|dps))"
    + f"{_AXIS}{_MADE}{_NUMBER}$|^{_AXIS}(?:gyroscope|gyro|gyr|rate){_MADE}$"
)
_ACCEL = re.compile(
    r"(?:.*(?:accelerometer|acc?elerometr[eo]|acceleration|accel|acce|accl|acc|acel|specificforce|gforce)"
    rf"\d?{_CHIP}(?:uncalibrated|uncal|calibrated|smooth|adc|raw|data|dof|ms2|m?g|values?|v|vector|ln|wr|static"
    r"|noise|sensor|includinggravity){0,2}"
    r"|(?:.*imu\d*|raw)?(?:ac?|gf|fb?|abs))"
    + f"{_AXIS}{_MADE}{_NUMBER}$|^{_AXIS}(?:accelerometer|accel|accl|acc){_MADE}$"
)
#: Whose axis stands before a part of a body, say: GyroX_left_leg.
_GYRO_OF = re.compile(
    rf".*(?:gyroscope|gyro|gyr|angvel|angularvelocity|angularrate){_AXIS}[a-z0-9]*$"
)
_ACCEL_OF = re.compile(rf".*(?:accelerometer|acceleration|accel|acce|accl|acc){_AXIS}[a-z0-9]*$")
#: Less gravity, or gravity as a filter has it: no measure of it.
_FREE = re.compile(r".*(?:freeacc|useracc|linacc|(?<!including)gravity)|lacc")
_OTHER_SENSOR = re.compile("acc|linear|mag|euler|quat|orient|heading|grav|baro|gps|location", re.I)
#: How sure numbers are, or what somebody takes away: no readings.
_SPREAD = re.compile(r".*(?:covariance|variance|std|sigma|m(?:in|ax)$|bias(?:dps|rads)?[xyz0-9]*$)")
#: As the sensor has it, and less a bias that somebody took away; motionRotation is CoreMotion's.
_RAW = re.compile(r".*(?:raw|uncal|uncomp|unfilt)")
_CORRECTED = re.compile(r".*(?:corrected|compensated|calibrated|unbiased|filtered|motionrotation)")
_TEMP = re.compile(r".*(?:temperature|temp|tmp)c?(?:mean|avg)?$")
_NOT_THE_DIE = re.compile(
    r"ambient|air|baro|bmp|bme|aht|sht|cpu|processor|environment|motor|batt|esc|water|room"
)
_THE_DIE = re.compile("gyr|imu")
#: A temperature, or a time where there is no other.
_CAPITAL_T = re.compile("T(?![A-Za-z])")
_TIME = re.compile(
    r"(?:t|ts|times?|timestamps?|timestampsample|now|stamp|.*time[mun]s|secondselapsed|datetime|"
    r"date|utc|milli(?:s|seconds)|micro(?:s|seconds)|loggingtime|.*timestamp(?:unix|sincereboot)?(?:cal)?|.*headerstamp|sampletime|"
    r"gpst|gpstime|(?:gps)?tow|(?:sys(?:tem)?|unix|utc|host|local|device|u)time|timeofweek|elapsed|elapsedtime|epoch?|.*offsettime|timestartup|timesincestart(?:in)?|rtctime|"
    r"(?:sys|gyro|imu)ts)$"
)
#: Of one sensor's rows: acc_time, t_gyro.
_OF_ONE = re.compile("time(?:stamp)?$|^t(?:acc|gyr)")
_CLOCK = re.compile("time|tow|tick|clock|clk|cycle|stamp|elapsed|epoch|secs?$|seconds?$")
_STEP = re.compile("(?:d|delta)t(?:ime)?|timestep|(?:sampl(?:e|ing))?(?:interval|period)")
_SEC = re.compile(r"(.*?)(nano|micro|milli|[num])?(?:secs?|seconds?)$")
#: A column of a variable of a .mat.
_ARRAY = re.compile(r"\[\d+\]$")
_LAST_AXIS = re.compile(f".*{_AXIS}(?:axis)?$")
_ANY_AXIS = re.compile(f".*{_AXIS}$|{_AXIS}.+$")
#: Of an array that is called by all its axes, or by nothing, too.
_BARE = re.compile(f"(?:xyz|values?)?{_AXIS}(?:axis)?$")
#: Of a quaternion; BNO08x's are called i j k real.
_PART = re.compile("(.*?)(real|[wxyzijk])$")
_PARTS = {"real": "w", "i": "x", "j": "y", "k": "z"}
#: What aircraft call their rates.
BODY_RATES = dict(zip(("gx", "gy", "gz"), "pqr"))
_TURNS = {"roll": "x", "pitch": "y", "yaw": "z"}
_TURN_RATE = re.compile("(roll|pitch|yaw)(?:rate|velocity)|(?<=gyro|rate)(roll|pitch|yaw)$")
#: What browsers call theirs.
_BROWSERS = dict(zip(("gx", "gy", "gz"), ("beta", "gamma", "alpha")))


def spelled(name: str) -> str:
    """A name without its unit, case, accents and marks; [0] [1] [2] at its end are x y z."""
    text = re.sub(r"\[([012])\]", lambda m: "xyz"[int(m[1])], name.strip().lower())
    return re.sub(r"[\W_]", "", unicodedata.normalize("NFKD", without_unit(text)))


def gyro_groups(names: list[str]) -> list[dict[str, str]]:
    """Columns that go together as rates: {gx, gy, gz: name} of each sensor that is in the table.

    By name; where no name tells, by a unit of rates and an axis, as w_RS_S_x [rad s^-1] of EuRoC.
    Those come first that are called raw, those last from which somebody took a bias away.
    """
    names = _of_three(names)
    groups = _groups(names, _GYRO, "g") or _groups(_in_units_of("gx", names), _LAST_AXIS, "g")
    groups = groups or _groups(names, _GYRO_OF, "g")
    texts = [spelled(group["gx"]) for group in groups]
    order = [0 if _RAW.match(text) else 2 if _CORRECTED.match(text) else 1 for text in texts]
    return [group for _, group in sorted(zip(order, groups), key=lambda both: both[0])]


def accel_groups(names: list[str]) -> list[dict[str, str]]:
    """Columns that go together as acceleration with gravity in it: {ax, ay, az: name}."""
    every = {spelled(name) for name in names}
    names = [
        name
        for name, text in zip(names, map(spelled, names))
        if not _FREE.match(text) or text.startswith("l") and f"r{text[1:]}" in every  # on the left
    ]
    names = _of_three(names)
    groups = _groups(names, _ACCEL, "a") or _groups(_in_units_of("ax", names), _LAST_AXIS, "a")
    return groups or _groups(names, _ACCEL_OF, "a")


def most_alike(groups: list[dict[str, str]], gyro: dict[str, str], instance: int) -> dict[str, str]:
    """The acceleration whose names are most like those of the rates; empty where there is none."""
    if not groups:
        return {}

    def alike(number: int) -> tuple[float, int, bool, int]:
        two = groups[number]["ax"], gyro.get("gx", "")
        ours, theirs = (set(re.split(r"[^a-z0-9]+", without_unit(name.lower()))) for name in two)
        begun = len(os.path.commonprefix(two))
        numbers = [re.findall(r"\d", name) for name in two]
        same = numbers[0] == numbers[1] if any(numbers) else number == instance
        return len(ours & theirs) / len(ours | theirs), begun, same, -number

    return groups[max(range(len(groups)), key=alike)]


def bare_axes(names: list[str]) -> dict[str, str]:
    """Columns that are called by their axis alone (x, xaxis), or p q r, or as browsers call rates;
    beside a w they are a quaternion's, and behind another sensor's name that one's."""
    names = [name for name in names if not of_other_sensor(name.rpartition(".")[0])]
    by_letter = {name.rpartition(".")[2].lower(): name for name in names}
    for called in (BODY_RATES, _BROWSERS):
        if all(letter in by_letter for letter in called.values()):
            return {target: by_letter[letter] for target, letter in called.items()}
    return {} if "w" in by_letter else next(iter(_groups(names, _BARE, "g")), {})


def axes_apart(names: list[str]) -> list[dict[str, str]]:
    """Columns that go together by their axis alone, whatever they are called: {gx, gy, gz: name}.
    A quaternion's, those of another sensor's name, and turns and speeds are none."""
    parts = {name for group in attitudes(names) for name in group.values()}
    names = [n for n in _of_three(names) if n not in parts and not of_other_sensor(n)]
    names = [n for n in names if not re.search("delta|angle|pos|vel", n.lower())]
    return _groups(names, _ANY_AXIS, "g")


def of_other_sensor(name: str) -> bool:
    """Whether a name is that of a sensor other than a gyroscope."""
    return bool(_OTHER_SENSOR.search(name)) and "gyro" not in name.lower()


def attitudes(names: list[str]) -> list[dict[str, str]]:
    """Columns that go together as a quaternion's parts by their last letter: {qw, qx, qy, qz}."""
    groups: dict[str, dict[str, str]] = {}
    for name in names:
        found = _PART.match(spelled(name))
        if found:
            groups.setdefault(found[1], {}).setdefault("q" + _PARTS.get(found[2], found[2]), name)
    return [group for group in groups.values() if len(group) == 4]


def temperature(names: list[str]) -> str | None:
    """The column that looks like the sensor's own temperature."""
    found = [name for name in names if _TEMP.match(spelled(name))]
    found += [name for name in names if unit_in_name("temp", name) == "degc"]
    found = [name for name in found if not _NOT_THE_DIE.search(spelled(name))]
    return min(found, key=lambda name: not _THE_DIE.search(spelled(name)), default=None)


def other_temperatures(names: list[str]) -> list[str]:
    """Columns of temperatures that are not called as the sensor's own is, the likelier ones first;
    none where one is."""
    if temperature(names):
        return []
    found = [n for n in names if re.search("temp|tmp", spelled(n)) or _CAPITAL_T.match(n)]
    found = [name for name in found if not unit_in_name("t_us", name)]
    return sorted(found, key=lambda name: bool(_NOT_THE_DIE.search(spelled(name))))


def time_columns(names: list[str]) -> list[str]:
    """The columns that look like time stamps; T (°C) is none."""
    found = [name for name in names if _TIME.match(spelled(name))]
    return [name for name in found if unit_in_name("temp", name) in (None, RAW)]


def clocks(names: list[str]) -> list[str]:
    """The columns that look like the time of anything: acc_time, and X[s].1, which comes twice."""
    own = {name: re.sub(r"\.\d+$", "", name) for name in names}
    found = {*time_columns([*own.values()]), *in_units_of_time([*own.values()])}
    return [n for n, of in own.items() if of in found or _OF_ONE.search(spelled(of))]


def is_step(name: str) -> bool:
    """Whether a column is called as the time since the row before."""
    return bool(_STEP.fullmatch(spelled(name)))


def is_clock(name: str) -> bool:
    """Whether a column is called as a time, or as a count of something's ticks."""
    return bool(_CLOCK.search(spelled(name)))


def in_units_of_time(names: list[str]) -> list[str]:
    """Columns whose name says a unit of time, whatever it is in: `Zeit (s)`."""
    return [name for name in names if unit_in_name("t_us", name)]


def split_times(names: list[str]) -> list[tuple[str, str, str]]:
    """Columns of seconds, those of a smaller unit beside them, and that unit, as ROS and C have a
    stamp; microseconds alone go with any time."""
    by_stem: dict[str, dict[str, str]] = {}
    for name in names:
        if found := _SEC.match(re.sub(r"[^a-z]", "", name.lower())):
            unit = {"nano": "ns", "micro": "us", "milli": "ms"}.get(found[2], f"{found[2] or ''}s")
            by_stem.setdefault(found[1], {})[unit] = name
    for time in time_columns(names):
        if time not in by_stem.get("", {}).values():
            by_stem.setdefault("", {}).setdefault("s", time)
    pairs = [(held, unit) for held in by_stem.values() for unit in ("ns", "us", "ms")]
    return [(held["s"], held[unit], unit) for held, unit in pairs if {"s", unit} <= held.keys()]


def of_other_unit(name: str) -> bool:
    """Whether a name ends with a unit in brackets that is none of rates: X (m/s^2), Y (µT)."""
    has_unit = name.rstrip()[-1:] in (")", "]") and not _ARRAY.search(name)
    return has_unit and unit_in_name("gx", name) is None


def unnamed(names: list[str]) -> bool:
    """Whether no name tells anything: numbers, or all the columns of a .mat's only variable."""
    numbered = names == [str(number) for number in range(1, len(names) + 1)]
    variables = {_ARRAY.sub("", name) for name in names}
    return numbered or len(names) not in (1, 3) and len(variables) == 1


def _of_three(names: list[str]) -> list[str]:
    """Names without those of a variable of more than three columns, whose [0] is no x, and without
    covariances."""
    names = [name for name in names if not _SPREAD.match(spelled(name))]
    wide = {_ARRAY.sub("", name) for name in names if name.endswith("[3]")}
    return [name for name in names if _ARRAY.sub("", name) not in wide or "[" not in name]


def _with_letter(text: str, every: set[str]) -> str:
    """A name whose axis is 0, 1 or 2 at its end, as VectorNav's, or 1, 2 or 3, as of a variable of
    MATLAB's, with x, y or z there."""
    stem, digit = text[:-1], text[-1:]
    from_one = {f"{stem}{n}" for n in range(5)} & every == {f"{stem}{n}" for n in (1, 2, 3)}
    at = ("123" if from_one else "012").find(digit)
    return f"{stem}{'xyz'[at]}" if stem and at >= 0 else text


def _in_units_of(target: str, names: list[str]) -> list[str]:
    """Columns whose name says a physical unit of that kind."""
    return [name for name in names if unit_in_name(target, name) not in (None, RAW)]


def _groups(names: list[str], pattern: re.Pattern[str], letter: str) -> list[dict[str, str]]:
    groups: dict[str, dict[str, str]] = {}
    every = {spelled(name) for name in names if re.search("_[1-4]$", name)}
    for name in names:
        text = _TURN_RATE.sub(lambda turn: "gyro" + _TURNS[turn[1] or turn[2]], spelled(name))
        text = _TURNS.get(text, text) if pattern is _LAST_AXIS else text
        before, _, last = name.rpartition(".")
        match = pattern.match(text) or pattern.match(_with_letter(text, every))
        match = match or pattern.match(spelled(last))
        if match and match.lastindex:
            at, axis = match.start(match.lastindex), match[match.lastindex]
            others = match.string[:at] + match.string[at + 1 :]
            whose = "" if match.string != spelled(last) else before
            groups.setdefault(whose + others, {}).setdefault(f"{letter}{axis}", name)
    return [group for group in groups.values() if len(group) == 3]
