"""The submerged part of meshes.

In: meshes, poses and a sea. Out: volume, centroid, wetted and waterplane area, by three methods.
Imports: meshes, sea, kernels, errors.
"""
