"""model.bin: bytes of a model and back, to the last bit (firmware: effects/model_file.py)."""

import struct
import zlib
from collections.abc import Callable, Container, Sequence
from dataclasses import replace
from itertools import accumulate
from os import PathLike
from typing import Any

from ..errors import BadModel
from ..layout import INPUT_KIND, LIMITS
from ..recordings import Scales
from .model import KINDS, Binding, CannotDeploy, Input, Model, Slot, is_channel, sources_of
from .plays import label_of, slots_of_play, split, words_of_play
from .slot_reading import slot_of
from .slot_words import Unit, inputs_for, words_of

VERSION, VERSION_WITH_PLAYS = 1, 2
_HEAD = struct.Struct("<3sBHBBBBBx4BI5d")
_INPUT, _SLOT, _TABLE = struct.Struct("<3i"), struct.Struct("<30i"), struct.Struct("<9i")
_PLAY = struct.Struct("<13i")
#: The code of what is not known.
ANY = 255
_Q24 = 1 << 24


def build_model(
    slots: Sequence[Slot], scales: Scales, *, binding: Binding | None = None, tick_s: float = 1.0
) -> Model:
    """The model that the firmware will run: every number as its integers hold it.

    Raises CannotDeploy for what does not fit its slots.
    """
    try:
        return decoded(encoded(drafted(slots, scales, binding=binding, tick_s=tick_s)))
    except BadModel as error:  # two of its numbers are one when rounded, or are none
        raise CannotDeploy(f"rounded it is no model: {error.__cause__ or error}") from error


def drafted(
    slots: Sequence[Slot], scales: Scales, *, binding: Binding | None = None, tick_s: float = 1.0
) -> Model:
    """The model with its numbers as they are given: `encoded` rounds them."""
    model = Model(tuple(slots), scales, binding or Binding(), round(tick_s * 1e6))
    return replace(model, inputs=inputs_for(model.slots, scales, model.tick_s))


def encoded(model: Model) -> bytes:
    """The bytes of model.bin. Raises CannotDeploy."""
    plain, plays = split(model.slots)
    _check_room(model, plain, len(plays))
    places = {(i.name, i.of_the_sample): at for at, i in enumerate(model.inputs)}
    channels = model.channels
    body = [_INPUT.pack(_kind(i, channels), i.shift, i.offset) for i in model.inputs]
    tables: list[tuple[float, ...]] = []
    rings = 0
    unit_of = _units(model)
    for slot in plain:
        index = {name: places[_there(name, now, places)] for name, now in slot.sources()}
        if slot.term.table:
            tables.append(slot.term.table)
        own = (
            len(tables) - 1 if slot.term.table else -1,
            rings if slot.has_delay(model.tick_s) else -1,
        )
        rings += own[1] >= 0
        body.append(_SLOT.pack(*words_of(slot, unit_of, index.__getitem__, model.tick_s, *own)))
    body += [_TABLE.pack(*(round(v * _Q24) for v in table)) for table in tables]
    for pair in plays:
        body.append(_PLAY.pack(*words_of_play(pair, unit_of, lambda name: places[name, False])))
    said = [*(s.effect for s in plain), *(label_of(p) for p in plays)]
    body += [_text(t) for t in (model.scales.sensor, *channels, *said)]
    body_bytes = b"".join(body)
    size = _HEAD.size + len(body_bytes) + 4
    head = _HEAD.pack(
        *(b"ZRM", VERSION_WITH_PLAYS if plays else VERSION, size, len(plain), len(model.inputs)),
        *(len(tables), len(channels), len(plays)),
        *codes_of(model.binding),
        model.tick_us,
        *_doubles(model.scales),
    )
    return head + body_bytes + struct.pack("<I", zlib.crc32(head + body_bytes))


def decoded(data: bytes, path: str | PathLike[str] = "model.bin") -> Model:
    """The model in the bytes of model.bin. Raises BadModel, which names `path`."""
    head = _checked_head(data, path)
    try:
        return _decoded_body(data, head)
    except (CannotDeploy, struct.error, ValueError, IndexError, KeyError, ArithmeticError) as error:
        problem = f"holds what no model holds ({error})"
        raise BadModel(path, problem, do="write it again with `zerorate close`") from error


def _checked_head(data: bytes, path: str | PathLike[str]) -> tuple[Any, ...]:
    if data[:3] != b"ZRM":
        raise BadModel(path, "is no effect model", do="name a model.bin or model.json")
    if len(data) > 3 and data[3] not in (VERSION, VERSION_WITH_PLAYS):
        problem = f"is of version {data[3]}; this tool reads up to {VERSION_WITH_PLAYS}"
        raise BadModel(path, problem, do="write it again with this zerorate")
    if len(data) < _HEAD.size + 4 or len(data) < _HEAD.unpack_from(data)[2]:
        raise BadModel(path, f"is cut short at byte {len(data)}", do="copy it again")
    (crc,) = struct.unpack("<I", data[-4:])
    head = _HEAD.unpack_from(data)
    if crc != zlib.crc32(data[:-4]) or len(data) != head[2]:
        raise BadModel(path, "is damaged: its checksum differs", do="copy it again")
    return head


