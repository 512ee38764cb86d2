"""How far do a thousand rafts tilt, each at a place of its own in one sea?"""

import mujoco
import numpy as np
from mujoco import batch

from buoyancy_mj import JonswapSea, Water, add_water

spec = mujoco.MjSpec.from_string("""<mujoco><option timestep="0.04"/><worldbody>
  <body name="raft"><freejoint/><geom type="box" size=".5 .4 .1" mass="70"/></body>
</worldbody></mujoco>""")
sea = JonswapSea(significant_height=0.3, peak_period=3.0, components=16, seed=1)
add_water(spec, Water(waves=sea), added_mass="ellipsoid")

many = batch.Batch(spec.compile(), nsim=1000)
many.qpos[:, :2] = np.random.default_rng(0).uniform(-200.0, 200.0, (1000, 2))
most = np.zeros(1000)
for _ in range(20):  # looks, 0.2 s apart
    many.step(nstep=5)
    w, x, y, z = many.qpos[:, 3:7].T
    tilt = np.arccos(1.0 - 2.0 * (x * x + y * y))
    most = np.maximum(most, np.degrees(tilt))
print(f"within 4 s half of them tilt beyond {np.median(most):.0f} deg,", end=" ")
print(f"one in a hundred beyond {np.quantile(most, 0.99):.0f} deg")
