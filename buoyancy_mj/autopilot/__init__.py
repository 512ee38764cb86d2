"""An autopilot drives a vehicle.

In: servo pulses in packets, and a simulation.
Out: what the autopilot's sensors would tell, one line of JSON for each packet.
May import: scenes, vehicle, engine, kernels, errors.
"""
