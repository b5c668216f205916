"""Recordings into sessions: ticks, the gate, rests, blocks, Earth's rotation, turns."""
