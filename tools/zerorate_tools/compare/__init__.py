"""What a log alone says of ways to the bias: how wrong each would have been at every later rest."""

from .judge import Compared, Rest, TooFewRests, Verdict, Won, compare, matrix_of

__all__ = ["Compared", "Rest", "TooFewRests", "Verdict", "Won", "compare", "matrix_of"]
