"""The Singapore AUV Challenge, after its rulebook of 2026 (version 6.1.0 of 16 November 2025).

The rulebook is public: https://github.com/sauvc/rulebook. Where it leaves something open, the
docstring says what is assumed here.
"""
