"""How does a vehicle that is described in URDF go into the water?"""

import mujoco

from buoyancy_mj import Water, add_water, equilibrium

URDF = """<robot name="rov">
  <link name="rov">
    <inertial><origin xyz="0 0 -.05"/><mass value="30"/>
      <inertia ixx="1" iyy="1.5" izz="1.5" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size=".8 .4 .1"/></geometry></collision>
  </link>
  <link name="arm">
    <inertial><mass value="1"/>
      <inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><cylinder radius=".03" length=".3"/></geometry></collision>
  </link>
  <joint name="shoulder" type="revolute">
    <parent link="rov"/><child link="arm"/><origin xyz=".4 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="5" velocity="1"/>
  </joint>
</robot>"""
spec = mujoco.MjSpec.from_string(URDF)
spec.body("rov").add_freejoint()  # a URDF's base is fixed to the world
add_water(spec, Water(density=1025.0))
rest = equilibrium(spec.compile(), Water(density=1025.0))
print(f"it floats {rest.hydrostatics.draft:.3f} m deep, {rest.stability}")
print(f"with {rest.hydrostatics.reserve:.1f} kg of reserve")
