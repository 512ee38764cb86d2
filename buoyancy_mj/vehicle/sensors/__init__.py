"""Sensors as plugins of the engine: of the water, of the bottom, of sound.

In: settings, or keys of MJCF, and the site of a sensor.
Out: elements of a spec, and what compiled code knows of each sensor.
May import: engine, settings, hulls, kernels, values, errors.
"""
