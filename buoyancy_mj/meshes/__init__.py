"""Closed triangle meshes, and their repair.

In: vertices and faces, as a file or an engine has them.
Out: a `TriMesh` that bounds a volume, repaired where that is safe, and its tree of moments.
May import: kernels, files, errors.
"""
