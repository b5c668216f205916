"""Generalised least squares in the noise's own colour, and what left-out data says of it."""
