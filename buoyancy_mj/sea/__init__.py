"""The sea: waves, spectra, currents, and water.

In: heights, periods, directions, spectra, currents by depth or by time.
Out: elevation, velocity, acceleration and pressure at any point and time.
May import: kernels, values, displays, errors.
"""
