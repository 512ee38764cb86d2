"""The sea.

Waves, spectra and currents in; elevation, velocity, acceleration and pressure at places and times out.
Imports: kernels, errors.
"""
