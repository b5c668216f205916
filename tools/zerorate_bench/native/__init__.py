"""Machine code: made from the kernels, run on emulated processors, and what it costs there."""
