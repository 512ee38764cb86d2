"""How is a loop of your own recorded, as pictures and as a table?"""

import csv

import mujoco

from buoyancy_mj import Recorder, RegularWave, Water, add_water

spec = mujoco.MjSpec.from_string("""<mujoco><option timestep="0.01"/><worldbody>
  <body name="float"><freejoint/><geom type="cylinder" size=".4 .1" mass="50"/></body>
</worldbody></mujoco>""")
add_water(spec, Water(waves=RegularWave(amplitude=0.1, period=3.0)), added_mass="estimate")
model = spec.compile()
data = mujoco.MjData(model)

with Recorder(model, data, "float.rrd", rate=30.0, series="float.csv") as recorder:
    while data.time < 3.0:
        mujoco.mj_step(model, data)
        recorder.record()

with open("float.csv") as file:
    heights = [float(row["float.position.z [m]"]) for row in csv.DictReader(file)]
print(f"{len(heights)} frames; heave from {min(heights):.2f} to {max(heights):.2f} m")
print("here:", *recorder.paths)
