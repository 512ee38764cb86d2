"""What of a mesh is under water.

Meshes, poses and a sea in; volume, centroid, wetted and waterplane area out, by three methods.
Imports: meshes, sea, kernels, errors.
"""
