# SPDX-License-Identifier: Apache-2.0
"""Makes the scene after the figure of Cook, Porter and Carpenter: billiard balls in motion. README.md says what it shows."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from gltf_writer import Gltf, finish, png

HERE = pathlib.Path(__file__).resolve().parent
RADIUS = 0.028
OPEN = 0.25  # seconds that the shutter is open; keys stand at eighths of them

# 5 x 7 dots, rows from the top.
DIGITS = {
    "1": ["00100", "01100", "00100", "00100", "00100", "00100", "01110"],
    "4": ["00010", "00110", "01010", "10010", "11111", "00010", "00010"],
    "8": ["01110", "10001", "10001", "01110", "10001", "10001", "01110"],
    "9": ["01110", "10001", "10001", "01111", "00001", "00010", "01100"],
}
WHITE, BLACK = (240, 235, 220), (12, 12, 12)


def ball_picture(digit, color, striped):
    """As an environment's map lies around a sphere, seen from outside and so mirrored: a number in a white disk on either side."""
    width, height = 160, 80
    pixels = []
    for y in range(height):
        for x in range(width):
            longitude, latitude = 2 * math.pi * (x + 0.5) / width, math.pi * (0.5 - (y + 0.5) / height)
            side = (longitude + math.pi / 2) % math.pi - math.pi / 2  # from u = 0, 0.5: towards -x and +x
            right, up = -math.sin(side) * math.cos(latitude), math.sin(latitude)
            texel = 1 if not striped or abs(up) < 0.55 else 0
            if math.hypot(right, up) < 0.42 and math.cos(side) * math.cos(latitude) > 0:
                column, row = math.floor(right / 0.095 + 2.5), math.floor(3.5 - up / 0.095)
                texel = 2 if 0 <= column < 5 and 0 <= row < 7 and DIGITS[digit][row][column] == "1" else 0
            pixels.append(texel)
    return png(width, height, [WHITE, color, BLACK], pixels)


gltf = Gltf("cook")
cloth = gltf.lambert("cloth", (0.03, 0.22, 0.10), double_sided=True)
wood = gltf.material("wood", (0.18, 0.07, 0.03), roughness=0.25, double_sided=True)
wall = gltf.lambert("wall", (0.45, 0.35, 0.25), double_sided=True)
lamp = gltf.lambert("lamp", (0.0, 0.0, 0.0), emission=(34.0, 31.0, 26.0))
window = gltf.lambert("window", (0.0, 0.0, 0.0), emission=(2.2, 2.8, 3.6))

gltf.flat("cloth", "quad", cloth, {"size": [1.4, 1.4]})
gltf.flat("rail", "quad", wood, {"size": [1.4, 0.09]}, translation=[0.0, 0.045, -0.34], rotation=[0.7071067811865476, 0.0, 0.0, 0.7071067811865476])
gltf.flat("rail's top", "quad", wood, {"size": [1.4, 0.1]}, translation=[0.0, 0.09, -0.39])
gltf.flat("floor", "quad", wall, {"size": [8.0, 8.0]}, translation=[0.0, -0.8, 0.0])
gltf.flat("ceiling", "quad", wall, {"size": [8.0, 8.0]}, translation=[0.0, 2.4, 0.0])
ROTATIONS = {"back": [0.7071067811865476, 0, 0, 0.7071067811865476], "front": [-0.7071067811865476, 0, 0, 0.7071067811865476],
             "left": [0, 0, -0.7071067811865476, 0.7071067811865476], "right": [0, 0, 0.7071067811865476, 0.7071067811865476]}
PLACES = {"back": [0.0, 0.8, -4.0], "front": [0.0, 0.8, 4.0], "left": [-4.0, 0.8, 0.0], "right": [4.0, 0.8, 0.0]}
SIZES = {"back": [8.0, 3.2], "front": [8.0, 3.2], "left": [3.2, 8.0], "right": [3.2, 8.0]}
for side in PLACES:
    gltf.flat(side, "quad", wall, {"size": SIZES[side]}, translation=PLACES[side], rotation=ROTATIONS[side])
# Panes of windows in front, behind the camera: what the balls mirror.
for column in range(3):
    for row in range(2):
        gltf.flat("pane", "quad", window, {"size": [0.72, 0.72]}, translation=[-0.8 + 0.8 * column, 0.6 + 0.8 * row, 3.95], rotation=ROTATIONS["front"])
for x in (-0.32, 0.32):
    gltf.flat("lamp", "quad", lamp, {"size": [0.22, 0.22]}, translation=[x, 0.85, -0.05], rotation=[1.0, 0.0, 0.0, 0.0])


def turn(axis, angle):
    s = math.sin(angle / 2)
    return tuple(round(x, 7) for x in (axis[0] * s, axis[1] * s, axis[2] * s, math.cos(angle / 2)))


def times(a, b):
    """The rotation b, then a."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def unit(q):
    return tuple(x / math.sqrt(sum(y * y for y in q)) for x in q)


CHANNELS = []


def ball(name, material, way, facing):
    """way: [(eighth of the shutter's time, x, z)]. A ball that moves rolls."""
    rotation = facing
    keys = []
    for k, (eighth, x, z) in enumerate(way):
        if k:
            dx, dz = x - way[k - 1][1], z - way[k - 1][2]
            distance = math.hypot(dx, dz)
            if distance > 0:
                rotation = unit(times(turn((dz / distance, 0.0, -dx / distance), distance / RADIUS), rotation))
        keys.append((eighth * OPEN / 8, (x, RADIUS, z), rotation))
    node = gltf.sphere(name, RADIUS, material, translation=list(keys[0][1]), rotation=[round(x, 9) for x in keys[0][2]])
    if len(keys) > 1:
        CHANNELS.append((node, keys))


def numbered(digit, color, striped=False):
    return gltf.material(digit, texture=gltf.texture(digit, ball_picture(digit, color, striped)), roughness=0.0)


def towards(degrees, tilt):
    """The number turned from +x towards the camera by so much, then up."""
    return unit(times(turn((0.0, 1.0, 0.0), math.radians(degrees)), turn((0.0, 0.0, 1.0), math.radians(tilt))))


white = gltf.material("white", (0.85, 0.82, 0.74), roughness=0.0)
ball("1", numbered("1", (225, 170, 20)), [(0, -0.105, 0.075)], towards(-100.0, 22.0))
ball("9", numbered("9", (225, 170, 20), striped=True), [(0, -0.075, -0.075), (4, -0.025, -0.035), (8, -0.055, 0.025)], towards(-75.0, 20.0))
ball("8", numbered("8", (15, 15, 15)), [(0, 0.02, 0.08), (2, 0.02, 0.08), (6, 0.062, 0.03), (8, 0.062, 0.03)], towards(-85.0, 25.0))
ball("4", numbered("4", (85, 25, 110)), [(0, 0.135, -0.06), (7, 0.135, -0.06), (8, 0.1307, -0.0795)], towards(-95.0, 22.0))
ball("cue ball", white, [(0, 0.175, 0.12), (7, 0.1472, -0.0053), (8, 0.149, -0.001)], (0.0, 0.0, 0.0, 1.0))
gltf.animation("stroke", CHANNELS)
gltf.camera("camera", [0.02, 0.26, 0.43], target=[0.02, 0.0, 0.0], yfov=0.66, aspect=4 / 3)
finish(gltf.files(HERE / "cook.gltf"))
