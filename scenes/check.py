# SPDX-License-Identifier: Apache-2.0
"""Checks glTF files by the letter of the format where a writer may go wrong: lengths, ranges, alignment, min and max, indices, normals, references.
  check.py FILE...       without files: every .gltf and .glb below this folder. Exit status 1 where anything is wrong."""
import json
import math
import pathlib
import struct
import sys

SIZES = {5120: ("b", 1), 5121: ("B", 1), 5122: ("h", 2), 5123: ("H", 2), 5125: ("I", 4), 5126: ("f", 4)}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
SCALES = {5120: 127, 5121: 255, 5122: 32767, 5123: 65535}


def load(path):
    data = path.read_bytes()
    if path.suffix == ".gltf":
        document = json.loads(data)
        return document, [(path.parent / b["uri"]).read_bytes() for b in document["buffers"]]
    magic, version, size = struct.unpack_from("<4sII", data)
    assert (magic, version, size) == (b"glTF", 2, len(data)), "header"
    length, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON" and length % 4 == 0, "JSON chunk"
    at = 20 + length
    rest, kind = struct.unpack_from("<I4s", data, at)
    assert kind == b"BIN\0" and rest % 4 == 0 and at + 8 + rest == len(data), "BIN chunk"
    return json.loads(data[20:at]), [data[at + 8:]]


def read(document, buffers, index):
    """Values of an accessor as stored, and divided where they are normalized."""
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]
    letter, size = SIZES[accessor["componentType"]]
    width = WIDTHS[accessor["type"]]
    stride = view.get("byteStride", size * width)
    offset = accessor.get("byteOffset", 0)
    assert offset % size == 0 and view["byteOffset"] % size == 0 and stride % size == 0, f"accessors[{index}]: alignment"
    assert offset + stride * (accessor["count"] - 1) + size * width <= view["byteLength"], f"accessors[{index}]: beyond its view"
    data = buffers[view["buffer"]]
    rows = [struct.unpack_from(f"<{width}{letter}", data, view["byteOffset"] + offset + stride * i) for i in range(accessor["count"])]
    assert all(math.isfinite(x) for row in rows for x in row), f"accessors[{index}]: not finite"
    for key, pick in (("min", min), ("max", max)):
        if key in accessor:
            assert accessor[key] == [pick(column) for column in zip(*rows)], f"accessors[{index}]: {key}"
    if accessor.get("normalized"):
        rows = [tuple(max(x / SCALES[accessor["componentType"]], -1.0) for x in row) for row in rows]
    return rows


