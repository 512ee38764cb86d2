"""How is a vehicle of your own led along way-points?"""

import mujoco

from buoyancy_mj import Hold, Thruster, Water, Waypoint, add_thruster, add_water, start_controller

spec = mujoco.MjSpec.from_string("""<mujoco><option timestep="0.01"/><worldbody>
  <body name="minnow" pos="0 0 -1">
    <freejoint/>
    <geom name="hull" type="capsule" size=".08 .25" zaxis="1 0 0" mass="11.2"/>
    <geom name="lead" type="box" size=".1 .02 .005" pos="0 0 -.09" mass=".9"/>
  </body>
</worldbody></mujoco>""")
minnow = spec.body("minnow")
for x, end in ((1, "bow"), (-1, "stern")):
    for y, side, hand in ((1, "port", "left"), (-1, "starboard", "right")):
        level, upright = f"level_{end}_{side}", f"upright_{end}_{side}"
        minnow.add_site(name=level, pos=[0.2 * x, 0.15 * y, 0], zaxis=[1, -x * y, 0])
        minnow.add_site(name=upright, pos=[0.15 * x, 0.15 * y, 0])
        for site in (level, upright):
            add_thruster(spec, site, Thruster(preset="t200", lag=0.1), hand=hand)
add_water(spec, Water(current=(0.0, 0.1, 0.0)), added_mass="ellipsoid")
model = spec.compile()
data = mujoco.MjData(model)

course = (
    Waypoint(position=(2.0, 0.0), depth=1.5),
    Waypoint(position=(2.0, 1.0), heading=1.57, stay=1.0),
)
update = start_controller(Hold(waypoints=course, speed=0.4), model, data)
while data.time < 16.0:
    update(model, data)
    mujoco.mj_step(model, data)
    if round(data.time / 0.01) % 400 == 0:
        x, y, z = data.body("minnow").xpos
        print(f"{data.time:.0f} s: {x:.2f} m ahead, {abs(y):.2f} m to port, {-z:.2f} m deep")
