"""What a vehicle acts and senses with: thrusters, tanks, sensors, and what drives them.

In: MJCF, an MjSpec or a model; then the engine's arrays, pass by pass.
Out: actuators and sensors that work wherever MuJoCo steps, and controls in `data.ctrl`.
May import: engine, inspection, settings, statics, loads, sea, hulls, kernels, values,
errors, records.
"""
