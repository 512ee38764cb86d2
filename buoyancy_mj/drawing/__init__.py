"""The sea and what is in it, as a camera sees it.

In: a model, its data and its water; or the frames of a run.
Out: shapes of the sea, pictures of the sky, and frames of a film.
May import: scenes, engine, hulls, sea, values, errors, files.
"""
