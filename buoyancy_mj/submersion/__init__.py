"""The part of a mesh under water, by three methods.

In: meshes, their poses and a sea.
Out: submerged volume, its centroid, wetted area and waterplane area.
May import: meshes, sea, kernels, values, errors.
"""
