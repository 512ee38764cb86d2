"""Runs.

A TOML file in; one simulated scene, its frames and its summary, or a table of many out.
Imports: engine, settings, statics, loads, submersion, hulls, sea, errors.
"""
