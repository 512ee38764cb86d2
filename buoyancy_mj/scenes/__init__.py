"""Runs, from a file to a summary.

In: a scene as TOML, with changes laid over it; or a model and its data in somebody's own loop.
Out: frames, a summary and a table of one run, or a table of many runs.
May import: environments, vehicle, engine, settings, statics, loads, submersion, hulls, sea,
values, kernels, displays, errors, files, records.
"""
