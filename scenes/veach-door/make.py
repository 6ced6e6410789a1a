# SPDX-License-Identifier: Apache-2.0
"""Makes veach-door.gltf: a room that is lit through a door left ajar, after [Veach97, fig. 8.6 and 11.5], with dimensions of our own."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from gltf_writer import Gltf, finish
from shapes import Shape, box, icosphere, lathe, merged, quad, smooth_profile, snap

HALF, HEIGHT, BACK, FRONT = 2.0, 2.6, -2.0, 2.6   # the room; its back wall has the doorway
WALL = 0.12
LEFT, RIGHT, TOP = 0.35, 1.25, 2.05               # of the doorway
OTHER = -6.0                                      # the other room's far wall
AJAR = math.radians(16)                           # that the door stands open, into the other room
LAMP, POWER = 0.08, 1500.0                        # half the lamp's side; pi * radiance * area
LAMP_AT = (-0.6, HEIGHT - 0.15, -4.2)             # facing the ceiling


def door():
    """Hinged at the doorway's right edge, its face in line with the wall's when shut."""
    shut = box((-(RIGHT - LEFT), 0.005, -0.04), (-0.004, TOP - 0.004, 0.0))
    c, s = math.cos(AJAR), math.sin(AJAR)
    turned = [snap((RIGHT + c * x - s * z, y, BACK - 0.002 + s * x + c * z)) for x, y, z in shut.positions]
    return Shape(turned, shut.triangles)


def room(near, far, up):
    """Floor, ceiling and side walls between two depths; fronts inward."""
    return merged(quad((-HALF, 0, near), (HALF, 0, near), (HALF, 0, far), (-HALF, 0, far)), quad((-HALF, up, far), (HALF, up, far), (HALF, up, near), (-HALF, up, near)),
                  quad((-HALF, 0, near), (-HALF, 0, far), (-HALF, up, far), (-HALF, up, near)), quad((HALF, 0, far), (HALF, 0, near), (HALF, up, near), (HALF, up, far)))


gltf = Gltf("veach-door")
wall = gltf.lambert("wall", [0.72, 0.7, 0.66], double_sided=True)
bright = gltf.lambert("other room", [0.8, 0.78, 0.72], double_sided=True)
wood = gltf.lambert("wood", [0.42, 0.24, 0.12], double_sided=True)
clay = gltf.lambert("clay", [0.55, 0.28, 0.2], double_sided=True)
metal = gltf.material("metal", [0.9, 0.75, 0.5], metallic=1.0, roughness=0.35, double_sided=True)
glass = gltf.glass("glass", ior=1.5, thickness=0.4)
gltf.shape("room", room(FRONT, BACK, HEIGHT), wall)
gltf.shape("front wall", quad((HALF, 0, FRONT), (-HALF, 0, FRONT), (-HALF, HEIGHT, FRONT), (HALF, HEIGHT, FRONT)), wall)
gltf.shape("back wall", merged(box((-HALF, 0, BACK - WALL), (LEFT, HEIGHT, BACK)), box((RIGHT, 0, BACK - WALL), (HALF, HEIGHT, BACK)),
                               box((LEFT, TOP, BACK - WALL), (RIGHT, HEIGHT, BACK))), wall)
gltf.shape("other room", merged(room(BACK, OTHER, HEIGHT), quad((-HALF, 0, OTHER), (HALF, 0, OTHER), (HALF, HEIGHT, OTHER), (-HALF, HEIGHT, OTHER))), bright)
gltf.shape("door", door(), wood)
gltf.shape("table", merged(box((-1.25, 0.66, -0.55), (0.75, 0.72, 0.45)), *(box((x, 0.0, z), (x + 0.07, 0.66, z + 0.07)) for x in (-1.2, 0.63) for z in (-0.5, 0.33))), wood)
vase = lathe(smooth_profile([(0.0, 0.0), (0.14, 0.02), (0.2, 0.16), (0.16, 0.32), (0.09, 0.42), (0.12, 0.5)]), 48)
gltf.shape("vase", vase, clay, translation=[-0.85, 0.721, 0.0])
ball = icosphere(0.2, 4, smooth=True)
gltf.shape("metal ball", ball, metal, translation=[-0.2, 0.922, -0.1])
gltf.shape("glass ball", ball, glass, translation=[0.4, 0.922, 0.1])
radiance = POWER / (math.pi * (2 * LAMP) ** 2)
lamp = gltf.lambert("lamp", [0.0, 0.0, 0.0], emission=[round(radiance * c, 4) for c in (1.0, 0.93, 0.8)])
x, y, z = LAMP_AT
gltf.shape("lamp", quad((x - LAMP, y, z + LAMP), (x + LAMP, y, z + LAMP), (x + LAMP, y, z - LAMP), (x - LAMP, y, z - LAMP)), lamp)
gltf.camera("camera", (-0.25, 1.45, 2.5), (0.05, 1.05, -1.0), yfov=0.85, aspect=1.333333)
finish(gltf.files(pathlib.Path(__file__).resolve().with_name("veach-door.gltf")))
