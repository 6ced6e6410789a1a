# SPDX-License-Identifier: Apache-2.0
"""Makes cornell.gltf: the measured box of the Program of Computer Graphics, Cornell University, as RGB [CornellBox].
https://www.graphics.cornell.edu/online/box/data.html"""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from gltf_writer import Gltf, finish
from shapes import Shape, box, merged, quad

METRES = 0.01  # a published millimetre: the box is ten times its real size, so that a room of 5.5 m comes of it

# Reflectances at 400, 404, ... 700 nm, as published.
WHITE = [
    .343, .445, .551, .624, .665, .687, .708, .723, .715, .710, .745, .758, .739, .767, .777, .765, .751, .745, .748, .729,
    .745, .757, .753, .750, .746, .747, .735, .732, .739, .734, .725, .721, .733, .725, .732, .743, .744, .748, .728, .716,
    .733, .726, .713, .740, .754, .764, .752, .736, .734, .741, .740, .732, .745, .755, .751, .744, .731, .733, .744, .731,
    .712, .708, .729, .730, .727, .707, .703, .729, .750, .760, .751, .739, .724, .730, .740, .737]
GREEN = [
    .092, .096, .098, .097, .098, .095, .095, .097, .095, .094, .097, .098, .096, .101, .103, .104, .107, .109, .112, .115,
    .125, .140, .160, .187, .229, .285, .343, .390, .435, .464, .472, .476, .481, .462, .447, .441, .426, .406, .373, .347,
    .337, .314, .285, .277, .266, .250, .230, .207, .186, .171, .160, .148, .141, .136, .130, .126, .123, .121, .122, .119,
    .114, .115, .117, .117, .118, .120, .122, .128, .132, .139, .144, .146, .150, .152, .157, .159]
RED = [
    .040, .046, .048, .053, .049, .050, .053, .055, .057, .056, .059, .057, .061, .061, .060, .062, .062, .062, .061, .062,
    .060, .059, .057, .058, .058, .058, .056, .055, .056, .059, .057, .055, .059, .059, .058, .059, .061, .061, .063, .063,
    .067, .068, .072, .080, .090, .099, .124, .154, .192, .255, .287, .349, .402, .443, .487, .513, .558, .584, .620, .606,
    .609, .651, .612, .610, .650, .638, .627, .620, .630, .628, .642, .639, .657, .639, .635, .642]
LAMP = [(400, 0.0), (500, 8.0), (600, 15.6), (700, 18.4)]
LAMP_REFLECTANCE = 0.78

FLOOR = [(552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)]
CEILING = [(556.0, 548.8, 0), (556.0, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0)]
BACK = [(549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556.0, 548.8, 559.2)]
RIGHT = [(0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)]
LEFT = [(552.8, 0, 0), (549.6, 0, 559.2), (556.0, 548.8, 559.2), (556.0, 548.8, 0)]
LIGHT = [(343, 548.8, 227), (343, 548.8, 332), (213, 548.8, 332), (213, 548.8, 227)]
SHORT = [
    [(130, 165, 65), (82, 165, 225), (240, 165, 272), (290, 165, 114)],
    [(290, 0, 114), (290, 165, 114), (240, 165, 272), (240, 0, 272)],
    [(130, 0, 65), (130, 165, 65), (290, 165, 114), (290, 0, 114)],
    [(82, 0, 225), (82, 165, 225), (130, 165, 65), (130, 0, 65)],
    [(240, 0, 272), (240, 165, 272), (82, 165, 225), (82, 0, 225)]]
TALL = [
    [(423, 330, 247), (265, 330, 296), (314, 330, 456), (472, 330, 406)],
    [(423, 0, 247), (423, 330, 247), (472, 330, 406), (472, 0, 406)],
    [(472, 0, 406), (472, 330, 406), (314, 330, 456), (314, 0, 456)],
    [(314, 0, 456), (314, 330, 456), (265, 330, 296), (265, 0, 296)],
    [(265, 0, 296), (265, 330, 296), (423, 330, 247), (423, 0, 247)]]


# Colour matching functions of the observer [CIE31] at 400, 410, ... 700 nm.
CIE_1931 = [
    (0.01431, 0.000396, 0.06785), (0.04351, 0.00121, 0.2074), (0.13438, 0.004, 0.6456), (0.2839, 0.0116, 1.3856),
    (0.34828, 0.023, 1.74706), (0.3362, 0.038, 1.77211), (0.2908, 0.06, 1.6692), (0.19536, 0.09098, 1.28764),
    (0.09564, 0.13902, 0.81295), (0.03201, 0.20802, 0.46518), (0.0049, 0.323, 0.272), (0.0093, 0.503, 0.1582),
    (0.06327, 0.71, 0.07825), (0.1655, 0.862, 0.04216), (0.2904, 0.954, 0.0203), (0.43345, 0.99495, 0.00875),
    (0.5945, 0.995, 0.0039), (0.7621, 0.952, 0.0021), (0.9163, 0.87, 0.00165), (1.0263, 0.757, 0.0011),
    (1.0622, 0.631, 0.0008), (1.0026, 0.503, 0.00034), (0.85445, 0.381, 0.00019), (0.6424, 0.265, 5e-05),
    (0.4479, 0.175, 2e-05), (0.2835, 0.107, 0), (0.1649, 0.061, 0), (0.0874, 0.032, 0),
    (0.04677, 0.017, 0), (0.0227, 0.00821, 0), (0.011359, 0.004102, 0)]


