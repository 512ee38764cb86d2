"""What people look at.

In: frames of a run, or an inspection.
Out: a recording for the Rerun viewer, or MuJoCo's own viewer with the water in it.
May import: scenes, inspection, statics, submersion, loads, hulls, meshes, sea, errors, files.
"""
