# SPDX-License-Identifier: Apache-2.0
"""Makes veach-mis.gltf: four plates and four lamps after [Veach95, fig. 2], with dimensions of our own."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from gltf_writer import Gltf, finish
from shapes import Shape, add, box, cross, icosphere, normalize, quad, scale, snap, sub

EYE, TARGET = (0.0, 2.2, 9.5), (0.0, 1.85, 0.0)
LAMPS = (0.0, 4.2, -1.6)  # the middle of the row
SPACING = 2.1
RADII = (0.0333, 0.1, 0.3, 0.8)
TINTS = ((1.0, 0.72, 0.45), (1.0, 0.95, 0.6), (0.65, 1.0, 0.75), (0.55, 0.75, 1.0))
POWER = 20.0   # of each lamp, as luminance: pi * L * area
ALPHAS = (0.004, 0.02, 0.06, 0.15)  # of GGX, from the farthest plate to the nearest
PLATES = ((1.75, -1.0), (1.15, 0.75), (0.62, 2.2), (0.2, 3.4))  # height and z of each plate's middle
SIZE = (7.2, 0.04, 1.05)


def plate(height, z):
    """A thin slab, tilted so that its middle mirrors the row of lamps into the camera."""
    middle = (0.0, height, z)
    normal = normalize(add(normalize(sub(EYE, middle)), normalize(sub(LAMPS, middle))))
    axes = ((1.0, 0.0, 0.0), normal, cross((1.0, 0.0, 0.0), normal))
    slab = box(tuple(-s / 2 for s in SIZE), tuple(s / 2 for s in SIZE))
    turn = [snap(add(middle, add(scale(axes[0], p[0]), add(scale(axes[1], p[1]), scale(axes[2], p[2]))))) for p in slab.positions]
    return Shape(turn, slab.triangles)


def luminance(rgb):
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]


gltf = Gltf("veach-mis")
wall = gltf.lambert("wall", [0.3, 0.3, 0.3], double_sided=True)
gltf.shape("floor", quad((-12.0, -0.35, 12.0), (12.0, -0.35, 12.0), (12.0, -0.35, -4.0), (-12.0, -0.35, -4.0)), wall)
gltf.shape("back wall", quad((-12.0, -0.35, -4.0), (12.0, -0.35, -4.0), (12.0, 10.0, -4.0), (-12.0, 10.0, -4.0)), wall)
for alpha, (height, z) in zip(ALPHAS, PLATES):
    steel = gltf.material(f"plate {alpha}", [0.7, 0.7, 0.7], metallic=1.0, roughness=round(math.sqrt(alpha), 6))
    gltf.shape(f"plate {alpha}", plate(height, z), steel)
for k, (radius, tint) in enumerate(zip(RADII, TINTS)):
    sphere = icosphere(radius, 2)
    radiance = POWER / (math.pi * sphere.area() * luminance(tint))
    emission = [round(radiance * t, 4) for t in tint]
    lamp = gltf.lambert(f"lamp {radius}", [0.0, 0.0, 0.0], emission=emission)
    gltf.shape(f"lamp {radius}", sphere, lamp, translation=[round(LAMPS[0] + (k - 1.5) * SPACING, 6), LAMPS[1], LAMPS[2]])
    print(f"lamp of radius {radius}: area {sphere.area():.6f}, radiance {emission}")
gltf.camera("camera", EYE, TARGET, yfov=0.7, aspect=1.5)
finish(gltf.files(pathlib.Path(__file__).resolve().with_name("veach-mis.gltf")))
