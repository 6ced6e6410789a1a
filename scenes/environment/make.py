# SPDX-License-Identifier: Apache-2.0
"""Makes environment.glb, a ridged torus knot of 98,304 triangles on a ground disc, and sky.hdr, a clear sky with its sun [Preetham99]."""
import math
import pathlib
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from gltf_writer import SHORT, Gltf, finish
from shapes import lathe, rounded_disc, torus_knot

HERE = pathlib.Path(__file__).resolve().parent

# The knot. Its vertices are quantised to 16 bytes, and its 24 sections share one list of indices, since each is the same grid.
ALONG, AROUND, SECTIONS = 768, 64, 24

# The sky. A unit of radiance is 20 kcd/m^2, so that a white sheet on the ground comes out near 0.8.
WIDTH, HEIGHT = 512, 256
TURBIDITY = 3.0
SUN_ELEVATION, SUN_AZIMUTH = math.radians(32.0), math.radians(128.0)  # azimuth from +x towards +z
SUN_NORMAL_ILLUMINANCE = 82.0  # klx, a clear day with the sun this high
SUN_RADIUS = math.radians(0.53 / 2)
KCD_PER_UNIT = 20.0
GROUND_ALBEDO = (0.22, 0.20, 0.17)


def knot(gltf, material):
    shape = torus_knot(2, 3, 0.62, 0.27, 0.15, ALONG, AROUND, ridges=6, depth=0.14, twist=10)
    size = max(abs(c) for p in shape.positions for c in p)
    ring = lambda values: values + values[:AROUND]  # the first ring again after the last
    rows = ring([tuple(round(c / size * 32767) for c in p) for p in shape.positions])
    normals = ring([tuple(round(c * 32767) for c in n) for n in shape.normals])
    data = b"".join(struct.pack("<3hxx3hxx", *p, *n) for p, n in zip(rows, normals))
    view = gltf.view(data, 34962, stride=16)
    per_section = ALONG // SECTIONS
    grid = [(i * AROUND + j, i * AROUND + (j + 1) % AROUND, (i + 1) * AROUND + j, (i + 1) * AROUND + (j + 1) % AROUND)
            for i in range(per_section) for j in range(AROUND)]
    indices = gltf.indices([t for a, b, c, d in grid for t in ((a, b, d), (a, d, c))])
    primitives = []
    for section in range(SECTIONS):
        first, count = section * per_section * AROUND, (per_section + 1) * AROUND
        position = gltf.accessor(view, SHORT, rows[first: first + count], offset=16 * first, bounds=True, normalized=True)
        normal = gltf.accessor(view, SHORT, normals[first: first + count], offset=16 * first + 8, normalized=True)
        primitives.append({"attributes": {"POSITION": position, "NORMAL": normal}, "indices": indices, "material": material})
    gltf.uses("KHR_mesh_quantization", required=True)
    tilt = math.radians(62)  # stands on its edge, leaning back a little
    gltf.node("knot", mesh=gltf.mesh("knot", *primitives), scale=[size] * 3, translation=[0.0, 0.98, 0.0],
              rotation=[round(math.sin(tilt / 2), 9), 0.0, 0.0, round(math.cos(tilt / 2), 9)])


def scene():
    gltf = Gltf("environment")
    bronze = gltf.material("bronze", [0.83, 0.52, 0.30], metallic=1.0, roughness=0.32)
    stone = gltf.material("stone", [0.42, 0.40, 0.37], roughness=0.85)
    knot(gltf, bronze)
    gltf.shape("ground", lathe(rounded_disc(3.0, -0.2, 0.0, 0.03), 96), stone)
    gltf.camera("camera", [2.1, 1.55, 3.1], [0.0, 0.86, 0.0], yfov=0.62)
    return gltf


def perez(coefficients, cos_zenith, gamma):
    a, b, c, d, e = coefficients
    return (1 + a * math.exp(b / max(cos_zenith, 0.01))) * (1 + c * math.exp(d * gamma) + e * math.cos(gamma) ** 2)


class Sky:
    """Luminance (kcd/m^2) and chromaticity of a clear sky [Preetham99, appendix A.2]."""

    def __init__(self, turbidity, sun_zenith):
        t, s = turbidity, sun_zenith
        self.sun_zenith = s
        self.lobes = ((0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771, -0.0670 * t + 0.3703),
                      (-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989, -0.0033 * t + 0.0452),
                      (-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537, -0.0109 * t + 0.0529))
        chi = (4 / 9 - t / 120) * (math.pi - 2 * s)

        def cubic(k3, k2, k1, k0):
            return ((k3 * s + k2) * s + k1) * s + k0
        self.zenith = ((4.0453 * t - 4.9710) * math.tan(chi) - 0.2155 * t + 2.4192,
                       t * t * cubic(0.00166, -0.00375, 0.00209, 0) + t * cubic(-0.02903, 0.06377, -0.03202, 0.00394)
                       + cubic(0.11693, -0.21196, 0.06052, 0.25886),
                       t * t * cubic(0.00275, -0.00610, 0.00317, 0) + t * cubic(-0.04214, 0.08970, -0.04153, 0.00516)
                       + cubic(0.15346, -0.26756, 0.06670, 0.26688))

    def rgb(self, cos_zenith, gamma):
        lum, x, y = (z * perez(k, cos_zenith, gamma) / perez(k, 1.0, self.sun_zenith) for z, k in zip(self.zenith, self.lobes))
        big_x, big_z = x / y * lum, (1 - x - y) / y * lum
        return (max(3.2404542 * big_x - 1.5371385 * lum - 0.4985314 * big_z, 0.0), max(-0.9692660 * big_x + 1.8760108 * lum + 0.0415560 * big_z, 0.0),
                max(0.0556434 * big_x - 0.2040259 * lum + 1.0572252 * big_z, 0.0))


