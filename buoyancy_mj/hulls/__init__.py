"""The geoms of a model that displace water, and those that hold it.

In: an `MjModel`, and a selection of its geoms.
Out: `Hull`s, which are meshes fixed to bodies; ballast that changes under way; the model's gravity
and `<custom>` numbers.
May import: values, meshes, kernels, errors, files.
"""
