# SPDX-License-Identifier: Apache-2.0
"""Writes glTF 2.0 for the scripts beside the scenes: the same bytes on every run and machine, the standard library alone.

A script makes a `Gltf`, adds materials, meshes, nodes and a camera, and hands its files to `finish`, which writes them, or with --check compares
them with those that are there and exits with 1 where one differs."""
import json
import math
import pathlib
import struct
import sys

GENERATOR = "sunstone scenes"
COPYRIGHT = "sunstone authors, Apache-2.0 or CC0-1.0"

FLOAT, USHORT, UINT, SHORT = 5126, 5123, 5125, 5122
FORMATS = {FLOAT: "f", USHORT: "H", UINT: "I", SHORT: "h"}
WIDTHS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


def flat(rows):
    return [x for row in rows for x in row]


def as_float32(x):
    return struct.unpack("<f", struct.pack("<f", x))[0]


class Gltf:
    def __init__(self, name):
        self.name = name
        self.bin = bytearray()
        self.json = {
            "asset": {"version": "2.0", "generator": GENERATOR, "copyright": COPYRIGHT},
            "scene": 0, "scenes": [{"name": name, "nodes": []}], "nodes": [], "meshes": [], "materials": [], "accessors": [], "bufferViews": [],
        }

    def add(self, key, value):
        self.json.setdefault(key, []).append(value)
        return len(self.json[key]) - 1

    def uses(self, extension, required=False):
        for key in ["extensionsUsed"] + (["extensionsRequired"] if required else []):
            if extension not in self.json.setdefault(key, []):
                self.json[key] = sorted(self.json[key] + [extension])

    def view(self, data, target=None, stride=None):
        while len(self.bin) % 4:
            self.bin.append(0)
        view = {"buffer": 0, "byteOffset": len(self.bin), "byteLength": len(data)}
        if stride:
            view["byteStride"] = stride
        if target:
            view["target"] = target
        self.bin += data
        return self.add("bufferViews", view)

    def accessor(self, view, kind, rows, offset=0, bounds=False, normalized=False):
        accessor = {"bufferView": view, "componentType": kind, "count": len(rows), "type": WIDTHS[len(rows[0])]}
        if offset:
            accessor["byteOffset"] = offset
        if normalized:
            accessor["normalized"] = True
        if bounds:  # of the values as stored
            stored = as_float32 if kind == FLOAT else int
            accessor["min"] = [stored(min(column)) for column in zip(*rows)]
            accessor["max"] = [stored(max(column)) for column in zip(*rows)]
        return self.add("accessors", accessor)

    def floats(self, rows, bounds=False):
        data = struct.pack(f"<{len(rows) * len(rows[0])}f", *flat(rows))
        return self.accessor(self.view(data, 34962), FLOAT, rows, bounds=bounds)

    def indices(self, triangles):
        numbers = flat(triangles)
        kind = USHORT if max(numbers) < 65535 else UINT
        data = struct.pack(f"<{len(numbers)}{FORMATS[kind]}", *numbers)
        return self.accessor(self.view(data, 34963), kind, [(n,) for n in numbers])

    def primitive(self, shape, material):
        """`shape` has positions and triangles, and may have normals, uvs, colors (shapes.Shape). Without normals it is shaded flat."""
        attributes = {"POSITION": self.floats(shape.positions, bounds=True)}
        if shape.normals:
            attributes["NORMAL"] = self.floats(shape.normals)
        if shape.uvs:
            attributes["TEXCOORD_0"] = self.floats(shape.uvs)
        if shape.colors:
            attributes["COLOR_0"] = self.floats(shape.colors)
        return {"attributes": attributes, "indices": self.indices(shape.triangles), "material": material}

    def mesh(self, name, *primitives):
        return self.add("meshes", {"name": name, "primitives": list(primitives)})

    def node(self, name, **fields):
        node = self.add("nodes", {"name": name, **fields})
        self.json["scenes"][0]["nodes"].append(node)
        return node

    def shape(self, name, shape, material, **fields):
        return self.node(name, mesh=self.mesh(name, self.primitive(shape, material)), **fields)

    def sphere(self, name, radius, material, **fields):
        """An analytic sphere: of KHR_implicit_shapes, shown by sunstone's own extras (docs/conventions.md)."""
        self.uses("KHR_implicit_shapes")
        shapes = self.json.setdefault("extensions", {}).setdefault("KHR_implicit_shapes", {"shapes": []})["shapes"]
        shape = {"type": "sphere", "sphere": {"radius": radius}}
        if shape not in shapes:
            shapes.append(shape)
        return self.node(name, extras={"sunstone_shape": {"shape": shapes.index(shape), "material": material}}, **fields)

    def flat(self, name, kind, material, measures=None, **fields):
        """A disk ({"radius": r}), a quad ({"size": [x, z]}) or an infinite plane, its front towards the node's +y."""
        return self.node(name, extras={"sunstone_shape": {"type": kind, **(measures or {}), "material": material}}, **fields)

    def light(self, name, kind, color, intensity, **fields):
        self.uses("KHR_lights_punctual")
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append({"name": name, "type": kind, "color": list(color), "intensity": intensity})
        return self.node(name, extensions={"KHR_lights_punctual": {"light": len(lights) - 1}}, **fields)

    def material(self, name, color=(1, 1, 1), metallic=0.0, roughness=1.0, emission=None, extensions=None, texture=None, double_sided=False):
        pbr = {"baseColorFactor": [*color, 1.0], "metallicFactor": metallic, "roughnessFactor": roughness}
        if texture is not None:
            pbr["baseColorTexture"] = {"index": texture} if isinstance(texture, int) else texture
        material = {"name": name, "pbrMetallicRoughness": pbr}
        extensions = dict(extensions or {})
        if emission:
            strength = max(emission)
            if strength > 1:
                material["emissiveFactor"] = [x / strength for x in emission]
                extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
            else:
                material["emissiveFactor"] = list(emission)
        if extensions:
            material["extensions"] = extensions
            for extension in extensions:
                self.uses(extension)
        if double_sided:
            material["doubleSided"] = True
        return self.add("materials", material)

    def lambert(self, name, color, emission=None, double_sided=False):
        """Purely Lambertian: no specular lobe at all."""
        matt = {"KHR_materials_specular": {"specularFactor": 0.0}}
        return self.material(name, color, emission=emission, extensions=matt, double_sided=double_sided)

    def glass(self, name, roughness=0.0, ior=1.5, attenuation=None, distance=None, thickness=0.01, color=(1, 1, 1), volume=True):
        extensions = {"KHR_materials_transmission": {"transmissionFactor": 1.0}, "KHR_materials_ior": {"ior": ior}}
        if volume:
            extensions["KHR_materials_volume"] = {"thicknessFactor": thickness}
            if attenuation:
                extensions["KHR_materials_volume"] |= {"attenuationColor": list(attenuation), "attenuationDistance": distance}
        return self.material(name, color, roughness=roughness, extensions=extensions)

    def texture(self, name, png, wrap=10497, smooth=True):
        image = self.add("images", {"name": name, "mimeType": "image/png", "bufferView": self.view(png)})
        kind = 9729 if smooth else 9728
        sampler = self.add("samplers", {"magFilter": kind, "minFilter": kind, "wrapS": wrap, "wrapT": wrap})
        return self.add("textures", {"source": image, "sampler": sampler})

    def camera(self, name, position, target=None, rotation=None, yfov=None, aspect=None):
        perspective = {"yfov": yfov, "znear": 0.001}
        if aspect:
            perspective["aspectRatio"] = aspect
        camera = self.add("cameras", {"name": name, "type": "perspective", "perspective": perspective})
        rotation = rotation or look_rotation(position, target)
        return self.node(name, camera=camera, translation=list(position), rotation=list(rotation))

    def animation(self, name, moves):
        """moves: [(node, [(seconds, translation, rotation)])]. From key to key in straight lines, and turns along the shortest arc."""
        channels, samplers = [], []
        for node, keys in moves:
            input = self.accessor(self.view(struct.pack(f"<{len(keys)}f", *(key[0] for key in keys))), FLOAT, [(key[0],) for key in keys], bounds=True)
            for path, column in (("translation", 1), ("rotation", 2)):
                rows = [key[column] for key in keys]
                output = self.accessor(self.view(struct.pack(f"<{len(rows) * len(rows[0])}f", *flat(rows))), FLOAT, rows)
                samplers.append({"input": input, "output": output, "interpolation": "LINEAR"})
                channels.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})
        return self.add("animations", {"name": name, "channels": channels, "samplers": samplers})

    def files(self, path):
        """{path: bytes} of a .glb, or of a .gltf and its .bin."""
        path = pathlib.Path(path)
        document = {key: value for key, value in self.json.items() if value != []}
        if path.suffix == ".gltf":
            binary = path.with_suffix(".bin")
            document["buffers"] = [{"uri": binary.name, "byteLength": len(self.bin)}]
            return {path: pretty(document).encode() + b"\n", binary: bytes(self.bin)}
        document["buffers"] = [{"byteLength": len(self.bin)}]
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        data = bytes(self.bin) + b"\0" * (-len(self.bin) % 4)
        size = 12 + 8 + len(text) + 8 + len(data)
        return {path: struct.pack("<4sII", b"glTF", 2, size) + struct.pack("<I4s", len(text), b"JSON") + text
                + struct.pack("<I4s", len(data), b"BIN\0") + data}


