"""An autopilot drives a vehicle: the physics behind ArduPilot's JSON interface.

In: servo pulses in packets, and a simulation.
Out: what the autopilot's sensors would tell, one line of JSON for each packet.
May import: scenes, vehicle, engine, kernels, errors.
"""
