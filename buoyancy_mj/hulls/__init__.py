"""The geoms of a model that displace water.

In: an `MjModel`, and a selection of its geoms.
Out: `Hull`s, which are meshes fixed to bodies, and what the model's `<custom>` says of them.
May import: meshes, errors.
"""
