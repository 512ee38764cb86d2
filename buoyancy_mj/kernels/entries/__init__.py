"""C functions that the engine calls: kernels on arrays that stand at addresses.

Imports: the other kernels.
"""
