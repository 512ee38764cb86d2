"""What sensors read at one instant, with noise, held between samples.

Imports: the kernels of the water and of devices.
"""
