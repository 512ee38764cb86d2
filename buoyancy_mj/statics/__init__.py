"""What a naval architect asks of still water.

In: a model, the water's density and level, a pose.
Out: centres, metacentric heights, rest poses, righting arms and ballast.
May import: hulls, submersion, meshes, sea, kernels, displays, errors.
"""