def direction(u, v):
    """Of the map's point (u, v) in turns and half turns, as docs/conventions.md has it."""
    phi, theta = 2 * math.pi * (u - 0.5), math.pi * v
    return (math.sin(theta) * math.cos(phi), math.cos(theta), math.sin(theta) * math.sin(phi))


def solid_angle(row):
    return 2 * math.pi / WIDTH * (math.cos(math.pi * row / HEIGHT) - math.cos(math.pi * (row + 1) / HEIGHT))


def sun_coverage(sun):
    """{(row, column): share of the sun's disc in that pixel}, by points spread evenly over the disc."""
    side = (-math.sin(SUN_AZIMUTH), 0.0, math.cos(SUN_AZIMUTH))
    above = (-math.sin(SUN_ELEVATION) * math.cos(SUN_AZIMUTH), math.cos(SUN_ELEVATION), -math.sin(SUN_ELEVATION) * math.sin(SUN_AZIMUTH))
    shares, count = {}, 4096
    for k in range(count):  # a sunflower
        r, a = math.tan(SUN_RADIUS) * math.sqrt((k + 0.5) / count), k * math.pi * (3 - math.sqrt(5))
        d = [s + r * math.cos(a) * x + r * math.sin(a) * y for s, x, y in zip(sun, side, above)]
        n = math.sqrt(sum(c * c for c in d))
        u, v = 0.5 + math.atan2(d[2], d[0]) / (2 * math.pi), math.acos(d[1] / n) / math.pi
        pixel = (int(v * HEIGHT), int(u * WIDTH))
        shares[pixel] = shares.get(pixel, 0) + 1 / count
    return shares


def sky_map():
    sky = Sky(TURBIDITY, math.pi / 2 - SUN_ELEVATION)
    sun = (math.cos(SUN_ELEVATION) * math.cos(SUN_AZIMUTH), math.sin(SUN_ELEVATION), math.cos(SUN_ELEVATION) * math.sin(SUN_AZIMUTH))
    rows, down = [], [0.0] * 3  # down: what falls on level ground, in units
    for row in range(HEIGHT // 2):
        line = []
        for column in range(WIDTH):
            d = direction((column + 0.5) / WIDTH, (row + 0.5) / HEIGHT)
            gamma = math.acos(min(sum(a * b for a, b in zip(d, sun)), 1.0))
            rgb = [x / KCD_PER_UNIT for x in sky.rgb(d[1], gamma)]
            down = [t + x * d[1] * solid_angle(row) for t, x in zip(down, rgb)]
            line.append(rgb)
        rows.append(line)
    tint = (1.10, 0.98, 0.82)  # of sunlight this high, luminance 1
    tint = [t / (0.2126 * tint[0] + 0.7152 * tint[1] + 0.0722 * tint[2]) for t in tint]
    for (row, column), share in sorted(sun_coverage(sun).items()):
        added = SUN_NORMAL_ILLUMINANCE / KCD_PER_UNIT * share / solid_angle(row)
        rows[row][column] = [x + added * t for x, t in zip(rows[row][column], tint)]
    down = [t + SUN_NORMAL_ILLUMINANCE / KCD_PER_UNIT * math.sin(SUN_ELEVATION) * x for t, x in zip(down, tint)]
    ground = [t * a / math.pi for t, a in zip(down, GROUND_ALBEDO)]
    return rows + [[ground] * WIDTH for _ in range(HEIGHT // 2)]


def rgbe(rgb):
    largest = max(rgb)
    if largest < 1e-32:
        return (0, 0, 0, 0)
    mantissa, exponent = math.frexp(largest)
    factor = mantissa * 256 / largest
    return (*(min(int(c * factor + 0.5), 255) for c in rgb), exponent + 128)


def from_rgbe(r, g, b, e):
    return [c * math.ldexp(1.0, e - 136) for c in (r, g, b)]


def run_lengths(values):
    """One channel of a row: runs of 3 to 127 equal bytes, literals between them."""
    out, literal, i = bytearray(), [], 0

    def flush():
        for at in range(0, len(literal), 128):
            part = literal[at: at + 128]
            out.extend([len(part), *part])
        literal.clear()
    while i < len(values):
        run = 1
        while i + run < len(values) and run < 127 and values[i + run] == values[i]:
            run += 1
        if run >= 3:
            flush()
            out.extend([128 + run, values[i]])
        else:
            literal.extend(values[i: i + run])
        i += run
    flush()
    return bytes(out)


def radiance_file(rows):
    data = bytearray(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (HEIGHT, WIDTH))
    total = [0.0] * 3
    for number, row in enumerate(rows):
        pixels = [rgbe(rgb) for rgb in row]
        data += struct.pack(">BBH", 2, 2, WIDTH)
        for channel in range(4):
            data += run_lengths([p[channel] for p in pixels])
        if number < HEIGHT // 2:
            cosine = math.cos(math.pi * (number + 0.5) / HEIGHT)
            for p in pixels:
                total = [t + c * cosine * solid_angle(number) for t, c in zip(total, from_rgbe(*p))]
    print("irradiance on level ground", [round(t, 4) for t in total], " brightest", [round(c, 1) for c in max(map(max, rows))])
    return bytes(data)


finish(scene().files(HERE / "environment.glb") | {HERE / "sky.hdr": radiance_file(sky_map())})
