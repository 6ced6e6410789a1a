# SPDX-License-Identifier: Apache-2.0
"""Makes cornell-caustic.gltf: a glass ball and a mirror ball under a small lamp, in a box with a red and a green wall, after the scenes of [Jensen96]."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from gltf_writer import Gltf, finish
from shapes import icosphere, quad

HALF, HEIGHT, BACK, FRONT = 1.6, 2.8, -1.8, 2.6
LAMP, LAMP_HEIGHT, POWER = 0.1, 2.7, 40.0  # half the lamp's side; POWER is pi * radiance * area
BALL = 0.55

gltf = Gltf("cornell-caustic")
white = gltf.lambert("white", [0.75, 0.75, 0.75], double_sided=True)
red = gltf.lambert("red", [0.6, 0.06, 0.05], double_sided=True)
green = gltf.lambert("green", [0.1, 0.5, 0.12], double_sided=True)
mirror = gltf.material("mirror", [0.92, 0.92, 0.92], metallic=1.0, roughness=0.0, double_sided=True)
glass = gltf.glass("glass", ior=1.5, thickness=2 * BALL)
lower, upper = 0.0, HEIGHT
gltf.shape("floor", quad((-HALF, 0, FRONT), (HALF, 0, FRONT), (HALF, 0, BACK), (-HALF, 0, BACK)), white)
gltf.shape("ceiling", quad((-HALF, HEIGHT, BACK), (HALF, HEIGHT, BACK), (HALF, HEIGHT, FRONT), (-HALF, HEIGHT, FRONT)), white)
gltf.shape("back wall", quad((-HALF, 0, BACK), (HALF, 0, BACK), (HALF, HEIGHT, BACK), (-HALF, HEIGHT, BACK)), white)
gltf.shape("front wall", quad((HALF, 0, FRONT), (-HALF, 0, FRONT), (-HALF, HEIGHT, FRONT), (HALF, HEIGHT, FRONT)), white)
gltf.shape("left wall", quad((-HALF, 0, FRONT), (-HALF, 0, BACK), (-HALF, HEIGHT, BACK), (-HALF, HEIGHT, FRONT)), red)
gltf.shape("right wall", quad((HALF, 0, BACK), (HALF, 0, FRONT), (HALF, HEIGHT, FRONT), (HALF, HEIGHT, BACK)), green)
radiance = POWER / (math.pi * (2 * LAMP) ** 2)
lamp = gltf.lambert("lamp", [0.0, 0.0, 0.0], emission=[round(radiance * c, 4) for c in (1.0, 0.9, 0.75)])
gltf.shape("lamp", quad((-LAMP, LAMP_HEIGHT, -LAMP), (LAMP, LAMP_HEIGHT, -LAMP), (LAMP, LAMP_HEIGHT, LAMP), (-LAMP, LAMP_HEIGHT, LAMP)), lamp)
ball = icosphere(BALL, 5, smooth=True)
gltf.shape("mirror ball", ball, mirror, translation=[-0.75, BALL + 0.01, -0.75])
gltf.shape("glass ball", ball, glass, translation=[0.7, BALL + 0.01, 0.35])
gltf.camera("camera", (0.0, 1.4, 2.5), (0.0, 1.1, 0.0), yfov=0.96, aspect=1.0)
finish(gltf.files(pathlib.Path(__file__).resolve().with_name("cornell-caustic.gltf")))
