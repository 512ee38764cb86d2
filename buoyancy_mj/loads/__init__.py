"""What the water does to a body beside buoyancy.

In: hulls, and coefficients from the model, from a dataset or from the user.
Out: arrays of damping, foils and added mass for the kernels, and the `Loads` of one instant.
May import: hulls, potential, meshes, kernels, values, displays, errors.
"""
