"""Potential flow around bodies in unbounded water: what moves along with them.

In: closed surfaces of bodies.
Out: their added mass over the density of the water, and how far it is converged.
May import: meshes, kernels, files.
"""
