"""What a naval architect asks of still water.

A model in; centres, metacentres, rest poses, righting arms and ballast out.
Imports: hulls, submersion, meshes, sea, kernels, errors.
"""
