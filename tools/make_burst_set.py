#!/usr/bin/env python3
"""Writes the set of shots/burst.json: burst.glb, a concrete yard with blocks, two containers and a car, and a camera
that travels along an arc.

usage: make_burst_set.py FOLDER

Standard library only, with the shapes and the file format of make_street.py. Equal runs write equal bytes.

glTF's axes, in metres: y is up, the blast is at the origin, and the camera stands at +z. Frame n is at n / 24 seconds;
the camera has one key for each frame from 0 to FRAMES, and between keys it runs straight.
"""

import math
import pathlib
import struct
import sys

from make_street import Glb, Part, car, product, turn

FRAMES, RATE = 48, 24.0
AIM = (5.6, 8.6)                 # height above the blast that the camera looks at, at the first and the last frame
DISTANCE = (25.5, 31.0)          # of the camera from the axis of the blast
HEIGHT = (2.2, 3.4)              # of the eye above the ground
AZIMUTH = (-24.0, 4.0)           # degrees about the blast; 0 is +z


def yard():
    """The ground with joints, and a wall at its end."""
    part, half, slab, gap = Part(), 64.0, 8.0, 0.06
    part.quad("char", (-half, -0.01, half), (half, -0.01, half), (half, -0.01, -half), (-half, -0.01, -half))
    count = round(2 * half / slab)
    for i in range(count):
        for j in range(count):
            x, z = -half + i * slab, half - j * slab
            part.quad("concrete", (x, 0, z), (x + slab - gap, 0, z), (x + slab - gap, 0, z - slab + gap),
                      (x, 0, z - slab + gap))
    for i in range(10):
        x = -50.0 + 10.0 * i
        part.box("plaster_grey", (x, 0, -17.5), (x + 9.6, 4.2, -17.0), "yz")
        part.box("stone", (x + 9.6, 0, -17.6), (x + 10.0, 4.5, -16.9), "y")
    return part


def block():
    """A concrete block of one cubic metre, with a bevel around its top."""
    part, b = Part(), 0.06
    ring = lambda h, r: [(-r, h, r), (r, h, r), (r, h, -r), (-r, h, -r)]
    part.loft("stone", [ring(0.0, 0.5), ring(1.0 - b, 0.5), ring(1.0, 0.5 - b)])
    return part


def container():
    """A shipping container with ribs, 6 m by 2.4 m by 2.6 m, along x."""
    part = Part()
    part.box("car_red", (-3.0, 0.15, -1.15), (3.0, 2.55, 1.15), "y")
    for x in (-3.0, 2.85):
        for z in (-1.2, 1.05):
            part.box("iron", (x, 0.0, z), (x + 0.15, 2.6, z + 0.15), "y")
    for i in range(18):
        x = -2.75 + 0.31 * i
        for z in (-1.19, 1.15):
            part.box("car_red", (x, 0.2, z), (x + 0.16, 2.5, z + 0.04), "yY")
    return part


def place_things(glb):
    """Blocks in front of the blast and beside it, containers behind, and a car."""
    cube, box = glb.mesh("block", block), glb.mesh("container", container)
    for x, y, z, yaw, size in ((-5.6, 0, 7.4, 12, 1.3), (-4.1, 0, 8.6, 41, 0.9), (5.2, 0, 6.6, -20, 1.4),
                               (5.1, 1.4, 6.6, 9, 1.0), (7.4, 0, 5.0, 33, 1.2), (-9.4, 0, 2.2, -8, 1.6),
                               (2.2, 0, 11.4, 25, 0.7)):
        glb.root(glb.node(cube, (x, y, z), turn(yaw), (size, size, size)))
    for x, y, z, yaw in ((11.2, 0, -5.5, -14), (11.6, 2.6, -5.4, -10), (-11.8, 0, -7.5, 24)):
        glb.root(glb.node(box, (x, y, z), turn(yaw)))
    glb.root(glb.node(glb.mesh("car", car, "car_white"), (-8.2, 0, 9.6), turn(63)))


def eased(t):
    """From 0 to 1 without a jerk at either end."""
    return t * t * (3.0 - 2.0 * t)


def pose(frame):
    """Position and rotation of the camera."""
    t = eased(frame / FRAMES)
    along = lambda ends: ends[0] + (ends[1] - ends[0]) * t
    azimuth, distance, height = math.radians(along(AZIMUTH)), along(DISTANCE), along(HEIGHT)
    pitch = math.degrees(math.atan2(along(AIM) - height, distance))
    eye = (distance * math.sin(azimuth), height, distance * math.cos(azimuth))
    return eye, product(turn(along(AZIMUTH)), turn(pitch, 0))


def place_camera(glb):
    lens = glb.append("cameras", {"name": "travelling", "type": "perspective",
                                  "perspective": {"yfov": round(math.radians(36.0), 6), "aspectRatio": 16 / 9,
                                                  "znear": 0.1}})
    poses = [pose(frame) for frame in range(FRAMES + 1)]
    node = glb.node(None, *poses[0], camera=lens, name="camera")
    glb.root(node)
    seconds = struct.pack(f"<{FRAMES + 1}f", *(frame / RATE for frame in range(FRAMES + 1)))
    times = glb.accessor(seconds, "SCALAR", 5126, FRAMES + 1, min=[0.0], max=[FRAMES / RATE])
    tracks = (("translation", [eye for eye, _ in poses]), ("rotation", [rotation for _, rotation in poses]))
    glb.json["animations"] = [{
        "samplers": [{"input": times, "output": glb.floats(rows), "interpolation": "LINEAR"} for _, rows in tracks],
        "channels": [{"sampler": i, "target": {"node": node, "path": path}} for i, (path, _) in enumerate(tracks)]}]


def burst():
    """The bytes of burst.glb."""
    glb = Glb()
    glb.json["asset"]["generator"] = "Brisance make_burst_set.py"
    place_camera(glb)
    glb.root(glb.node(glb.mesh("yard", yard)))
    place_things(glb)
    return glb.bytes()


def main(arguments):
    if len(arguments) != 1:
        sys.exit(__doc__)
    (pathlib.Path(arguments[0]) / "burst.glb").write_bytes(burst())


if __name__ == "__main__":
    main(sys.argv[1:])
