"""Every number that a model measures, commands and actuates.

In: a model, and its data.
Out: the numbers, each with a name and a unit.
May import: sensors and thrusters of the vehicle, engine, hulls, errors.
"""
