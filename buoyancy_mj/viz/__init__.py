"""What people look at.

In: frames of a run, be it a scene's or anybody's own loop, or an inspection.
Out: a recording for the Rerun viewer, messages of ROS 2, or MuJoCo's own viewer with the water in
it.
May import: drawing, scenes, vehicle, engine, inspection, statics, submersion, loads, hulls, meshes,
sea, values, errors, files.
"""
