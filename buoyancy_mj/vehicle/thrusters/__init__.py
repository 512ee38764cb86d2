"""Thrusters as plugins of the engine: makers' tables, propeller series, tables of one's own.

In: settings, or keys of MJCF, and the site of a thruster.
Out: elements of a spec, what compiled code knows of each thruster, and its readings.
May import: engine, hulls, kernels, values, errors.
"""
