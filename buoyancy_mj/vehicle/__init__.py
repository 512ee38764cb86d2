"""What a vehicle acts and senses with: thrusters, tanks, sensors, and what drives them.

In: MJCF or an MjSpec, then the engine's arrays, pass by pass.
Out: actuators and sensors that work wherever MuJoCo steps.
May import: engine, inspection, settings, statics, loads, hulls, kernels, values, errors, records.
"""
