"""What the water does to a body beside buoyancy.

Hulls in; drag, damping and added mass as arrays, and `Loads` out.
Imports: hulls, meshes, kernels, errors.
"""
