"""Which geoms displace water and as what.

An MjModel in; `Hull`s, meshes fixed to bodies, and what the model says of itself out.
Imports: meshes, errors.
"""
