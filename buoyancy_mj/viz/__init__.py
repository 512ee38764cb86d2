"""What people look at.

Frames and inspections in; a Rerun recording, or a model in the viewer of MuJoCo out.
Imports: scenes, inspection, statics, submersion, hulls, meshes, sea, errors.
"""
