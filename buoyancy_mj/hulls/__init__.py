"""The geoms of a model that displace water.

In: an `MjModel`, and a selection of its geoms.
Out: `Hull`s, which are meshes fixed to bodies; the model's gravity and `<custom>` numbers.
May import: meshes, kernels, errors, files.
"""
