"""The water at work in MuJoCo.

A model and a water in; generalized forces in `qfrc_passive`, as a callback or a plugin, out.
Imports: settings, loads, submersion, hulls, sea, kernels, errors.
"""
