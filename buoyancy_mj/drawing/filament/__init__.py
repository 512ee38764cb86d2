"""The sea and the sky in scenes of Filament, MuJoCo's physically based renderer.

In: a context and a scene of `mujoco.mjrf`.
Out: the same scene with water and sky in it, and pictures of it.
"""
