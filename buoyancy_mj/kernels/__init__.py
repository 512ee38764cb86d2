"""Arrays in, numbers out, compiled by Numba: no engine, no dataclass and no file is known here."""
