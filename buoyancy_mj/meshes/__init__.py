"""Closed triangle meshes.

Vertices and faces in; a `TriMesh` that bounds a volume, repaired where it can be, and its tree out.
Imports: kernels, errors.
"""
