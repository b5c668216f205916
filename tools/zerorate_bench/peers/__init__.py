"""Who is compared with whom: every way to a bias by name, and how each is run."""

from zerorate_tools.peers import (
    Peer,
    firmware,
    first_seconds,
    fusion,
    vqf_clip_raised,
    vqf_default,
)

from .cubic import ardupilot_cubic, px4_cubic

ONLINE: dict[str, Peer] = {
    "mean of the first 10 s": first_seconds,
    "imufusion": fusion,
    "vqf": vqf_default,
    "vqf, clip 25 dps": vqf_clip_raised,
}
OFFLINE: dict[str, Peer] = {
    "PX4-style cubic": px4_cubic,
    "ArduPilot-style cubic": ardupilot_cubic,
}
OURS: dict[str, Peer] = {
    "US 9,354,080's rules": firmware(document=True),
    "US 9,354,080's rules, on rests": firmware(document=True, every=False),
    "zerorate": firmware(),
}
PEERS = {**ONLINE, **OFFLINE, **OURS}
HOW = {
    **dict.fromkeys(ONLINE, "on the device, knowing nothing"),
    **dict.fromkeys(OFFLINE, "fitted to the first power-on, told its rests"),
    **dict.fromkeys(OURS, "on the device, after the first power-on"),
}
