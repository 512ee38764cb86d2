"""How a water is said in text.

TOML values, plugin keys and flags in; `Settings` out, and back.
Imports: loads, submersion, sea, errors.
"""
