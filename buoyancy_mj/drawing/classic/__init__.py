"""The sea and the sky in scenes of MuJoCo's classic renderer, as triangles.

In: an `mujoco.MjvScene`.
Out: the same scene with water and sky added, and pictures of it.
"""
