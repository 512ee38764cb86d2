"""Everything about one model before it goes to sea.

In: a model and its still water.
Out: an `Inspection`: verdicts on geoms and meshes, statics, and their report and charts.
May import: loads, statics, hulls, meshes, sea, plotting, errors, files.
"""