def _decoded_body(data: bytes, head: tuple[Any, ...]) -> Model:
    n_slots, n_inputs, n_tables, n_channels, n_plays = head[3:8]
    forms = (_INPUT, n_inputs), (_SLOT, n_slots), (_TABLE, n_tables), (_PLAY, n_plays)
    ends = [*accumulate((form.size * number for form, number in forms), initial=_HEAD.size)]
    raw_inputs, rows, tables, plays = (
        [*form.iter_unpack(data[a:b])] for (form, _), a, b in zip(forms, ends, ends[1:])
    )
    texts = _texts(data, ends[-1])
    sensor, channels, effects = texts[0], texts[1 : 1 + n_channels], texts[1 + n_channels :]
    inputs = tuple(_input(raw, channels) for raw in raw_inputs)
    scales = _scales(sensor, head[13:18])
    model = Model((), scales, Binding(*(None if c == ANY else c for c in head[8:12])), head[12])
    model = replace(model, inputs=inputs)
    slots = []
    for row, effect in zip(rows, effects[:n_slots], strict=True):
        table = [v / _Q24 for v in tables[row[19]]] if row[19] >= 0 else None
        slot = slot_of(row, lambda i: inputs[i].name, _units(model), model.tick_s, table)
        term = replace(slot.term, table=_short_table(table))
        slots.append(replace(slot, effect=effect, term=term))
    for row, effect in zip(plays, effects[n_slots:], strict=True):
        slots += slots_of_play(row, inputs[row[0]].name, _units(model), effect)
    whole = replace(model, slots=tuple(slots))
    if encoded(whole) != data:
        raise CannotDeploy("its numbers do not belong together")
    return whole


def _short_table(table: Sequence[float] | None) -> tuple[float, ...] | None:
    if table is None:
        return None
    return tuple(
        next(s for d in range(1, 18) if round((s := float(f"{v:.{d}g}")) * _Q24) == v * _Q24)
        for v in table
    )


def _units(model: Model) -> Callable[[str], Unit]:
    inputs = {i.name: i for i in model.inputs}
    return lambda name: Unit(inputs.get(name, Input(name)), model.scales, model.tick_s)


def _check_room(model: Model, plain: Sequence[Slot], plays: int) -> None:
    if not 10_000 <= model.tick_us < 1 << 29:
        raise CannotDeploy(f"a tick of {model.tick_s:g} s; 0.01..536 s are possible")
    tables = [s.term.table for s in model.slots if s.term.table]
    for what, number, most in (
        ("effect slots", len(plain), LIMITS.MOST_SLOTS),
        ("play operators", plays, LIMITS.MOST_PLAYS),
        ("sources", len(model.inputs), LIMITS.MOST_INPUTS),
        ("tables", len(tables), LIMITS.MOST_TABLES),
        ("delays", sum(s.has_delay(model.tick_s) for s in model.slots), LIMITS.MOST_RINGS),
        ("extra channels", len(model.channels), LIMITS.MOST_CHANNELS),
    ):
        if number > most:
            raise CannotDeploy(f"the firmware has room for {most} {what}, the model needs {number}")
    for table in tables:
        if len(table) != LIMITS.TABLE_POINTS or any(not abs(v) <= 1 for v in table):
            raise CannotDeploy(f"a table has {LIMITS.TABLE_POINTS} values within -1..1")
    there = {(i.name, i.of_the_sample) for i in model.inputs}
    if {_there(*source, there) for source in sources_of(model.slots)} - there:
        raise CannotDeploy("a slot follows a source that is no input of the model")


def _there(name: str, of_the_sample: bool, among: Container[tuple[str, bool]]) -> tuple[str, bool]:
    """The input for a source: a model of before accelerations were of the sample has the tick's."""
    return name, of_the_sample and (name, True) in among


def _kind(source: Input, channels: Sequence[str]) -> int:
    now = source.of_the_sample
    if is_channel(source.name):
        first = INPUT_KIND.KIND_CHANNEL_NOW if now else INPUT_KIND.KIND_CHANNEL
        return first + list(channels).index(source.name)
    return KINDS.index(source.name, INPUT_KIND.KIND_INSTANT if now else 0)


def _input(raw: Sequence[int], channels: Sequence[str]) -> Input:
    kind, shift, offset = raw
    if kind >= INPUT_KIND.KIND_CHANNEL:
        now, at = divmod(kind - INPUT_KIND.KIND_CHANNEL, LIMITS.MOST_CHANNELS)
        return Input(channels[at], bool(now), shift, offset)
    return Input(KINDS[kind], kind >= INPUT_KIND.KIND_INSTANT, shift, offset)


def codes_of(binding: Binding) -> bytes:
    """The four codes as a file and a device hold them."""
    return bytes(ANY if code is None else code for code in vars(binding).values())


def _doubles(scales: Scales) -> tuple[float, ...]:
    values = (scales.accel_lsb_per_g, scales.temp_lsb_per_degc, scales.temp_offset_degc)
    return scales.gyro_lsb_per_dps, *(v or 0.0 for v in values), scales.odr_hz


def _scales(sensor: str, doubles: Sequence[float]) -> Scales:
    gyro, accel, temp, offset, odr_hz = doubles
    return Scales(sensor, odr_hz, gyro, accel or None, temp or None, offset if temp else None)


def _text(text: str) -> bytes:
    data = text.encode()
    if len(data) > 63:
        raise CannotDeploy(f"the name {text!r} is longer than 63 bytes")
    return bytes([len(data)]) + data


def _texts(data: bytes, at: int) -> list[str]:
    found = []
    while at < len(data) - 4:
        end = at + 1 + data[at]
        found.append(data[at + 1 : end].decode())
        at = end
    return found
