"""The sea.

In: waves, spectra and currents. Out: elevation, velocity, acceleration and pressure of the water.
Imports: kernels, errors.
"""
