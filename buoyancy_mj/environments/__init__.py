"""Arenas with rules, and referees who watch a vehicle.

In: a task, a seed; then a model with an arena and a vehicle in it, step by step.
Out: an `MjSpec` of the arena; what the vehicle has done, and its points.
May import: engine, hulls, sea, values, records, errors.
"""
