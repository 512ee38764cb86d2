"""Thrusters, tanks and sensors: what they do at one instant, on arrays.

Imports: the kernels of the water.
"""