def pretty(document):
    """JSON with short arrays and objects on one line."""
    def show(value, indent):
        line = json.dumps(value)
        if not isinstance(value, (dict, list)) or len(line) + indent < 120:
            return line
        pad = " " * (indent + 2)
        if isinstance(value, dict):
            return "{\n" + ",\n".join(f"{pad}{json.dumps(key)}: {show(item, indent + 2)}" for key, item in value.items()) + "\n" + " " * indent + "}"
        return "[\n" + ",\n".join(pad + show(item, indent + 2) for item in value) + "\n" + " " * indent + "]"
    return show(document, 0)


def look_rotation(position, target, up=(0, 1, 0)):
    """Quaternion (x, y, z, w) of a camera that looks along -z, +y up."""
    from shapes import cross, normalize, sub
    back = normalize(sub(position, target))
    right = normalize(cross(up, back))
    above = cross(back, right)
    m = list(zip(right, above, back))  # columns are the axes
    trace = m[0][0] + m[1][1] + m[2][2]
    if trace > 0:
        s = 2 * math.sqrt(1 + trace)
        q = ((m[2][1] - m[1][2]) / s, (m[0][2] - m[2][0]) / s, (m[1][0] - m[0][1]) / s, s / 4)
    else:
        i = max(range(3), key=lambda axis: m[axis][axis])
        j, k = (i + 1) % 3, (i + 2) % 3
        s = 2 * math.sqrt(1 + m[i][i] - m[j][j] - m[k][k])
        q = [0.0, 0.0, 0.0, (m[k][j] - m[j][k]) / s]
        q[i], q[j], q[k] = s / 4, (m[j][i] + m[i][j]) / s, (m[k][i] + m[i][k]) / s
    return [round(x, 9) for x in q]


