"""`zerorate bench loop`: what closing the loop finds, names, removes and invents."""
