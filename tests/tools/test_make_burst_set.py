"""tools/make_burst_set.py: it writes the bytes of shots/, and a camera that travels without a jerk and looks at the
burst in every frame."""

import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(pathlib.Path(__file__).parent))

from test_make_street import Glb, cross, difference  # noqa: E402


def turned(q, v):
    """A vector turned by a quaternion (x, y, z, w)."""
    u, w = q[:3], q[3]
    t = tuple(2.0 * c for c in cross(u, v))
    return tuple(a + w * b + c for a, b, c in zip(v, t, cross(u, t)))


class MakeBurstSet(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, ROOT / "tools" / "make_burst_set.py", folder], check=True)
            cls.bytes = (pathlib.Path(folder) / "burst.glb").read_bytes()
        cls.glb = Glb(cls.bytes)
        animation = cls.glb.json["animations"][0]
        cls.keys = {channel["target"]["path"]: cls.glb.read(animation["samplers"][channel["sampler"]]["output"])
                    for channel in animation["channels"]}
        cls.seconds = cls.glb.read(animation["samplers"][0]["input"])

    def test_the_file_of_the_shot_is_what_it_writes_and_small(self):
        self.assertEqual((ROOT / "shots" / "burst.glb").read_bytes(), self.bytes)
        self.assertLess(len(self.bytes), 100_000)

    def test_there_is_a_key_for_each_frame_of_the_sequence(self):
        self.assertEqual(len(self.seconds), 49)
        for frame, seconds in enumerate(self.seconds):
            self.assertAlmostEqual(seconds, frame / 24.0, places=6)

    def test_the_camera_looks_at_the_axis_of_the_burst_in_every_frame(self):
        for eye, rotation in zip(self.keys["translation"], self.keys["rotation"]):
            view = turned(rotation, (0.0, 0.0, -1.0))
            along = -(eye[0] * view[0] + eye[2] * view[2]) / (view[0] ** 2 + view[2] ** 2)
            nearest = [e + along * v for e, v in zip(eye, view)]
            self.assertLess(math.hypot(nearest[0], nearest[2]), 0.01)
            self.assertTrue(4.0 < nearest[1] < 10.0, nearest)

    def test_the_camera_neither_jumps_nor_jerks(self):
        eyes = self.keys["translation"]
        steps = [difference(b, a) for a, b in zip(eyes, eyes[1:])]
        self.assertLess(max(math.hypot(*step) for step in steps), 0.6)
        self.assertGreater(max(math.hypot(*step) for step in steps), 0.2)
        self.assertLess(max(math.hypot(*difference(b, a)) for a, b in zip(steps, steps[1:])), 0.05)

    def test_every_triangle_has_area(self):
        for i, mesh in enumerate(self.glb.json["meshes"]):
            for a, b, c in self.glb.triangles(i):
                self.assertGreater(math.hypot(*cross(difference(b, a), difference(c, a))), 1e-7, mesh["name"])


if __name__ == "__main__":
    unittest.main()
