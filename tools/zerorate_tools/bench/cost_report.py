"""The figures of `zerorate bench cost` as tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from .limits import COST, limits_table, verdicts
from .tables import machine_line, number, table

_MADE = """\
Made by `zerorate bench cost`, which also writes `--json FILE`. Counts of instructions and bytes are
the same on every machine; times and what follows from them are this machine's, in time of the
processor, so that they may be measured while others use it.
"""
_HOW = """\
Instructions are counted by callgrind on the x86 interpreter and time is measured under qemu-arm,
each as the difference of two lengths, over one minute of a simulated warm-up with rests and motion:
guard, stillness, histograms, estimators and correction of three axes. The C version is made from
the same kernels, compiled with -O2 for the same machine, and ends in the same state to the last
bit; so do bytecode and viper, else nothing is compared. Effects are off, as after `Corrector()`.
In bursts is `Bursts.update` with 64 samples of a FIFO a call, alone is `Corrector.update`,
of whose instructions some 2,900 are the calls into the method and from there into viper. The worst
sample is one of `Corrector.update`, refit and eviction included.
"""
_REPLAY = """\
Seconds are the processor's, all threads together, the fewest of three runs; memory is the most that
the process ever held. Parquet in and Parquet out, each sample's bias, source and quality written.
"""


def in_markdown(found: Mapping[str, Any]) -> str:
    """The tables of `cost`."""
    limits = limits_table(verdicts(found, COST))
    return "\n".join(["# Cost\n", _MADE, machine_line(found["machine"]), limits, *sections(found)])


def sections(found: Mapping[str, Any]) -> Iterator[str]:
    """The tables of a sample, of memory and of the replay, one below the other."""
    yield "## A sample\n"
    yield _HOW
    yield table(["three axes", "bytecode", "viper", "C -O2"], list(_per_sample(found)))
    yield from _why(found)
    yield "## Memory\n"
    yield table(["what", "bytes"], list(_memory(found)))
    yield "## Replay on one core\n"
    yield _REPLAY
    yield table(["at 100 Hz", "samples/s", "kernels alone", "peak MB"], list(_replay(found)))
    for name, why in found["left_out"].items():
        yield f"Left out: {name}: {why}.\n"


def _per_sample(found: Mapping[str, Any]) -> Iterator[list[str]]:
    for name, how in (
        ("instructions_per_sample", "in bursts"),
        ("instructions_per_update", "alone"),
    ):
        if counts := found.get(name):
            yield [f"instructions, x86, {how}", *(f"{counts[kind]:,.0f}" for kind in counts)]
            yield ["against C", *(f"{count / counts['c']:.1f} x" for count in counts.values())]
    if inside := found["viper_machine_code_per_sample"]:
        yield ["in bursts, in viper's machine code itself", "", f"{inside:,.0f}", ""]
    if spent := found["armhf_seconds_per_sample"]:
        ratios = [f"{seconds / spent['c']:.1f} x" for seconds in spent.values()]
        yield ["time under qemu-arm, against C", *ratios]
    if worst := found["worst_sample"]:
        yield ["worst sample against the median, x86", "", f"{worst['ratio']:.1f} x", ""]


def _why(found: Mapping[str, Any]) -> Iterator[str]:
    """What the profile says where viper misses its bound against C."""
    counts, inside = found["instructions_per_sample"], found["viper_machine_code_per_sample"]
    if not counts or not inside or counts["viper"] <= COST[0].bound * counts["c"]:
        return
    share = inside / counts["viper"]
    yield (
        f"Why viper misses its bound: {share:.0%} of its instructions are machine code of the\n"
        f"kernels, {inside / counts['c']:.1f} times C's, as MicroPython compiles each expression\n"
        f"by itself and keeps three variables in registers; the other {1 - share:.0%} are the\n"
        "interpreter's: some 300 to call a kernel, 130 for each number or array that it takes.\n"
        "One function cannot hold all kernels: MicroPython 1.25 refuses a jump of more than 2 KB\n"
        "for ARMv6-M and encodes it wrongly for Xtensa. Tried and kept: called kernels written\n"
        "out in their callers as far as jumps reach, short loops unrolled, constants folded,\n"
        "words addressed by pointers, what is used most in registers, a burst of a FIFO in one\n"
        "call with its windows' edges, and methods that are viper themselves. What makes the\n"
        "kernels cheaper makes C cheaper, too.\n"
    )


def _memory(found: Mapping[str, Any]) -> Iterator[list[str]]:
    for name, size in (found["heap_bytes_per_update_by_interpreter"] or {}).items():
        yield [f"heap an update, {name}", f"{size:g}"]
    for name, size in found["state_bytes_by_array"].items():
        yield [f"array of {name}", f"{size:,}"]
    if found["import_heap_bytes"] is not None:
        yield ["heap of `import zerorate`, wasm", f"{found['import_heap_bytes']:,}"]
    for name, size in (found["mpy_bytes"] or {}).items():
        yield [f"all .mpy, {name}", f"{size:,}"]


def _replay(found: Mapping[str, Any]) -> Iterator[list[str]]:
    for hours, one in found["replay_by_hours"].items():
        alone = one.get("kernel_samples_per_s")
        yield [
            f"{hours} h",
            f"{one['samples_per_s']:,.0f}",
            f"{alone:,.0f}" if alone else "",
            number(one["peak_bytes"] / 1e6),
        ]
