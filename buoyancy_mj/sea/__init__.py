"""The sea: waves, spectra, currents and the water under them.

In: heights, periods, directions, spectra, currents by depth or by time.
Out: elevation, velocity, acceleration and pressure at any point and time.
May import: kernels, errors.
"""
