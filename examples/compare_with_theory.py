"""Does a floating ball bob with the period that theory gives it?"""

import math

import mujoco
import numpy as np

from buoyancy_mj import Water, add_water

RADIUS, DENSITY, GRAVITY = 0.5, 1000.0, 9.81
mass = DENSITY * 2.0 / 3.0 * math.pi * RADIUS**3  # it floats half under water
spec = mujoco.MjSpec.from_string(f"""<mujoco><option timestep="0.002"/><worldbody>
  <body name="ball" pos="0 0 0.02"><freejoint/><geom size="{RADIUS}" mass="{mass}"/></body>
</worldbody></mujoco>""")
# half of the displaced mass, as in unbounded water; the surface is not told
add_water(spec, Water(density=DENSITY), added_mass="ellipsoid", damping=None)
model = spec.compile()
data = mujoco.MjData(model)

times, heights = [], []
while data.time < 8.0:
    mujoco.mj_step(model, data)
    times.append(data.time)
    heights.append(data.qpos[2])
rising = [n for n in range(1, len(times)) if heights[n - 1] < 0.0 <= heights[n]]
measured = np.mean(np.diff(np.array(times)[rising]))

stiffness = DENSITY * GRAVITY * math.pi * RADIUS**2
theory = 2.0 * math.pi * math.sqrt(1.5 * mass / stiffness)
print(f"measured {measured:.3f} s, theory {theory:.3f} s")
