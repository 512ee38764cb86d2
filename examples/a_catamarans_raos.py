"""How does a catamaran answer waves from ahead, and how far does it heave in a sea?"""

import math

from buoyancy_mj import JonswapSea, respond

periods = [1.0, 1.5, 2.0, 3.0]  # [s]
found = respond("catamaran", periods, headings=math.pi)

heave, roll, pitch = found.natural_periods
print(f"natural periods: heave {heave:.2f} s, pitch {pitch:.2f} s")
slopes = found.normal_sizes[0, :, found.names.index("pitch")]
for period, lift, turn in zip(periods, abs(found.find("heave")[0]), slopes, strict=True):
    print(f"{period} s: heave {lift:.2f} m/m, pitch {turn:.2f} of the wave's slope")

sea = JonswapSea(significant_height=0.2, peak_period=2.0)
(answers,) = found.in_sea(sea)
said = answers[found.names.index("heave")]
print(f"a sea of 0.2 m heaves it by {said.significant:.2f} m, significant amplitude")
