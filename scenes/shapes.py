# SPDX-License-Identifier: Apache-2.0
"""Shapes for the scenes, wound counter-clockwise seen from outside. Coordinates of curved ones are rounded to 2^-20, so that two C libraries
whose sine differs in its last bit give the same file."""
import math
from dataclasses import dataclass, field


def add(a, b): return tuple(x + y for x, y in zip(a, b))
def sub(a, b): return tuple(x - y for x, y in zip(a, b))
def scale(a, s): return tuple(x * s for x in a)
def dot(a, b): return sum(x * y for x, y in zip(a, b))
def cross(a, b): return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
def normalize(a): return scale(a, 1 / math.sqrt(dot(a, a)))
def snap(a): return tuple(round(x * 1048576) / 1048576 for x in a)


@dataclass
class Shape:
    positions: list
    triangles: list
    normals: list = field(default_factory=list)
    uvs: list = field(default_factory=list)
    colors: list = field(default_factory=list)

    def moved(self, by):
        return Shape([add(p, by) for p in self.positions], self.triangles, self.normals, self.uvs, self.colors)

    def flipped(self):
        return Shape(self.positions, [(a, c, b) for a, b, c in self.triangles], [scale(n, -1) for n in self.normals], self.uvs, self.colors)

    def snapped(self):
        return Shape([snap(p) for p in self.positions], self.triangles, [snap(n) for n in self.normals], [snap(u) for u in self.uvs], self.colors)

    def area(self):
        total = 0.0
        for a, b, c in self.triangles:
            n = cross(sub(self.positions[b], self.positions[a]), sub(self.positions[c], self.positions[a]))
            total += math.sqrt(dot(n, n)) / 2
        return total


def quad(a, b, c, d):
    return Shape([a, b, c, d], [(0, 1, 2), (0, 2, 3)])


def panel(centre, toward, width, height, up=(0, 1, 0)):
    """A rectangle that faces the point `toward`."""
    n = normalize(sub(toward, centre))
    x = normalize(cross(up, n))
    y = cross(n, x)
    corner = [add(centre, add(scale(x, sx * width / 2), scale(y, sy * height / 2))) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return quad(*corner).snapped()


def merged(*shapes):
    """Shapes without normals, uvs or colours as one."""
    positions, triangles = [], []
    for shape in shapes:
        triangles += [tuple(i + len(positions) for i in t) for t in shape.triangles]
        positions += shape.positions
    return Shape(positions, triangles)


def box(lower, upper):
    x, y, z = zip(lower, upper)
    p = [(x[i], y[j], z[k]) for k in (0, 1) for j in (0, 1) for i in (0, 1)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3)]
    return Shape(p, [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))])


def icosphere(radius, levels, smooth=False):
    """Each level splits every triangle of an icosahedron in four; all vertices lie on the sphere."""
    g = (1 + math.sqrt(5)) / 2
    points = [normalize(p) for p in [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g),
                                     (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
                 (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(levels):
        middles = {}

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(points)
                points.append(normalize(add(points[a], points[b])))
            return middles[key]
        triangles = [t for a, b, c in triangles
                     for ab, bc, ca in [(middle(a, b), middle(b, c), middle(c, a))]
                     for t in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))]
    return Shape([scale(p, radius) for p in points], triangles, list(points) if smooth else []).snapped()


def lathe(profile, segments, planar_uv=None):
    """Turns a profile of (radius, height, normal's radius, normal's height) about +y, from the lowest ring to the highest; a ring of radius 0
    is a pole. Two rings in one place with two normals make a sharp edge. planar_uv: metres of a texture's side, seen from above."""
    positions, normals, rings, triangles = [], [], [], []
    for r, y, nr, ny in profile:
        ring = []
        for i in range(segments if r > 0 else 1):
            angle = 2 * math.pi * i / segments
            c, s = math.cos(angle), math.sin(angle)
            ring.append(len(positions))
            positions.append((r * c, y, -r * s))
            normals.append(normalize((nr * c, ny, -nr * s)) if r > 0 else (0.0, math.copysign(1, ny), 0.0))
        rings.append(ring)
    for low, high, a, b in zip(rings, rings[1:], profile, profile[1:]):
        if a[:2] == b[:2]:
            continue
        for i in range(segments):
            j = (i + 1) % segments
            if len(low) > 1:
                triangles.append((low[i], low[j], high[j % len(high)]))
            if len(high) > 1:
                triangles.append((low[i % len(low)], high[j], high[i]))
    uvs = [(0.5 + p[0] / planar_uv, 0.5 + p[2] / planar_uv) for p in positions] if planar_uv else []
    return Shape(positions, triangles, normals, uvs).snapped()


def smooth_profile(points, per_span=8):
    """A Catmull-Rom curve through (radius, height), with normals, for `lathe`."""
    padded = [sub(scale(points[0], 2), points[1]), *points, sub(scale(points[-1], 2), points[-2])]
    profile = []
    for k in range(len(points) - 1):
        p0, p1, p2, p3 = padded[k: k + 4]
        for i in range(per_span + (k == len(points) - 2)):
            t = i / per_span
            at, slope = [], []
            for a, b, c, d in zip(p0, p1, p2, p3):
                at.append(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t ** 3))
                slope.append(0.5 * ((c - a) + 2 * (2 * a - 5 * b + 4 * c - d) * t + 3 * (3 * b - a - 3 * c + d) * t * t))
            profile.append((round(max(at[0], 0.0), 9), round(at[1], 9), slope[1], -slope[0]))
    return profile


