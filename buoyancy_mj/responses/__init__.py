"""What a vehicle answers to waves, and how it comes to rest.

In: a scene or a model, periods and headings of waves, a sea; or a motion to let go from.
Out: response amplitude operators, extremes in a sea, and decays, with their tables and charts.
May import: scenes, engine, statics, sea, values, plotting, files, errors.
"""
