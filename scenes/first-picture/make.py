# SPDX-License-Identifier: Apache-2.0
"""Makes first-picture.glb: a still life around a sunstone, the calcite with which sailors are said to have found the hidden
sun. Metres, at its real size."""
import math
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from gltf_writer import Gltf, finish, png
from shapes import Shape, add, chamfered, dot, icosphere, lathe, normalize, panel, rounded_disc, scale, smooth_profile, torus_knot

WOOD = 384  # pixels of the texture's side; it covers BOARD_UV metres
BOARD_UV = 0.5


def value_noise(seed, size):
    """Periodic lattice noise, -1 to 1, smooth between the points."""
    source = random.Random(seed)
    lattice = [[source.uniform(-1, 1) for _ in range(size)] for _ in range(size)]

    def at(x, y):
        i, j = math.floor(x), math.floor(y)
        fade = lambda t: t * t * (3 - 2 * t)
        u, v = fade(x - i), fade(y - j)
        row = lambda k: lattice[k % size][i % size] * (1 - u) + lattice[k % size][(i + 1) % size] * u
        return row(j) * (1 - v) + row(j + 1) * v
    return at


def wood():
    """Walnut: growth rings of a log that was cut lengthways, fine pores along the grain. 256 shades of one ramp."""
    bend, fibre, blotch = value_noise(1, 16), value_noise(2, 256), value_noise(3, 32)
    dark, light = (58, 33, 20), (150, 98, 60)
    palette = [tuple(round(a + (b - a) * k / 255) for a, b in zip(dark, light)) for k in range(256)]
    pixels = []
    for row in range(WOOD):
        for column in range(WOOD):
            x, y = column / WOOD, row / WOOD
            distance = math.hypot((y - 0.38) * 1.0 + 0.035 * bend(x * 2.2, y * 3.0), 0.16 + 0.05 * bend(x * 1.3 + 5, 0.5))
            ring = (distance * 26 + 0.3 * bend(x * 5, y * 9 + 3)) % 1.0
            late = ring ** 3 if ring < 0.92 else 0.92 ** 3 * (1 - ring) / 0.08  # dark late wood, then a sharp start
            shade = 0.78 - 0.55 * late + 0.10 * fibre(x * 14, y * 200) + 0.07 * blotch(x * 6, y * 14)
            pixels.append(round(255 * min(max(shade, 0.0), 1.0)))
    return png(WOOD, WOOD, palette, pixels)


def backdrop():
    """A paper sweep: floor, bend and wall in one sheet, smooth across."""
    profile, bend, back, steps = [(1.2, 0.0)], 0.35, -0.55, 20
    for i in range(steps + 1):
        a = math.pi / 2 * i / steps
        profile.append((back - bend * math.sin(a), bend - bend * math.cos(a)))
    profile.append((back - bend, 1.6))
    normals = [(0.0, 1.0)] + [(math.sin(math.pi / 2 * i / steps), math.cos(math.pi / 2 * i / steps)) for i in range(steps + 1)] + [(1.0, 0.0)]
    positions = [(x, y - 0.018, z) for z, y in profile for x in (-1.7, 1.7)]
    rows = [(0.0, ny, nz) for nz, ny in normals for _ in range(2)]
    triangles = [t for k in range(len(profile) - 1) for a in [2 * k] for t in ((a, a + 1, a + 3), (a, a + 3, a + 2))]
    return Shape(positions, triangles, rows).snapped()


def calcite(edge, turn):
    """The cleavage rhomb of Iceland spar: three edges at 101.9 degrees to each other. It lies on a face; its height above the ground is 0.1 mm."""
    angle = math.radians(101.9)
    c = math.cos(angle)
    a = (1.0, 0.0, 0.0)
    b = (c, 0.0, -math.sin(angle))
    x = c
    z = -(c - c * c) / math.sin(angle)
    up = (x, math.sqrt(1 - x * x - z * z), z)
    turned = [(math.cos(turn) * v[0] + math.sin(turn) * v[2], v[1], -math.sin(turn) * v[0] + math.cos(turn) * v[2]) for v in (a, b, up)]
    edges = [scale(v, s) for v, s in zip(turned, (edge, edge * 0.82, edge * 0.9))]
    corners = []
    for k in range(8):
        p = (0.0, 0.0001, 0.0)
        for bit, e in enumerate(edges):
            if k >> bit & 1:
                p = add(p, e)
        corners.append(p)
    middle = scale(tuple(map(sum, zip(*corners))), 1 / 8)
    corners = [add(p, (-middle[0], 0.0, -middle[2])) for p in corners]
    faces = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
    return chamfered(corners, faces, 0.0022)


def stand_on(shape, height):
    """Moved up or down so that its lowest point is at `height`."""
    return shape.moved((0.0, height - min(p[1] for p in shape.positions), 0.0)).snapped()


