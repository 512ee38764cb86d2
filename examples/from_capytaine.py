"""How do added mass and damping come from Capytaine into a vehicle?"""

import tempfile
from pathlib import Path

import capytaine as cpt
import mujoco
import numpy as np
import scipy

from buoyancy_mj import Water, add_coefficients, add_water, read_coefficients

PERIOD = 2.0  # near which it will bob [s]

# a ball of 1 m radius, half under water, by potential flow
mesh = cpt.mesh_sphere(radius=1.0, resolution=(10, 16)).immersed_part()
ball = cpt.FloatingBody(mesh, dofs=cpt.rigid_body_dofs(rotation_center=(0, 0, 0)), name="ball")
problems = [
    cpt.RadiationProblem(body=ball, radiating_dof=dof, omega=2.0 * np.pi / PERIOD)
    for dof in ball.dofs
]
results = cpt.BEMSolver().solve_all(problems, progress_bar=False)
file = Path(tempfile.mkdtemp()) / "ball.nc"
cpt.export_dataset(file, cpt.assemble_dataset(results, hydrostatics=False))

# the same ball in MuJoCo
spec = mujoco.MjSpec.from_string("""<mujoco><option timestep="0.01"/><worldbody>
  <body name="ball" pos="0 0 0.3"><freejoint/><geom size="1" density="500"/></body>
</worldbody></mujoco>""")
coefficients = read_coefficients(file, period=PERIOD, submerged=0.5)
add_coefficients(spec, coefficients)
add_water(spec, Water())
model = spec.compile()
print(f"added mass in heave {0.5 * coefficients['ball'].added_mass[2, 2]:.0f} kg at the waterline")
print(f"radiation damping in heave {coefficients['ball'].radiation[0]:.0f} N s/m")

data = mujoco.MjData(model)
heights = []
while data.time < 8.0:
    mujoco.mj_step(model, data)
    heights.append(data.qpos[2])
peaks = np.array(heights)[scipy.signal.argrelmax(np.array(heights))[0]]
print("peaks of its decay:", *(f"{z:.3f} m" for z in peaks[:3]))
