"""What was found as the firmware's own kernels have it, on data that no fit has seen."""