def turned(shape, axis, angle):
    axis = normalize(axis)

    def turn(v):  # Rodrigues
        k = dot(axis, v) * (1 - math.cos(angle))
        x = (axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2], axis[0] * v[1] - axis[1] * v[0])
        return add(scale(v, math.cos(angle)), add(scale(x, math.sin(angle)), scale(axis, k)))
    return Shape([turn(p) for p in shape.positions], shape.triangles, [turn(n) for n in shape.normals])


def main():
    gltf = Gltf("first-picture")
    paper = gltf.lambert("paper", [0.23, 0.29, 0.33], double_sided=True)
    walnut = gltf.material("walnut", roughness=0.42, texture=gltf.texture("walnut", wood()))
    limestone = gltf.material("limestone", [0.74, 0.70, 0.63], roughness=0.75)
    copper = gltf.material("copper", [0.93, 0.50, 0.33], metallic=1.0, roughness=0.3)
    gold = gltf.material("gold", [1.0, 0.74, 0.32], metallic=1.0, roughness=0.16)
    glaze = gltf.material("cobalt glaze", [0.012, 0.05, 0.26], roughness=0.08)
    unglazed = gltf.material("bisque", [0.80, 0.72, 0.62], roughness=0.7)
    sunstone = gltf.glass("sunstone", ior=1.6, attenuation=[1.0, 0.74, 0.36], distance=0.10, thickness=0.06)
    sea_glass = gltf.glass("sea glass", ior=1.5, attenuation=[0.20, 0.78, 0.68], distance=0.05, thickness=0.06)

    gltf.shape("backdrop", backdrop(), paper)
    gltf.shape("board", lathe(rounded_disc(0.215, -0.0175, 0.0, 0.006), 128, planar_uv=BOARD_UV), walnut)
    gltf.shape("plinth", lathe(rounded_disc(0.068, 0.0002, 0.014, 0.002, 4), 96), limestone, translation=[0.078, 0.0, 0.045])
    gltf.shape("sunstone", calcite(0.078, math.radians(322)).moved((0.0, 0.014, 0.0)).snapped(), sunstone, translation=[0.078, 0.0, 0.045])
    knot = turned(turned(torus_knot(2, 3, 0.040, 0.0185, 0.0125, 240, 28), (1, 0, 0), math.radians(80)), (0, 1, 0), math.radians(24))
    gltf.shape("knot", stand_on(knot, 0.0002), copper, translation=[-0.092, 0.0, -0.03])
    vase = [(0.020, 0.0003), (0.026, 0.003), (0.037, 0.030), (0.041, 0.060), (0.031, 0.098), (0.0155, 0.128), (0.0135, 0.146), (0.0185, 0.160)]
    inside = [(0.0185, 0.160), (0.0172, 0.1615), (0.0155, 0.160), (0.0105, 0.146), (0.0120, 0.128), (0.027, 0.098), (0.030, 0.060)]
    profile = smooth_profile(vase, 7) + smooth_profile(inside, 4)[1:]
    foot, floor = [(0.0, 0.0003, 0, -1), (0.020, 0.0003, 0, -1)], [(0.030, 0.060, 0, 1), (0.0, 0.060, 0, 1)]
    gltf.shape("vase", lathe(foot + profile + floor, 72), glaze, translation=[0.012, 0.0, -0.118])
    # One sphere for all: each is a mesh of its own material over the same accessors.
    sphere = icosphere(1.0, 4, smooth=True)
    attributes = {"POSITION": gltf.floats(sphere.positions, bounds=True), "NORMAL": gltf.floats(sphere.normals)}
    indices = gltf.indices(sphere.triangles)
    for name, material, radius, x, z in (("sea glass", sea_glass, 0.031, -0.052, 0.105), ("gold bead", gold, 0.0135, 0.003, 0.138),
                                         ("bisque bead", unglazed, 0.0095, -0.118, 0.098), ("small gold bead", gold, 0.0085, -0.098, 0.118)):
        mesh = gltf.mesh(name, {"attributes": attributes, "indices": indices, "material": material})
        gltf.node(name, mesh=mesh, scale=[radius] * 3, translation=[x, round(radius + 0.0002, 6), z])

    for name, place, size, emission in (
            ("key", (-0.78, 0.70, 0.48), (0.95, 0.95), (7.4, 5.8, 4.2)),
            ("sky", (0.1, 1.15, 0.15), (1.3, 0.9), (0.66, 0.78, 0.96)),
            ("rim", (0.74, 0.45, -0.36), (0.60, 0.70), (2.7, 3.1, 3.7)),
            ("room", (0.35, 0.75, 1.35), (1.5, 1.1), (0.55, 0.50, 0.44))):
        gltf.shape(name, panel(place, (0.02, 0.05, 0.02), *size, up=(0, 0, 1) if name == "sky" else (0, 1, 0)),
                   gltf.lambert(name, [0.0, 0.0, 0.0], emission=emission))
    gltf.camera("camera", [0.035, 0.215, 0.66], [0.0, 0.052, 0.0], yfov=0.40)
    finish(gltf.files(pathlib.Path(__file__).resolve().with_name("first-picture.glb")))


main()