def rounded_disc(radius, bottom, top, fillet, steps=6):
    """A profile for `lathe`: a closed disc whose upper edge is rounded."""
    profile = [(0.0, bottom, 0, -1), (radius, bottom, 0, -1), (radius, bottom, 1, 0)]
    for i in range(steps + 1):
        a = math.pi / 2 * i / steps
        profile.append((radius - fillet + fillet * math.cos(a), top - fillet + fillet * math.sin(a), math.cos(a), math.sin(a)))
    return profile + [(0.0, top, 0, 1)]


def torus_knot(p, q, radius, swing, tube, along, around, ridges=0, depth=0.0, twist=0):
    """A tube around the (p, q) torus knot, its frame carried without twist and the remaining angle spread evenly, so that the seam closes.
    `ridges` waves of `depth` run around the tube and wind `twist` times on the way."""
    def centre(t):
        r = radius + swing * math.cos(q * t)
        return (r * math.cos(p * t), swing * math.sin(q * t), r * math.sin(p * t))
    points = [centre(2 * math.pi * i / along) for i in range(along)]
    tangents = [normalize(sub(points[(i + 1) % along], points[i - 1])) for i in range(along)]
    frame = normalize(cross(tangents[0], (0, 1, 0)))
    frames = []
    for i in range(along + 1):  # parallel transport
        t = tangents[i % along]
        frame = normalize(sub(frame, scale(t, dot(frame, t))))
        frames.append(frame)
    t = tangents[0]
    leftover = math.atan2(dot(cross(frames[0], frames[along]), t), dot(frames[0], frames[along]))

    def at(i, j):
        s = i / along
        t, n = tangents[i % along], frames[i % along]
        b = cross(t, n)
        angle = 2 * math.pi * j / around - leftover * s
        wave = math.cos(ridges * 2 * math.pi * j / around + twist * 2 * math.pi * s) if ridges else 0.0
        r = tube * (1 + depth * wave)
        return add(points[i % along], add(scale(n, r * math.cos(angle)), scale(b, r * math.sin(angle))))
    # The ring after the last is the first: at(along, j) == at(0, j) up to rounding, since leftover has been taken back.
    grid = [[at(i, j) for j in range(around)] for i in range(along)]
    positions, normals, triangles = [], [], []
    for i in range(along):
        for j in range(around):
            du = sub(grid[(i + 1) % along][j], grid[i - 1][j])
            dv = sub(grid[i][(j + 1) % around], grid[i][j - 1])
            positions.append(grid[i][j])
            normals.append(normalize(cross(dv, du)))
    for i in range(along):
        for j in range(around):
            a, b = i * around + j, i * around + (j + 1) % around
            c, d = (i + 1) % along * around + j, (i + 1) % along * around + (j + 1) % around
            triangles += [(a, b, d), (a, d, c)]
    return Shape(positions, triangles, normals).snapped()


def chamfered(corners, faces, width):
    """A convex solid of quads whose edges are cut off: each face shrinks by `width` within its plane, strips and small triangles join them.
    Shaded flat."""
    middle = scale(tuple(map(sum, zip(*corners))), 1 / len(corners))
    positions, triangles, inset = [], [], {}

    def face(points):
        n = cross(sub(points[1], points[0]), sub(points[2], points[0]))
        if dot(n, sub(points[0], middle)) < 0:
            points = points[::-1]
        base = len(positions)
        positions.extend(points)
        triangles.extend((base, base + k, base + k + 1) for k in range(1, len(points) - 1))
    for f, loop in enumerate(faces):
        ring = []
        for k, corner in enumerate(loop):
            p, before, after = corners[corner], corners[loop[k - 1]], corners[loop[(k + 1) % 4]]
            u, v = normalize(sub(before, p)), normalize(sub(after, p))
            sine = math.sqrt(1 - dot(u, v) ** 2)
            inset[f, corner] = add(p, scale(add(u, v), width / sine))
            ring.append(inset[f, corner])
        face(ring)
    for f, first in enumerate(faces):
        for g in range(f + 1, len(faces)):
            shared = [c for c in first if c in faces[g]]
            if len(shared) == 2:
                a, b = shared
                face([inset[f, a], inset[f, b], inset[g, b], inset[g, a]])
    for corner in range(len(corners)):
        face([inset[f, corner] for f, loop in enumerate(faces) if corner in loop])
    return Shape(positions, triangles).snapped()
