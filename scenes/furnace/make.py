# SPDX-License-Identifier: Apache-2.0
"""Makes the furnaces: scenes whose picture is known beforehand. README.md says what each must give."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from gltf_writer import Gltf, finish
from shapes import box, icosphere

HERE = pathlib.Path(__file__).resolve().parent


def furnace():
    """A closed box seen from inside; its albedo differs by channel, so that three series are tested at once."""
    gltf = Gltf("furnace")
    wall = gltf.lambert("wall", [0.5, 0.25, 0.75], emission=[1.0, 1.0, 1.0])
    gltf.shape("box", box((-1.0, -1.5, -2.0), (1.0, 1.5, 2.0)).flipped(), wall)
    gltf.camera("camera", [0.25, -0.5, 1.0], rotation=[0.0, 0.0, 0.0, 1.0], yfov=math.pi / 2)
    return gltf


def white_spheres():
    """Rows of spheres that absorb nothing, roughness 0 to 1 from left to right. Facets without vertex normals: the shading normal is the true one."""
    gltf = Gltf("white-spheres")
    sphere = icosphere(0.4, 4)
    positions, indices = gltf.floats(sphere.positions, bounds=True), gltf.indices(sphere.triangles)
    rows = [
        ("metal", lambda r: gltf.material(f"metal {r}", metallic=1.0, roughness=r)),
        ("dielectric", lambda r: gltf.material(f"dielectric {r}", roughness=r)),
        ("glass", lambda r: gltf.glass(f"glass {r}", roughness=r, thickness=0.8)),
        ("thin glass", lambda r: gltf.glass(f"thin glass {r}", roughness=r, volume=False)),
    ]
    for row, (name, material) in enumerate(rows):
        for column, roughness in enumerate((0.0, 0.25, 0.5, 0.75, 1.0)):
            mesh = gltf.mesh(f"{name} {roughness}", {"attributes": {"POSITION": positions}, "indices": indices, "material": material(roughness)})
            gltf.node(f"{name} {roughness}", mesh=mesh, translation=[float(column - 2), 1.5 - row, 0.0])
    gltf.camera("camera", [0.0, 0.0, 12.0], rotation=[0.0, 0.0, 0.0, 1.0], yfov=round(2 * math.atan(2.2 / 12), 6), aspect=1.25)
    return gltf


def lambert_sphere():
    """One convex Lambertian body: under a uniform sky of radiance 1 every point of it shows its albedo."""
    gltf = Gltf("lambert-sphere")
    gltf.shape("sphere", icosphere(1.0, 3), gltf.lambert("grey", [0.8, 0.5, 0.2]))
    gltf.camera("camera", [0.0, 0.0, 4.0], rotation=[0.0, 0.0, 0.0, 1.0], yfov=round(2 * math.atan(0.3), 6), aspect=1.0)
    return gltf


files = {}
for make in (furnace, white_spheres, lambert_sphere):
    scene = make()
    files |= scene.files(HERE / f"{scene.name}.gltf")
finish(files)