def check(path):
    document, buffers = load(path)
    for buffer, data in zip(document["buffers"], buffers, strict=True):
        assert len(data) - buffer["byteLength"] in range(4), "buffer's length"
    for i, view in enumerate(document["bufferViews"]):
        assert view["byteOffset"] + view["byteLength"] <= document["buffers"][view["buffer"]]["byteLength"], f"bufferViews[{i}]: beyond its buffer"
    used = set()
    triangles = shapes = 0
    root = document.get("extensions", {})
    for m, mesh in enumerate(document.get("meshes", [])):
        for p, primitive in enumerate(mesh["primitives"]):
            place = f"meshes[{m}].primitives[{p}]"
            attributes = {name: read(document, buffers, index) for name, index in primitive["attributes"].items()}
            used |= {primitive["indices"], *primitive["attributes"].values()}
            positions = attributes["POSITION"]
            accessor = document["accessors"][primitive["attributes"]["POSITION"]]
            assert "min" in accessor and "max" in accessor, f"{place}: POSITION without bounds"
            assert all(len(rows) == len(positions) for rows in attributes.values()), f"{place}: attributes of unequal length"
            for normal in attributes.get("NORMAL", []):
                assert abs(math.sqrt(sum(x * x for x in normal)) - 1) < 1e-3, f"{place}: normal's length"
            indices = [i for i, in read(document, buffers, primitive["indices"])]
            assert len(indices) % 3 == 0 and max(indices) < len(positions), f"{place}: indices"
            assert 0 <= primitive["material"] < len(document["materials"]), f"{place}: material"
            for a, b, c in zip(*[iter(indices)] * 3):
                pa, pb, pc = positions[a], positions[b], positions[c]
                u, v = [y - x for x, y in zip(pa, pb)], [y - x for x, y in zip(pa, pc)]
                n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
                assert any(n), f"{place}: triangle {a} {b} {c} has no area"
                for k in (a, b, c) if "NORMAL" in attributes else ():
                    assert sum(x * y for x, y in zip(n, attributes["NORMAL"][k])) > 0, f"{place}: triangle {a} {b} {c} against its normals"
            triangles += len(indices) // 3
    for a, animation in enumerate(document.get("animations", [])):
        for c, channel in enumerate(animation["channels"]):
            sampler = animation["samplers"][channel["sampler"]]
            times, values = read(document, buffers, sampler["input"]), read(document, buffers, sampler["output"])
            used |= {sampler["input"], sampler["output"]}
            place = f"animations[{a}].channels[{c}]"
            assert "min" in document["accessors"][sampler["input"]] and times == sorted(set(times)), f"{place}: times"
            assert len(values) == len(times) and channel["target"]["node"] < len(document["nodes"]), f"{place}: values"
            for value in values if channel["target"]["path"] == "rotation" else []:
                assert abs(sum(x * x for x in value) - 1) < 1e-5, f"{place}: rotation's length"
    assert used == set(range(len(document.get("accessors", [])))), "accessors that nothing uses"
    for i, node in enumerate(document["nodes"]):
        assert node.get("mesh", 0) < len(document.get("meshes", [0])) and node.get("camera", 0) < len(document.get("cameras", [0])), f"nodes[{i}]"
        light = node.get("extensions", {}).get("KHR_lights_punctual", {}).get("light", 0)
        assert light < len(root.get("KHR_lights_punctual", {}).get("lights", [0])), f"nodes[{i}]: light"
        shape = node.get("extras", {}).get("sunstone_shape")
        if shape:
            shapes += 1
            assert shape["material"] < len(document["materials"]), f"nodes[{i}]: material of its shape"
            if "shape" in shape:
                assert root["KHR_implicit_shapes"]["shapes"][shape["shape"]]["sphere"]["radius"] > 0, f"nodes[{i}]: its shape"
            else:
                assert shape["type"] in ("disk", "quad", "plane"), f"nodes[{i}]: its shape's type"
                assert all(x > 0 for x in [shape.get("radius", 1), *shape.get("size", [])]), f"nodes[{i}]: its shape's size"
        assert abs(sum(x * x for x in node.get("rotation", [1])) - 1) < 1e-6, f"nodes[{i}]: rotation's length"
    assert sorted(document["scenes"][0]["nodes"]) == list(range(len(document["nodes"]))), "nodes of the scene"
    extensions = set(root) | {name for node in document["nodes"] for name in node.get("extensions", {})} | {name for material in document["materials"] for name in material.get("extensions", {})}
    assert extensions <= set(document.get("extensionsUsed", [])), "extensionsUsed"
    for i, material in enumerate(document["materials"]):
        factors = material["pbrMetallicRoughness"]["baseColorFactor"] + material.get("emissiveFactor", [])
        assert all(0 <= x <= 1 for x in factors), f"materials[{i}]: factor"
    return f"{triangles} triangles" + (f", {shapes} shapes" if shapes else "")


wrong = False
here = pathlib.Path(__file__).resolve().parent
for path in [pathlib.Path(a) for a in sys.argv[1:]] or sorted([*here.rglob("*.gltf"), *here.rglob("*.glb")]):
    try:
        print(f"{path.name}: {check(path)}")
    except (AssertionError, KeyError, IndexError, ValueError, OSError) as error:
        print(f"{path.name}: {type(error).__name__}: {error}")
        wrong = True
sys.exit(1 if wrong else 0)
