"""Closed triangle meshes.

In: vertices and faces. Out: a `TriMesh` that bounds a volume, repaired where possible; its tree.
Imports: kernels, errors.
"""
