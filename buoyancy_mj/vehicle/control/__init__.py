"""Controllers: they read a state or sensors, and write `data.ctrl`.

In: what a scene says of a controller, a model with its water, and data in its still sea.
Out: a function `update(model, data)` for each controller.
May import: vehicle, engine, loads, sea, hulls, values, errors.
"""
