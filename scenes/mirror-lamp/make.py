# SPDX-License-Identifier: Apache-2.0
"""Makes mirror-lamp.gltf: a lamp that shines up at a mirror over a matt floor. All light on the floor comes by the mirror, and is known."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from gltf_writer import Gltf, finish
from shapes import box, icosphere, quad

LAMP_HALF, LAMP_HEIGHT, MIRROR_HALF, MIRROR_HEIGHT, RADIANCE = 0.4, 0.8, 3.0, 2.5, 10.0


def level(half, y, up):
    """A square at height y whose front looks up or down."""
    corners = [(-half, y, half), (half, y, half), (half, y, -half), (-half, y, -half)]
    return quad(*(corners if up else corners[::-1]))


gltf = Gltf("mirror-lamp")
black = gltf.lambert("housing", [0.0, 0.0, 0.0])
gltf.shape("floor", level(6.0, 0.0, True), gltf.lambert("floor", [0.7, 0.7, 0.7]))
gltf.shape("mirror", level(MIRROR_HALF, MIRROR_HEIGHT, False), gltf.material("mirror", [1.0, 1.0, 1.0], metallic=1.0, roughness=0.0))
gltf.shape("housing", box((-0.5, 0.6, -0.5), (0.5, 0.78, 0.5)), black)
gltf.shape("lamp", level(LAMP_HALF, LAMP_HEIGHT, True), gltf.lambert("lamp", [0.0, 0.0, 0.0], emission=[RADIANCE] * 3))
gltf.shape("ball", icosphere(0.35, 3, smooth=True), gltf.lambert("ball", [0.7, 0.25, 0.1]), translation=[1.0, 0.35, 0.7])
gltf.shape("cube", box((-1.5, 0.0, 0.0), (-0.95, 0.55, 0.55)), gltf.lambert("cube", [0.1, 0.3, 0.65]))
gltf.camera("camera", [0.0, 2.3, 4.2], target=(0.0, 0.35, 0.0), yfov=round(math.radians(40), 6), aspect=1.5)
finish(gltf.files(pathlib.Path(__file__).with_name("mirror-lamp.gltf")))