def cie_1931(nm):
    i = min((nm - 400) // 10, 29)
    f = (nm - 400 - 10 * i) / 10
    return [a + (b - a) * f for a, b in zip(CIE_1931[i], CIE_1931[i + 1])]


def lamp(nm):
    for (a, low), (b, high) in zip(LAMP, LAMP[1:]):
        if nm <= b:
            return low + (high - low) * (nm - a) / (b - a)


def rgb(spectrum):
    """Linear Rec. 709 of 76 values at 400 ... 700 nm, by the trapezium rule; a spectrum of 1 has luminance 1."""
    sums, unit = [0.0, 0.0, 0.0], 0.0
    for i, value in enumerate(spectrum):
        weight = 0.5 if i in (0, 75) else 1.0
        matching = cie_1931(400 + 4 * i)
        sums = [s + weight * value * m for s, m in zip(sums, matching)]
        unit += weight * matching[1]
    x, y, z = (s / unit for s in sums)
    return (3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
            0.0556434 * x - 0.2040259 * y + 1.0572252 * z)


def seen_under_lamp(reflectance):
    """The RGB by which this surface turns the lamp's RGB into that of the lamp's light reflected once: exact for one bounce."""
    emitted = [lamp(400 + 4 * i) for i in range(76)]
    return [round(a / b, 6) for a, b in zip(rgb([r * e for r, e in zip(reflectance, emitted)]), rgb(emitted))]


def irradiance_per_radiance(x, y, z):
    """E / L at an upward-facing point (published millimetres) that sees the whole light: pi times the form factor of four rectangles that have a
    corner above it."""
    h = 548.8 - y

    def corner(a, b):  # signed: the rectangle from the point's foot to (a, b)
        a, b = a / h, b / h
        return (a / math.sqrt(1 + a * a) * math.atan(b / math.sqrt(1 + a * a)) + b / math.sqrt(1 + b * b) * math.atan(a / math.sqrt(1 + b * b))) / 2
    x0, x1, z0, z1 = 213 - x, 343 - x, 227 - z, 332 - z
    return corner(x1, z1) - corner(x0, z1) - corner(x1, z0) + corner(x0, z0)


def metres(loop):
    return [tuple(round(c * METRES, 6) for c in p) for p in loop]


def ceiling_with_hole():
    """The light fills a hole, so that nothing is coplanar and the room stays closed: four trapezia share its corners."""
    outer, inner = CEILING, [LIGHT[0], LIGHT[1], LIGHT[2], LIGHT[3]]
    points = metres(outer + inner)
    return Shape(points, [t for k in range(4) for j in [(k + 1) % 4] for t in ((k, j, 4 + j), (k, 4 + j, 4 + k))])


def main():
    emission = [round(x, 6) for x in rgb([lamp(400 + 4 * i) for i in range(76)])]
    colors = {name: seen_under_lamp(table) for name, table in (("white", WHITE), ("green", GREEN), ("red", RED))}
    gltf = Gltf("cornell")
    white, green, red = (gltf.lambert(name, colors[name], double_sided=True) for name in ("white", "green", "red"))
    light = gltf.lambert("light", [LAMP_REFLECTANCE] * 3, emission=emission)
    gltf.shape("floor", quad(*metres(FLOOR)), white)
    gltf.shape("ceiling", ceiling_with_hole(), white)
    gltf.shape("back wall", quad(*metres(BACK)), white)
    gltf.shape("right wall", quad(*metres(RIGHT)), green)
    gltf.shape("left wall", quad(*metres(LEFT)), red)
    gltf.shape("light", quad(*metres(LIGHT)), light)
    gltf.shape("short block", merged(*(quad(*metres(face)) for face in SHORT)), white)
    gltf.shape("tall block", merged(*(quad(*metres(face)) for face in TALL)), white)
    gltf.camera("camera", [2.78, 2.73, -8.0], rotation=[0.0, 1.0, 0.0, 0.0], yfov=2 * math.atan(0.0125 / 0.035), aspect=1.0)

    area = 1.30 * 1.05
    print("radiance of the light", emission, " area", area, " power", [round(math.pi * area * x, 4) for x in emission])
    print("reflectances", colors)
    for place, height, pixel in (("floor", 0.0, (158, 473)), ("floor", 0.0, (190, 480)), ("short block's top", 165.0, (324, 335))):
        slope = [(1 - (p + 0.5) / 256) * 0.0125 / 0.035 for p in pixel]  # x and y per millimetre of depth, through the pixel's centre
        depth = (height - 273) / slope[1]
        point = (278 + depth * slope[0], height, depth - 800)
        ratio = irradiance_per_radiance(*point)
        reflected = [round(ratio * e * w / math.pi, 6) for e, w in zip(emission, colors["white"])]
        print(place, "pixel", pixel, "of 512x512: point", [round(c, 2) for c in point], "E/L", round(ratio, 7), "direct light reflected", reflected)
    finish(gltf.files(pathlib.Path(__file__).with_name("cornell.gltf")))


main()
