"""tools/make_street.py: it writes the same bytes every time, those of shots/, and a file without flaws."""

import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
FILES = ("street.glb", "street_sky.hdr")
FORMATS = {5121: "B", 5123: "H", 5126: "f"}
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def make():
    """What the tool writes, by name."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, ROOT / "tools" / "make_street.py", folder], check=True)
        return {path.name: path.read_bytes() for path in pathlib.Path(folder).iterdir()}


def cross(u, v):
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def difference(p, q):
    return tuple(a - b for a, b in zip(p, q))


class Glb:
    """The parts of a binary glTF file."""

    def __init__(self, data):
        self.magic, self.version, self.length = struct.unpack_from("<4sII", data)
        size, kind = struct.unpack_from("<I4s", data, 12)
        assert kind == b"JSON"
        self.json = json.loads(data[20:20 + size])
        binary_size, kind = struct.unpack_from("<I4s", data, 20 + size)
        assert kind == b"BIN\0"
        self.binary = data[28 + size:28 + size + binary_size]

    def read(self, accessor):
        """The elements of an accessor; numbers where they are scalars."""
        item = self.json["accessors"][accessor]
        view = self.json["bufferViews"][item["bufferView"]]
        width, letter = COMPONENTS[item["type"]], FORMATS[item["componentType"]]
        form = struct.Struct(f"<{width}{letter}")
        data = self.binary[view["byteOffset"]:view["byteOffset"] + view["byteLength"]]
        elements = [form.unpack_from(data, i * form.size) for i in range(item["count"])]
        return [e[0] for e in elements] if width == 1 else elements

    def triangles(self, mesh):
        """Corners of all triangles of a mesh."""
        for primitive in self.json["meshes"][mesh]["primitives"]:
            points = self.read(primitive["attributes"]["POSITION"])
            indices = self.read(primitive["indices"])
            for i in range(0, len(indices), 3):
                yield [points[k] for k in indices[i:i + 3]]

    def mesh_named(self, name):
        return next(i for i, mesh in enumerate(self.json["meshes"]) if mesh["name"] == name)


class MakeStreet(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.files = make()
        cls.glb = Glb(cls.files["street.glb"])

    def test_writes_the_same_bytes_twice(self):
        self.assertEqual(sorted(self.files), sorted(FILES))
        self.assertEqual(make(), self.files)

    def test_the_files_of_the_shot_are_what_it_writes(self):
        for name in FILES:
            self.assertEqual((ROOT / "shots" / name).read_bytes(), self.files[name], name)

    def test_the_file_is_as_long_as_it_says_and_small(self):
        data = self.files["street.glb"]
        self.assertEqual((self.glb.magic, self.glb.version, self.glb.length), (b"glTF", 2, len(data)))
        self.assertEqual(self.glb.json["buffers"][0]["byteLength"], len(self.glb.binary))
        self.assertLess(len(data), 300_000)

    def test_every_view_and_accessor_is_within_the_buffer_and_aligned(self):
        for view in self.glb.json["bufferViews"]:
            self.assertEqual(view["byteOffset"] % 4, 0)
            self.assertLessEqual(view["byteOffset"] + view["byteLength"], len(self.glb.binary))
        for item in self.glb.json["accessors"]:
            size = struct.calcsize(FORMATS[item["componentType"]]) * COMPONENTS[item["type"]]
            self.assertEqual(size * item["count"], self.glb.json["bufferViews"][item["bufferView"]]["byteLength"])

    def test_every_index_is_in_range(self):
        for mesh in self.glb.json["meshes"]:
            for primitive in mesh["primitives"]:
                accessors = [self.glb.json["accessors"][i] for i in primitive["attributes"].values()]
                indices = self.glb.read(primitive["indices"])
                self.assertEqual(len({item["count"] for item in accessors}), 1)
                self.assertEqual(len(indices) % 3, 0)
                self.assertLess(max(indices), accessors[0]["count"], mesh["name"])
                self.assertLess(primitive["material"], len(self.glb.json["materials"]))

    def test_every_triangle_has_area(self):
        for i, mesh in enumerate(self.glb.json["meshes"]):
            for a, b, c in self.glb.triangles(i):
                normal = cross(difference(b, a), difference(c, a))
                self.assertGreater(sum(n * n for n in normal) ** 0.5, 1e-7, (mesh["name"], a, b, c))

    def test_bounds_are_those_of_the_positions(self):
        for item_index, item in enumerate(self.glb.json["accessors"]):
            if "min" in item:
                columns = list(zip(*self.glb.read(item_index)))
                self.assertEqual(item["min"], [min(column) for column in columns])
                self.assertEqual(item["max"], [max(column) for column in columns])

    def test_faces_look_outwards(self):
        """The volume inside a closed thing, summed over its triangles, is positive."""
        for name in ("crate", "bollard", "car car_red", "chunk 0", "chunk 1", "chunk 2"):
            volume = sum(sum(x * n for x, n in zip(a, cross(b, c)))
                         for a, b, c in self.glb.triangles(self.glb.mesh_named(name)))
            self.assertGreater(volume, 0.0, name)

    def test_walls_look_at_the_street_and_the_ground_looks_up(self):
        for a, b, c in self.glb.triangles(self.glb.mesh_named("ground")):
            if a[1] == b[1] == c[1]:
                self.assertGreater(cross(difference(b, a), difference(c, a))[1], 0.0)
        bay = next(i for i, mesh in enumerate(self.glb.json["meshes"]) if mesh["name"].startswith("bay_window"))
        for a, b, c in self.glb.triangles(bay):
            if a[2] == b[2] == c[2]:
                self.assertGreater(cross(difference(b, a), difference(c, a))[2], 0.0)

    def test_every_node_has_one_place_in_the_scene(self):
        nodes = self.glb.json["nodes"]
        placed = list(self.glb.json["scenes"][0]["nodes"]) + [c for node in nodes for c in node.get("children", [])]
        self.assertEqual(sorted(placed), list(range(len(nodes))))


if __name__ == "__main__":
    unittest.main()
