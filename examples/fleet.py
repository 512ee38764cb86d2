"""How do vehicles at three depths fare in one sea?"""

from buoyancy_mj import JonswapSea, Scene, SceneVehicle, Simulation, Start, Water

neutral = 24.67  # mass of a vehicle that neither rises nor sinks [kg]
fleet = [
    SceneVehicle(model="sauvc_auv", name=name, mass=mass, start=Start(position=(x, 0.0, -depth)))
    for name, mass, x, depth in (
        ("rider", None, 0.0, 0.0),
        ("shallow", neutral, 3.0, 1.5),
        ("deep", neutral, 6.0, 6.0),
    )
]
scene = Scene(
    title="Three depths in one sea",
    vehicles=fleet,
    water=Water(waves=JonswapSea(significant_height=0.4, peak_period=4.0, seed=1)),
    pressure="froude-krylov",
    duration=8.0,
)
simulation = Simulation(scene)
heights = {vehicle.name: [] for vehicle in fleet}
for frame in simulation.frames():
    for name, vehicle in frame.vehicles.items():
        heights[name].append(vehicle.centre_of_mass[2])
for name, seen in heights.items():
    print(f"{name}: from {min(seen):.2f} to {max(seen):.2f} m")
