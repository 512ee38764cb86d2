"""What does a mesh with a hole displace, and when is it refused?"""

import trimesh

from buoyancy_mj import MeshError, repair, submerge

ball = trimesh.creation.icosphere(subdivisions=3, radius=0.5)
print(f"whole: {ball.volume:.4f} m^3 of {len(ball.faces)} triangles")

mesh, notices = repair(ball.vertices, ball.faces[1:], name="ball")
print(f"a triangle is missing: {mesh.volume:.4f} m^3")
print(*notices, sep="\n")
print(f"half under water: {submerge(mesh, position=[0.0, 0.0, 0.0]).volume:.4f} m^3")

try:
    repair(ball.vertices, ball.faces[len(ball.faces) // 4 :], name="ball")
except MeshError as error:
    print("a quarter is missing:", error)
