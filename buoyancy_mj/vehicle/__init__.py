"""What a vehicle does by itself: it pushes, senses and steers.

In: a model with its water, and what a vehicle carries: thrusters, tanks, sensors, controllers.
Out: plain MJCF for the engine, readings, and controls in `data.ctrl`.
May import: engine, settings, statics, loads, hulls, sea, kernels, values, records, errors.
"""
