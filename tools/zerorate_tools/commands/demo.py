"""`zerorate demo`: the whole job without hardware."""

from __future__ import annotations

import argparse
from pathlib import Path


def add_parser(subparsers) -> None:
    """Register the sub-command."""
    parser = subparsers.add_parser(
        "demo",
        help="the whole job without hardware",
        description="Play a recording, register by register, through an emulated chip on an "
        "emulated I2C bus into the driver and the firmware on a real MicroPython; print the error "
        "before and after and draw it.",
    )
    parser.add_argument(
        "log", nargs="?", type=Path, metavar="LOG", help="a recording at rest; default: built-in"
    )
    parser.add_argument("--out", type=Path, default=Path("zerorate-demo"), metavar="DIR")
    parser.add_argument(
        "--runtime", default="wasm", metavar="NAME", help="wasm (default), x86, armhf, or a path"
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Play, print, draw."""
    from ..demo import demo
    from ..demo.picture import draw
    from ..progress import progress
    from ..recordings.atomic import written_beside

    with progress("playing through chip, bus, driver and firmware"):
        shown = demo(arguments.log, arguments.runtime)
    arguments.out.mkdir(parents=True, exist_ok=True)
    picture = arguments.out / "demo.png"
    with written_beside(picture) as temporary:
        draw(shown, temporary)
    _print(shown)
    print(f"picture: {picture}")
    return 0 if shown.same_state else 1


def _print(shown) -> None:
    columns = shown.recording.columns
    minutes = (columns["t_us"][-1] - columns["t_us"][0]) / 60e6
    print(f"{shown.recording.name}: {len(columns['t_us'])} samples, {minutes:.1f} min")
    print(f"MicroPython ({shown.runtime}) says:")
    for line in shown.said.splitlines():
        print("  " + line)
    equal = "equal to the last bit" if shown.same_state else "DIFFERENT, which is a defect"
    print(f"its final state and that of the same kernels on this host: {equal}")
    s = shown.score
    print(f"after the first ten seconds, against the truth ({s.truth}):")
    rows = (
        ("uncorrected", s.uncorrected_mdps, s.uncorrected_deg),
        ("mean of the first ten seconds", s.first_ten_s_mdps, s.first_ten_s_deg),
        ("zerorate", s.firmware_mdps, s.firmware_deg),
    )
    for name, mdps, deg in rows:
        print(f"  {name:30} {mdps:9.1f} mdps rms {deg:9.2f} deg lost by the end")
