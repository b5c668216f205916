"""Many samples in one call."""

from . import machine_code, rest

# run(state, settings, frames, how many they are), or None
run = machine_code("bursts") if rest.is_machine_code else None
