# SPDX-License-Identifier: Apache-2.0
"""Makes the scene after Whitted's figure: two spheres over a checkered floor. README.md says what it must give."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from gltf_writer import Gltf, finish, png

HERE = pathlib.Path(__file__).resolve().parent

gltf = Gltf("whitted")
# Two tiles by two, in texels that are not blended; the floor is 10 x 16 tiles of a metre.
tiles = gltf.texture("checkers", png(2, 2, [(235, 30, 20), (245, 220, 20)], [0, 1, 1, 0]), smooth=False)
gltf.uses("KHR_texture_transform")
checkers = {"index": tiles, "extensions": {"KHR_texture_transform": {"scale": [5.0, 8.0]}}}
matt = {"KHR_materials_specular": {"specularFactor": 0.0}}
floor = gltf.material("floor", extensions=matt, texture=checkers, double_sided=True)
glass = gltf.glass("glass", ior=1.5, thickness=2.0)
mirror = gltf.material("mirror", color=(0.35, 0.45, 0.55), roughness=0.0, extensions={"KHR_materials_ior": {"ior": 4.0}})
gltf.flat("floor", "quad", floor, {"size": [10.0, 16.0]}, translation=[0.0, 0.0, -3.0])
gltf.sphere("glass ball", 1.0, glass, translation=[-0.55, 1.45, 1.0])
gltf.sphere("mirror ball", 1.0, mirror, translation=[0.95, 1.0, -1.3])
gltf.light("light", "point", (1.0, 1.0, 1.0), 220.0, translation=[-3.0, 7.0, 4.0])
gltf.camera("camera", [0.0, 1.9, 6.0], target=[0.15, 1.1, 0.0], yfov=0.72, aspect=1.0)
finish(gltf.files(HERE / "whitted.gltf"))
