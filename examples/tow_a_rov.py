"""How deep does a towed vehicle hang, and how hard does the rope pull?"""

import math

import mujoco

from buoyancy_mj import Water, add_water

ROPE = 10.0  # length [m]
spec = mujoco.MjSpec.from_string(f"""<mujoco><option timestep="0.01"/>
<worldbody>
  <body name="ship" mocap="true" pos="0 0 0.5"><site name="winch"/></body>
  <body name="rov" pos="-8 0 -4">
    <freejoint/>
    <geom name="foam" type="box" size=".35 .25 .08" pos="0 0 .12" mass="20"/>
    <geom name="skid" type="box" size=".35 .25 .04" pos="0 0 -.16" mass="72"/>
    <site name="bridle" pos=".2 0 .1"/>
  </body>
</worldbody>
<tendon>
  <spatial name="rope" springlength="0 {ROPE}" stiffness="5000" rgba="1 .5 0 1">
    <site site="winch"/><site site="bridle"/>
  </spatial>
</tendon></mujoco>""")
add_water(spec, Water(density=1025.0), added_mass="ellipsoid")
model = spec.compile()

for speed in (0.5, 1.0, 1.5):  # of the ship [m/s]
    data = mujoco.MjData(model)
    while data.time < 30.0:
        data.mocap_pos[0, 0] = speed * data.time
        mujoco.mj_step(model, data)
    winch, bridle = data.site("winch").xpos, data.site("bridle").xpos
    tension = 5000.0 * max(data.ten_length[0] - ROPE, 0.0)
    angle = math.degrees(math.asin((winch[2] - bridle[2]) / data.ten_length[0]))
    print(f"{speed} m/s: {-bridle[2]:.2f} m deep, {angle:.0f} deg of rope, {tension:.0f} N in it")
