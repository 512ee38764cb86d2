"""What the engine calls: addresses in; the kernels run on what stands there, generalized forces added where they belong.

Imports: the other kernels.
"""
