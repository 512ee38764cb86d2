"""All that statics and meshes tell about one model.

A model in; an `Inspection`, its report and charts out.
Imports: statics, hulls, meshes, sea, errors.
"""
