"""Where does lead go so that a vehicle is neutral, level and stable?"""

import mujoco

from buoyancy_mj import Water, ballast, hydrostatics

SEA = Water(density=1025.0)
spec = mujoco.MjSpec.from_string("""<mujoco><worldbody>
  <body name="auv" pos="0 0 -2">
    <freejoint/>
    <geom name="hull" type="capsule" size=".1 .5" zaxis="1 0 0" mass="26"/>
    <geom name="camera" type="sphere" size=".06" pos=".6 0 -.1" mass="2.5"/>
    <site name="ballast_bow" pos=".4 0 -.09"/>
    <site name="ballast_stern" pos="-.4 0 -.09"/>
  </body>
</worldbody></mujoco>""")


def tell(when):
    """Print the reserve of buoyancy, and how far its centre is from that of gravity."""
    now = hydrostatics(spec.compile(), SEA)
    along, _, up = 1e3 * (now.centre_of_buoyancy - now.centre_of_gravity)
    apart = f"B {abs(along):.1f} mm from G along, {up:.1f} mm above it"
    print(f"{when}: {now.reserve:.2f} kg of reserve, {apart}")


tell("before")
lead = ballast(spec.compile(), SEA, reserve=0.0, masses="ballast*")
for item in lead.items:
    print(f"  {item.mass:.2f} kg at {item.name}")
lead.add_to(spec)
tell("after")
