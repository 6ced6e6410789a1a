# SPDX-License-Identifier: Apache-2.0
"""Makes many-lights.gltf: a thousand small lamps of eight colours and of powers from 1 to 16 in a spiral over a floor, some of them behind pillars."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from gltf_writer import Gltf, finish
from shapes import Shape, box, icosphere, quad, snap

LAMPS, RADIUS, POWER = 1000, 12.0, 2400.0 # POWER: pi * radiance * area of all of them, in their strongest channel
HALF = 0.05                               # a lamp is an octahedron with corners at this distance
COLORS = [(1.0, 0.25, 0.1), (1.0, 0.5, 0.15), (1.0, 0.8, 0.4), (0.9, 1.0, 0.75), (0.35, 1.0, 0.5), (0.2, 0.75, 1.0), (0.3, 0.4, 1.0), (0.85, 0.3, 1.0)]
LEVELS = [1, 2, 4, 16]                    # times the power of the dimmest

gltf = Gltf("many-lights")
gltf.shape("floor", quad((-14, 0, 14), (14, 0, 14), (14, 0, -14), (-14, 0, -14)), gltf.material("floor", [0.5, 0.48, 0.45], roughness=0.35))
stone = gltf.lambert("stone", [0.6, 0.58, 0.55])
for i in range(8):
    x, _, z = snap((6 * math.cos(math.pi * (i + 0.5) / 4), 0, 6 * math.sin(math.pi * (i + 0.5) / 4)))
    gltf.shape(f"pillar {i}", box((x - 0.35, 0.0, z - 0.35), (x + 0.35, 3.2, z + 0.35)), stone)
gltf.shape("ball", icosphere(1.2, 5, smooth=True), gltf.material("ball", [0.9, 0.9, 0.92], metallic=1.0, roughness=0.15), translation=[0.0, 1.2, 0.0])

corners = [(HALF, 0, 0), (0, 0, -HALF), (-HALF, 0, 0), (0, 0, HALF), (0, HALF, 0), (0, -HALF, 0)]
lamp = Shape(corners, [t for i in range(4) for t in ((i, (i + 1) % 4, 4), ((i + 1) % 4, i, 5))])
# Lamp i has colour i modulo 8 and a level by a fixed hash: no order of the nodes is an order of the powers.
level_of = [(i * 2654435761 >> 7) % 4 for i in range(LAMPS)]
unit = POWER / sum(LEVELS[level] for level in level_of)
meshes = {}
for color, rgb in enumerate(COLORS):
    for level, times in enumerate(LEVELS):
        radiance = unit * times / (math.pi * lamp.area())
        material = gltf.lambert(f"lamp {color} {level}", [0.0, 0.0, 0.0], emission=[round(radiance * c, 3) for c in rgb])
        meshes[color, level] = gltf.mesh(f"lamp {color} {level}", gltf.primitive(lamp, material))
for i in range(LAMPS):
    angle, distance = i * math.pi * (3 - math.sqrt(5)), RADIUS * math.sqrt((i + 0.5) / LAMPS)  # a sunflower's seeds [Vogel79]
    height = 0.25 + 2.6 * ((i * 0.618033988749895) % 1)
    place = snap((distance * math.cos(angle), height, distance * math.sin(angle)))
    if math.dist(place, (0, 1.2, 0)) < 1.4:  # not within the ball
        place = (place[0], 2.9, place[2])
    gltf.node(f"lamp {i}", mesh=meshes[i % 8, level_of[i]], translation=list(place))
gltf.camera("camera", (0.0, 4.2, 13.0), (0.0, 0.9, 0.0), yfov=0.75, aspect=1.5)
finish(gltf.files(pathlib.Path(__file__).resolve().with_name("many-lights.gltf")))