def png(width, height, palette, indices):
    """A picture of up to 256 colours, rows from the top. Its deflate stream holds stored blocks only: compressors differ between machines,
    and the bytes must not."""
    import zlib
    raw = b"".join(b"\0" + bytes(indices[width * y: width * (y + 1)]) for y in range(height))
    blocks = [raw[at: at + 65535] for at in range(0, len(raw), 65535)]
    stream = b"\x78\x01"
    for i, block in enumerate(blocks):
        stream += struct.pack("<BHH", i == len(blocks) - 1, len(block), len(block) ^ 0xffff) + block
    stream += struct.pack(">I", zlib.adler32(raw))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"PLTE", bytes(flat(palette))) + chunk(b"IDAT", stream) + chunk(b"IEND", b"")


def finish(files):
    """Writes {path: bytes}, or with --check compares."""
    check = "--check" in sys.argv[1:]
    if sys.argv[1:] not in ([], ["--check"]):
        sys.exit(f"usage: {sys.argv[0]} [--check]")
    different = False
    for path, data in files.items():
        if not check:
            path.write_bytes(data)
            print(f"{path.name}: {len(data)} bytes")
        elif not path.exists() or path.read_bytes() != data:
            print(f"{path}: not what this script makes")
            different = True
    sys.exit(1 if different else 0)
