# SPDX-License-Identifier: Apache-2.0
"""Makes cornell-caustic.gltf: a glass ball and a mirror ball under a small lamp, in a box with a red and a green wall, after the scenes of [Jensen96]; and
spot-lamp.gltf, the same room for those who know no lamps with an area: a spot light stands before the lamp."""
import copy
import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from gltf_writer import Gltf, finish, pretty
from shapes import icosphere, quad

HALF, HEIGHT, BACK, FRONT = 1.6, 2.8, -1.8, 2.6
LAMP, LAMP_HEIGHT, POWER = 0.1, 2.7, 40.0  # half the lamp's side; POWER is pi * radiance * area
BALL, GLASS_HEIGHT = 0.55, 1.05  # the glass ball floats where its focus, 1.5 radii below its middle, is near the floor

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
COLOR = (1.0, 0.9, 0.75)
lamp = gltf.lambert("lamp", [0.0, 0.0, 0.0], emission=[round(radiance * c, 4) for c in COLOR])
gltf.shape("lamp", quad((-LAMP, LAMP_HEIGHT, -LAMP), (LAMP, LAMP_HEIGHT, -LAMP), (LAMP, LAMP_HEIGHT, LAMP), (-LAMP, LAMP_HEIGHT, LAMP)), lamp)
ball = icosphere(BALL, 5, smooth=True)
gltf.shape("mirror ball", ball, mirror, translation=[-0.75, BALL + 0.01, -0.75])
gltf.shape("glass ball", ball, glass, translation=[0.55, GLASS_HEIGHT, 0.1])
gltf.camera("camera", (0.0, 1.4, 2.5), (0.0, 1.1, 0.0), yfov=0.96, aspect=1.0)
files = gltf.files(pathlib.Path(__file__).resolve().with_name("cornell-caustic.gltf"))
# The radiant intensity of the lamp straight down, falling with the square of the cosine instead of the cosine. The same buffer.
spot = copy.deepcopy(gltf)
down = [round(-math.sqrt(0.5), 9), 0.0, 0.0, round(math.sqrt(0.5), 9)]
spot.light("spot", "spot", COLOR, round(POWER / math.pi, 4), translation=[0.0, LAMP_HEIGHT - 0.01, 0.0], rotation=down)
spot.json["extensions"]["KHR_lights_punctual"]["lights"][0]["spot"] = {"innerConeAngle": 0.0, "outerConeAngle": round(math.pi / 2, 6)}
path = pathlib.Path(__file__).resolve().with_name("spot-lamp.gltf")
document = json.loads(spot.files(path)[path])
document["buffers"][0]["uri"] = "cornell-caustic.bin"
finish(files | {path: pretty(document).encode() + b"\n"})
