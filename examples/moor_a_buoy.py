"""How far does a moored buoy drift off, and what must its line hold?"""

import mujoco
import numpy as np

from buoyancy_mj import JonswapSea, Water, add_water

LINE, STIFFNESS = 22.0, 2000.0  # length at rest [m], [N/m]
spec = mujoco.MjSpec.from_string(f"""<mujoco><option timestep="0.01"/>
<worldbody>
  <geom name="bottom" type="plane" size="0 0 1" pos="0 0 -20"/>
  <site name="anchor" pos="0 0 -20"/>
  <body name="buoy">
    <freejoint/>
    <geom name="float" type="cylinder" size=".6 .4" mass="300"/>
    <geom name="keel" type="cylinder" size=".1 .1" pos="0 0 -.9" mass="60"/>
    <site name="eye" pos="0 0 -1"/>
  </body>
</worldbody>
<tendon>
  <spatial name="line" springlength="0 {LINE}" stiffness="{STIFFNESS}" damping="50">
    <site site="anchor"/><site site="eye"/>
  </spatial>
</tendon></mujoco>""")
sea = JonswapSea(significant_height=1.0, peak_period=5.0, depth=20.0, seed=3)
water = Water(density=1025.0, waves=sea, current=(0.5, 0.0, 0.0))
add_water(spec, water, pressure="froude-krylov", added_mass="ellipsoid")
model = spec.compile()
data = mujoco.MjData(model)

offsets, tensions = [], []
while data.time < 60.0:
    mujoco.mj_step(model, data)
    if data.time > 20.0:  # it has drifted to its place
        offsets.append(np.hypot(*data.body("buoy").xpos[:2]))
        tensions.append(STIFFNESS * max(data.ten_length[0] - LINE, 0.0))
print(f"offset {np.mean(offsets):.1f} m on average, {max(offsets):.1f} m at most")
print(f"tension {np.mean(tensions):.0f} N on average, {max(tensions):.0f} N at most")
