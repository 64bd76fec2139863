#!/usr/bin/env python3
"""Writes the set of shots/street.json: street.glb, a wet street between two rows of houses, and street_sky.hdr, dusk.

usage: make_street.py FOLDER

Standard library only. Equal runs write equal bytes: nothing is drawn but from seeded generators, coordinates are
rounded to a tenth of a millimetre, and pictures are stored without compression.

glTF's axes, in metres: y is up, the street runs along z, its middle and the blast are at the origin, and the camera
looks along -z. Fronts are counter-clockwise; there are no normals, so that every face is flat.
"""

import json
import math
import pathlib
import random
import struct
import sys
import zlib

BAY, STOREY = 3.0, 3.0          # of a facade: one window
ROAD, FACADE = 4.5, 8.5         # from the middle of the street
PAVEMENT = 0.15                 # above the road
NEAR, FAR = 21.0, -48.0         # z between which houses stand

# name: (base colour, roughness, metallic, emitted radiance, texture and the metres that it covers)
MATERIALS = {
    "asphalt": ((0.55, 0.55, 0.58), 1.0, 0, None, ("damp", 16.0)),
    "pavement": ((1.0, 0.97, 0.92), 1.0, 0, None, ("slabs", 1.5)),
    "paint": ((0.42, 0.42, 0.4), 0.35, 0, None, None),
    "concrete": ((0.32, 0.31, 0.3), 0.55, 0, None, None),
    "stone": ((0.46, 0.42, 0.36), 0.7, 0, None, None),
    "plaster_ochre": ((0.86, 0.68, 0.46), 0.85, 0, None, ("plaster", 3.0)),
    "plaster_grey": ((0.78, 0.77, 0.75), 0.85, 0, None, ("plaster", 3.0)),
    "brick": ((0.72, 0.4, 0.3), 0.8, 0, None, ("brick", 1.0)),
    "glass": ((0.012, 0.014, 0.016), 0.05, 0, None, None),
    "lit_warm": ((0.02, 0.02, 0.02), 0.3, 0, (0.6, 0.27, 0.08), None),
    "lit_cool": ((0.02, 0.02, 0.02), 0.3, 0, (0.3, 0.2, 0.1), None),
    "frame": ((0.55, 0.53, 0.5), 0.5, 0, None, None),
    "wood": ((0.2, 0.1, 0.05), 0.6, 0, None, None),
    "iron": ((0.05, 0.05, 0.055), 0.4, 0, None, None),
    "metal": ((0.55, 0.56, 0.58), 0.3, 1, None, None),
    "lamp": ((0.1, 0.1, 0.1), 0.5, 0, (5.0, 2.6, 0.9), None),
    "car_red": ((0.3, 0.012, 0.01), 0.12, 0, None, None),
    "car_white": ((0.6, 0.6, 0.58), 0.15, 0, None, None),
    "tyre": ((0.02, 0.02, 0.02), 0.8, 0, None, None),
    "tail_light": ((0.35, 0.01, 0.01), 0.1, 0, None, None),
    "char": ((0.03, 0.028, 0.026), 0.8, 0, None, None),
}


# ---- shapes ----------------------------------------------------------------------------------------------------------

class Part:
    """Triangles of one mesh, by material."""

    def __init__(self):
        self.triangles = {}

    def triangle(self, material, *corners):
        self.triangles.setdefault(material, []).append(corners)

    def quad(self, material, a, b, c, d):
        """A quad whose corners run counter-clockwise as seen from its front."""
        self.triangle(material, a, b, c)
        self.triangle(material, a, c, d)

    def box(self, material, low, high, without=""):
        """An axis-parallel box; `without` leaves faces out, by the letters of x X y Y z Z (low and high ends)."""
        (x, y, z), (X, Y, Z) = low, high
        faces = {"x": ((x, y, z), (x, y, Z), (x, Y, Z), (x, Y, z)), "X": ((X, y, Z), (X, y, z), (X, Y, z), (X, Y, Z)),
                 "y": ((x, y, z), (X, y, z), (X, y, Z), (x, y, Z)), "Y": ((x, Y, Z), (X, Y, Z), (X, Y, z), (x, Y, z)),
                 "z": ((X, y, z), (x, y, z), (x, Y, z), (X, Y, z)), "Z": ((x, y, Z), (X, y, Z), (X, Y, Z), (x, Y, Z))}
        for name, corners in faces.items():
            if name not in without:
                self.quad(material, *corners)

    def loft(self, material, rings, caps=True):
        """Skin between rings of equally many points that turn counter-clockwise as seen from the last one's side."""
        for a, b in zip(rings, rings[1:]):
            for i in range(len(a)):
                j = (i + 1) % len(a)
                self.quad(material, a[i], a[j], b[j], b[i])
        if caps:
            for ring, order in ((rings[0], -1), (rings[-1], 1)):
                for i in range(1, len(ring) - 1):
                    self.triangle(material, *(ring[0], ring[i], ring[i + 1])[::order])

    def post(self, material, x, z, stations, sides=8):
        """An upright round post through (height, radius) stations."""
        self.loft(material, [[(x + r * math.sin(2 * math.pi * i / sides), y, z + r * math.cos(2 * math.pi * i / sides))
                              for i in range(sides)] for y, r in stations])


def wall_with_opening(part, wall, x0, x1, y0, y1):
    """A bay's wall around an opening, and the 0.24 m deep reveals of that."""
    p = lambda x, y, z=0.0: (x, y, z)
    part.quad(wall, p(0, 0), p(x0, 0), p(x0, STOREY), p(0, STOREY))
    part.quad(wall, p(x1, 0), p(BAY, 0), p(BAY, STOREY), p(x1, STOREY))
    part.quad(wall, p(x0, y1), p(x1, y1), p(x1, STOREY), p(x0, STOREY))
    if y0 > 0:
        part.quad(wall, p(x0, 0), p(x1, 0), p(x1, y0), p(x0, y0))
    d = -0.24
    part.quad(wall, p(x0, y0), p(x0, y0, d), p(x0, y1, d), p(x0, y1))
    part.quad(wall, p(x1, y0, d), p(x1, y0), p(x1, y1), p(x1, y1, d))
    part.quad(wall, p(x0, y0), p(x1, y0), p(x1, y0, d), p(x0, y0, d))
    part.quad(wall, p(x0, y1, d), p(x1, y1, d), p(x1, y1), p(x0, y1))


def glazing(part, pane, x0, x1, y0, y1, mullions, transom):
    """A pane in its frame, with upright bars in between and one across at the height `transom`."""
    b, back, front = 0.06, -0.22, -0.15
    part.quad(pane, (x0, y0, back), (x1, y0, back), (x1, y1, back), (x0, y1, back))
    for x in (x0, x1 - b):
        part.box("frame", (x, y0, back), (x + b, y1, front), "zyY")
    for y in (y0, y1 - b, transom):
        part.box("frame", (x0 + b, y, back), (x1 - b, y + b, front), "zxX")
    for i in range(mullions):
        x = x0 + (x1 - x0) * (i + 1) / (mullions + 1) - b / 2
        part.box("frame", (x, y0 + b, back), (x + b, y1 - b, front + 0.01), "zyY")


def bay_window(wall, pane):
    """A window with sill and lintel."""
    part, (x0, x1, y0, y1) = Part(), (0.9, 2.1, 0.9, 2.5)
    wall_with_opening(part, wall, x0, x1, y0, y1)
    glazing(part, pane, x0, x1, y0, y1, 1, 2.0)
    part.box("stone", (x0 - 0.1, y0 - 0.1, -0.2), (x1 + 0.1, y0, 0.14), "z")
    part.box("stone", (x0 - 0.15, y1, -0.01), (x1 + 0.15, y1 + 0.22, 0.06), "z")
    for x in (x0 - 0.15, x1):
        part.box("stone", (x, y0, -0.01), (x + 0.15, y1, 0.04), "zyY")
    return part


def bay_balcony(wall, pane):
    """A glazed door onto a balcony with iron bars."""
    part, (x0, x1, y1), (left, right, deep) = Part(), (0.85, 2.15, 2.4), (0.4, 2.6, 1.0)
    wall_with_opening(part, wall, x0, x1, 0.0, y1)
    glazing(part, pane, x0, x1, 0.0, y1, 1, 1.9)
    part.box("concrete", (left, -0.16, -0.01), (right, 0.02, deep), "z")
    part.box("iron", (left, 1.0, deep - 0.06), (right, 1.05, deep))
    for x in (left, right - 0.05):
        part.box("iron", (x, 1.0, 0.0), (x + 0.05, 1.05, deep - 0.06), "zZ")
        for i in range(5):
            z = 0.1 + 0.18 * i
            part.box("iron", (x + 0.015, 0.02, z), (x + 0.035, 1.0, z + 0.02), "yY")
    for i in range(15):
        x = left + 0.02 + (right - left - 0.06) * i / 14
        part.box("iron", (x, 0.02, deep - 0.04), (x + 0.02, 1.0, deep - 0.02), "yY")
    return part


def bay_shop(wall, pane):
    """A shop's window on a plinth, below a slanting awning."""
    part, (x0, x1, y0, y1) = Part(), (0.3, 2.7, 0.5, 2.45)
    wall_with_opening(part, wall, x0, x1, y0, y1)
    glazing(part, pane, x0, x1, y0, y1, 2, 1.95)
    part.box("stone", (x0 - 0.1, y0 - 0.08, -0.2), (x1 + 0.1, y0, 0.1), "z")
    section = [(2.72, 0.0), (2.38, 1.05), (2.34, 1.05), (2.66, 0.0)]
    part.loft("car_red", [[(x, y, z) for y, z in section] for x in (0.15, 2.85)])
    return part


def bay_door(wall, _):
    """A panelled door between stone jambs, on a step."""
    part, (x0, x1, y1) = Part(), (0.95, 2.05, 2.4)
    wall_with_opening(part, wall, x0, x1, 0.0, y1)
    part.quad("wood", (x0, 0, -0.22), (x1, 0, -0.22), (x1, y1, -0.22), (x0, y1, -0.22))
    for x in (x0 + 0.12, x0 + 0.62):
        for y in (0.25, 1.25):
            part.box("wood", (x, y, -0.22), (x + 0.36, y + 0.8, -0.19), "z")
    part.box("stone", (x0 - 0.2, y1, -0.01), (x1 + 0.2, y1 + 0.3, 0.1), "z")
    part.box("stone", (x0 - 0.15, 0.0, -0.24), (x1 + 0.15, 0.04, 0.4), "yz")
    return part


def shell(wall, bays, storeys):
    """What a house has besides its bays: sides, back, roof, plinth, string courses, cornice and parapet."""
    part, w, h = Part(), bays * BAY, storeys * STOREY
    part.box(wall, (0, 0, -9.0), (w, h, 0), "yZ")
    part.box("concrete", (-0.02, -0.02, -0.01), (w + 0.02, 0.22, 0.05), "yz")
    part.box("stone", (-0.02, STOREY - 0.08, -0.01), (w + 0.02, STOREY + 0.12, 0.12), "z")
    part.box("stone", (-0.05, h - 0.25, -0.01), (w + 0.05, h, 0.2), "z")
    part.box("stone", (-0.1, h, -0.2), (w + 0.1, h + 0.18, 0.4))
    part.box(wall, (0, h + 0.18, -0.2), (w, h + 0.9, 0.05), "y")
    part.box("concrete", (-0.03, h + 0.9, -0.25), (w + 0.03, h + 0.98, 0.1))
    for x in (0.2 * w, 0.7 * w):
        part.box("brick", (x, h, -5.0), (x + 0.9, h + 2.2, -4.3), "y")
    return part


def ground():
    """Road, kerbs, pavements, the dashes in the middle, and the plain beyond."""
    part, near, far = Part(), 60.0, -130.0
    part.quad("asphalt", (-ROAD, 0, near), (ROAD, 0, near), (ROAD, 0, far), (-ROAD, 0, far))
    for side in (-1, 1):
        inner, kerb, outer = side * ROAD, side * (ROAD + 0.25), side * 60.0
        low, high = sorted((kerb, outer))
        part.quad("pavement", (low, PAVEMENT, near), (high, PAVEMENT, near), (high, PAVEMENT, far),
                  (low, PAVEMENT, far))
        low, high = sorted((inner, kerb))
        for i in range(60):
            z = FAR + 1.4 * i
            part.box("stone", (low, 0, z + 0.012), (high, PAVEMENT + 0.01, z + 1.388), "yX" if side > 0 else "yx")
        part.box("char", (low + 0.01, 0, far), (high - 0.01, PAVEMENT - 0.02, near), "yzZ")
    for i in range(18):
        z = FAR + 4.0 * i
        part.quad("paint", (-0.07, 0.004, z + 1.8), (0.07, 0.004, z + 1.8), (0.07, 0.004, z), (-0.07, 0.004, z))
    return part


def street_lamp():
    """A lamp whose arm reaches along +x; only the underside of its head shines."""
    part = Part()
    part.post("iron", 0, 0, [(0, 0.13), (0.9, 0.11), (1.0, 0.065), (5.6, 0.05)])
    part.box("iron", (-0.03, 5.55, -0.03), (1.5, 5.61, 0.03))
    part.box("iron", (1.0, 5.61, -0.14), (1.75, 5.74, 0.14), "y")
    part.quad("lamp", (1.0, 5.61, -0.14), (1.75, 5.61, -0.14), (1.75, 5.61, 0.14), (1.0, 5.61, 0.14))
    return part


def bollard():
    """An iron bollard with a metal band."""
    part = Part()
    part.post("iron", 0, 0, [(0, 0.1), (0.7, 0.08), (0.9, 0.06), (0.93, 0.02)], 10)
    part.post("metal", 0, 0, [(0.62, 0.092), (0.68, 0.09)], 10)
    return part


def crate():
    """A wooden crate, 0.8 m wide, with battens."""
    part, s = Part(), 0.4
    part.box("wood", (-s, 0.02, -s), (s, 0.78, s))
    for y in (0.0, 0.7):
        part.box("wood", (-s - 0.025, y, -s - 0.025), (s + 0.025, y + 0.1, s + 0.025))
    for x in (-s - 0.02, s - 0.08):
        for z in (-s - 0.02, s - 0.08):
            part.box("wood", (x, 0.1, z), (x + 0.1, 0.7, z + 0.1), "yY")
    return part


def chunk(seed):
    """A broken lump about 1 m across, to be scaled down."""
    draw, part = random.Random(seed), Part()
    ring = lambda y, r: [(r * (0.7 + 0.6 * draw.random()) * math.sin(a), y + 0.15 * draw.random(),
                          r * (0.7 + 0.6 * draw.random()) * math.cos(a)) for a in (0.3, 1.5, 2.9, 4.2, 5.4)]
    part.loft("char", [ring(-0.3, 0.35), ring(0.1, 0.5), ring(0.4, 0.25)])
    return part


# ---- cars ------------------------------------------------------------------------------------------------------------

# Along the car from its nose: z, underside, belt line, half width at the belt.
HULL = [(-2.1, 0.42, 0.62, 0.66), (-2.0, 0.28, 0.74, 0.78), (-1.5, 0.24, 0.84, 0.84), (-0.7, 0.24, 0.92, 0.86),
        (0.9, 0.24, 0.95, 0.86), (1.6, 0.26, 0.96, 0.84), (2.05, 0.32, 0.92, 0.78), (2.15, 0.48, 0.78, 0.7)]
# The cabin on the belt line: z below, z above, in pairs around its roof.
CABIN = {"bottom": (-0.85, 1.75), "top": (-0.05, 1.15), "low": 0.9, "high": 1.42, "wide": 0.8, "narrow": 0.6}


def hull(part, paint):
    """The body up to the belt line: hexagonal sections, widest at mid height, rounded at the shoulders."""
    rings = []
    for z, low, high, half in HULL:
        middle = 0.5 * (low + high)
        profile = [(0.88 * half, low), (half, middle), (0.97 * half, high - 0.05), (0.86 * half, high)]
        rings.append([(x, y, z) for x, y in profile] + [(-x, y, z) for x, y in reversed(profile)])
    part.loft(paint, rings)


def cabin(part, paint):
    """Glass all round, pillars between, and a roof."""
    (b0, b1), (t0, t1), low, high = CABIN["bottom"], CABIN["top"], CABIN["low"], CABIN["high"]
    bottom = [(x * CABIN["wide"], low, z) for x, z in ((-1, b1), (1, b1), (1, b0), (-1, b0))]
    top = [(x * CABIN["narrow"], high, z) for x, z in ((-1, t1), (1, t1), (1, t0), (-1, t0))]
    between = lambda p, q, t: tuple(a + (b - a) * t for a, b in zip(p, q))
    for i in range(4):
        a, b, c, d = bottom[i], bottom[(i + 1) % 4], top[(i + 1) % 4], top[i]
        cuts = (0.0, 0.07, 0.47, 0.53, 0.93, 1.0) if i % 2 else (0.0, 0.07, 0.93, 1.0)
        for k, (s, t) in enumerate(zip(cuts, cuts[1:])):
            part.quad("glass" if k % 2 else paint, between(a, b, s), between(a, b, t), between(d, c, t),
                      between(d, c, s))
    crown = [(x * 0.9, y + 0.06, z * 0.9 + 0.055) for x, y, z in top]
    part.loft(paint, [top, crown])


def wheel(part, side, z):
    """A tyre that stands out of the body by two centimetres, with a metal rim."""
    ring = lambda x, r: [(x, 0.31 + r * math.cos(a), z + r * math.sin(a))
                         for a in (side * 2 * math.pi * i / 14 for i in range(14))]
    part.loft("tyre", [ring(side * x, r) for x, r in ((0.66, 0.31), (0.85, 0.31), (0.88, 0.28))])
    part.loft("metal", [ring(side * x, r) for x, r in ((0.87, 0.2), (0.9, 0.17))])


def car(paint):
    """A saloon, 4.3 m long, whose nose points along -z."""
    part = Part()
    hull(part, paint)
    cabin(part, paint)
    for side in (-1, 1):
        for z in (-1.3, 1.32):
            wheel(part, side, z)
        x = sorted((side * 0.4, side * 0.68))
        part.box("tail_light", (x[0], 0.6, 2.0), (x[1], 0.75, 2.18), "z")
        part.box("metal", (x[0], 0.5, -2.14), (x[1], 0.6, -2.0), "Z")
    part.box("char", (-0.72, 0.36, -2.16), (0.72, 0.5, -1.9))
    part.box("char", (-0.72, 0.38, 1.9), (0.72, 0.52, 2.19))
    part.box("frame", (-0.26, 0.54, 2.1), (0.26, 0.65, 2.18), "z")
    return part


# ---- the street ------------------------------------------------------------------------------------------------------

def turn(degrees, axis=1):
    """A quaternion about one axis."""
    q = [0.0, 0.0, 0.0, math.cos(math.radians(degrees) / 2)]
    q[axis] = math.sin(math.radians(degrees) / 2)
    return q


def product(p, q):
    """The quaternion that turns by q, then by p."""
    (a, b, c, d), (e, f, g, h) = p, q
    return [d * e + a * h + b * g - c * f, d * f - a * g + b * h + c * e, d * g + a * f - b * e + c * h,
            d * h - a * e - b * f - c * g]


def choose_bay(draw, storey, i, balconies, shops):
    """The maker of a bay, and its pane."""
    pane = "glass" if draw.random() > 0.17 else draw.choice(["lit_warm", "lit_warm", "lit_cool"])
    if storey == 0:
        return (bay_door if i == 1 else bay_shop if shops else bay_window), pane
    return (bay_balcony if balconies and i % 2 == 1 else bay_window), pane


def house(glb, draw, wall, bays, storeys, balconies, shops):
    """A house as nodes: its shell, and a node for each bay."""
    nodes = [glb.node(glb.mesh(f"shell {wall} {bays} {storeys}", shell, wall, bays, storeys))]
    for storey in range(storeys):
        for i in range(bays):
            make, pane = choose_bay(draw, storey, i, balconies, shops)
            nodes.append(glb.node(glb.mesh(f"{make.__name__} {wall} {pane}", make, wall, pane),
                                  (i * BAY, storey * STOREY, 0)))
    return nodes


ROWS = {  # from the camera's end: wall, bays, storeys, balconies, shops
    -1: [("brick", 3, 4, False, False), ("plaster_ochre", 5, 4, True, True), ("plaster_grey", 5, 5, True, False),
         ("brick", 5, 4, False, True), ("plaster_ochre", 5, 5, True, False)],
    1: [("plaster_grey", 4, 4, True, False), ("brick", 5, 5, True, True), ("plaster_ochre", 4, 4, False, False),
        ("plaster_grey", 5, 4, True, True), ("brick", 5, 5, False, False)],
}


def place_houses(glb):
    """Both rows. A bay's x runs away from the camera on the left and towards it on the right."""
    draw = random.Random(7)
    for side, row in ROWS.items():
        z = NEAR
        for wall, bays, storeys, balconies, shops in row:
            start = z if side < 0 else z - bays * BAY
            glb.root(glb.node(None, (side * FACADE, PAVEMENT, start), turn(-90.0 * side),
                              children=house(glb, draw, wall, bays, storeys, balconies, shops)))
            z -= bays * BAY


def skyline():
    """Roofs and towers at the end of the street."""
    draw, part = random.Random(3), Part()
    for i in range(14):
        x, w, h = -46.0 + 7.0 * i, 5.0 + 2.0 * draw.random(), 7.0 + 9.0 * draw.random()
        part.box("concrete", (x, 0.1, -118.0 + 20.0 * draw.random()), (x + w, h, -90.0), "yz")
    return part


def place_things(glb):
    """Lamps, cars, bollards, crates and debris."""
    lamp, post, box = (glb.mesh(make.__name__, make) for make in (street_lamp, bollard, crate))
    for side, z in ((-1, 10.0), (1, 11.0), (1, -11.0), (-1, -13.0), (-1, -31.0), (1, -29.0)):
        glb.root(glb.node(lamp, (side * 5.1, PAVEMENT, z), turn(0.0 if side < 0 else 180.0)))
    for paint, x, z, yaw in (("car_red", 2.5, 10.0, 24.0), ("car_white", -3.5, 13.2, 1.5),
                             ("car_white", 3.4, -14.0, 0.0), ("car_red", -3.4, -17.0, 180.0)):
        glb.root(glb.node(glb.mesh(f"car {paint}", car, paint), (x, 0, z), turn(yaw)))
    for i in range(6):
        glb.root(glb.node(post, (5.0, PAVEMENT, 6.6 + 2.0 * i)))
    for x, y, z, yaw in ((-7.3, 0, 9.4, 12), (-6.3, 0, 8.3, 40), (-7.25, 0.8, 9.3, 30), (6.2, 0, 7.2, 20)):
        glb.root(glb.node(box, (x, y + PAVEMENT, z), turn(yaw)))
    place_debris(glb)


def place_debris(glb):
    """Lumps that the blast has thrown about, more of them close to it."""
    draw = random.Random(11)
    chunks = [glb.mesh(f"chunk {i}", chunk, i) for i in range(3)]
    for i in range(46):
        angle, distance = 2 * math.pi * draw.random(), 5.5 + 12.0 * draw.random() ** 2
        x, z, size = distance * math.sin(angle), distance * math.cos(angle), 0.08 + 0.3 * draw.random() ** 3
        if abs(x) < ROAD - 0.3:
            glb.root(glb.node(chunks[i % 3], (x, 0.25 * size, z), turn(360 * draw.random()), (size, 0.7 * size, size)))


# ---- pictures --------------------------------------------------------------------------------------------------------

def png(width, rows):
    """A grey PNG of 8 bits whose data are stored as they are, so that no version of zlib has a say in the bytes."""
    data, blocks = b"".join(b"\0" + bytes(row) for row in rows), []
    for first in range(0, len(data), 65535):
        block = data[first:first + 65535]
        last = first + 65535 >= len(data)
        blocks.append(struct.pack("<BHH", last, len(block), len(block) ^ 0xFFFF) + block)
    stored = b"\x78\x01" + b"".join(blocks) + struct.pack(">I", zlib.adler32(data))
    piece = lambda name, body: struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))
    header = struct.pack(">IIBBBBB", width, len(rows), 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + piece(b"IHDR", header) + piece(b"IDAT", stored) + piece(b"IEND", b"")


def noise(size, cells, seed):
    """Smooth noise in 0..1 that repeats, as rows; `cells` is the number of lattice cells along a side."""
    draw = random.Random(seed)
    lattice = [[draw.random() for _ in range(cells)] for _ in range(cells)]
    ease = lambda t: t * t * (3.0 - 2.0 * t)
    steps = [(int(i * cells / size), ease(i * cells / size % 1.0)) for i in range(size)]
    rows = []
    for j, t in steps:
        a, b = lattice[j], lattice[(j + 1) % cells]
        column = [p + (q - p) * t for p, q in zip(a, b)]
        rows.append([column[i] + (column[(i + 1) % cells] - column[i]) * s for i, s in steps])
    return rows


def byte(value):
    return min(255, max(0, round(value)))


def damp(size=224):
    """Roughness and colour of asphalt in one: grainy and rougher where it is merely wet, dark and smooth in puddles.

    The largest puddle lies before the camera, in the hollow."""
    octaves = [(noise(size, cells, cells), weight) for cells, weight in ((5, 0.5), (9, 0.3), (20, 0.14), (46, 0.06))]
    draw, rows = random.Random(1), []
    across = lambda i: ((i / size + 0.48) % 1.0 - 0.5) / 0.15
    hollow = lambda i, j: 0.3 * math.exp(-across(i) ** 2 - ((j / size - 0.17) / 0.13) ** 2)
    for j in range(size):
        row = []
        for i in range(size):
            height = sum(rows_of[j][i] * weight for rows_of, weight in octaves) - hollow(i, j)
            dry = min(1.0, max(0.0, (height - 0.53) / 0.05))
            row.append(byte(7 + dry * (58 + 90 * (height - 0.53) + 5 * draw.random())))
        rows.append(row)
    return png(size, rows)


def slabs(size=64):
    """Colour and roughness of two by two slabs of pavement, with joints."""
    draw, tone, wet = random.Random(2), [1.0, 0.9, 0.94, 0.84], noise(size, 6, 5)
    joint = lambda i: i % (size // 2) == 0
    return png(size, [[30 if joint(i) or joint(j) else
                       byte((88 + 14 * draw.random()) * tone[2 * (2 * j // size) + 2 * i // size] - 34 * wet[j][i])
                       for i in range(size)] for j in range(size)])


def brick(size=64):
    """Four bricks by twelve courses of them, each of its own tone."""
    draw = random.Random(4)
    tones = [[150 + 90 * draw.random() for _ in range(4)] for _ in range(12)]
    rows = []
    for j in range(size):
        course, inside = divmod(j * 12 / size, 1.0)
        shifted = [(i * 4 / size + 0.5 * (course % 2)) % 4 for i in range(size)]
        rows.append([195 if inside < 0.15 or u % 1.0 < 0.07 else byte(tones[int(course)][int(u)] + 16 * draw.random())
                     for u in shifted])
    return png(size, rows)


def plaster(size=64):
    """Plaster with streaks of dirt that run down."""
    streaks, blotches, draw = noise(size, 16, 8), noise(size, 6, 9), random.Random(6)
    dirt = lambda i, j: 62 * streaks[0][i] * streaks[j][(i * 3) % size] + 40 * blotches[j][i]
    return png(size, [[byte(232 - dirt(i, j) - 10 * draw.random()) for i in range(size)] for j in range(size)])


PICTURES = {"damp": damp, "slabs": slabs, "brick": brick, "plaster": plaster}


def sky_radiance(elevation, azimuth):
    """Dusk, in W/(m^2 sr): the last glow at azimuth 0, where the street ends, below a deep blue. In degrees."""
    if elevation < 0.0:
        return (0.012, 0.011, 0.012)
    glow = math.exp(-((azimuth / 55.0) ** 2)) * math.exp(-elevation / 9.0)
    haze, top = math.exp(-elevation / 22.0), (0.045, 0.085, 0.2)
    return tuple(t + h * haze + g * glow for t, h, g in zip(top, (0.13, 0.13, 0.17), (1.1, 0.45, 0.12)))


def sky(width=48, height=96):
    """A latitude-longitude picture in Radiance's format: the middle is azimuth 0, the top the zenith."""
    pixels = bytearray()
    for j in range(height):
        for i in range(width):
            rgb = sky_radiance(90.0 - 180.0 * (j + 0.5) / height, 360.0 * (i + 0.5) / width - 180.0)
            exponent = math.frexp(max(rgb))[1]
            pixels += bytes(min(255, int(c * 256.0 / 2.0 ** exponent)) for c in rgb) + bytes([exponent + 128])
    return b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + f"-Y {height} +X {width}\n".encode() + bytes(pixels)


# ---- the file --------------------------------------------------------------------------------------------------------

def planar(corners):
    """Texture coordinates in metres: a face is seen along the axis that it faces most; v grows downwards."""
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = corners
    u, v = (bx - ax, by - ay, bz - az), (cx - ax, cy - ay, cz - az)
    normal = [abs(u[1] * v[2] - u[2] * v[1]), abs(u[2] * v[0] - u[0] * v[2]), abs(u[0] * v[1] - u[1] * v[0])]
    axis = normal.index(max(normal))
    return [((z, -y), (x, z), (x, -y))[axis] for x, y, z in corners]


class Glb:
    """A binary glTF file in the making. Equal bytes are stored once, equal meshes too."""

    def __init__(self):
        self.json = {"asset": {"version": "2.0", "generator": "Brisance make_street.py"}, "scene": 0,
                     "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [], "textures": [],
                     "images": [], "accessors": [], "bufferViews": [], "cameras": [],
                     "extensionsUsed": ["KHR_materials_emissive_strength", "KHR_texture_transform"]}
        self.data, self.views, self.meshes, self.materials, self.textures = bytearray(), {}, {}, {}, {}

    def append(self, name, item):
        self.json[name].append(item)
        return len(self.json[name]) - 1

    def view(self, data):
        """The bufferView of some bytes, of which there is but one copy."""
        if data not in self.views:
            self.data += bytes(-len(self.data) % 4)
            self.views[data] = self.append("bufferViews", {"buffer": 0, "byteOffset": len(self.data),
                                                           "byteLength": len(data)})
            self.data += data
        return self.views[data]

    def accessor(self, data, kind, component, count, **limits):
        item = {"bufferView": self.view(data), "componentType": component, "count": count, "type": kind, **limits}
        known = self.json["accessors"]
        return known.index(item) if item in known else self.append("accessors", item)

    def floats(self, rows, limits=False):
        """An accessor of vectors, with their bounds where glTF requires them."""
        data = b"".join(struct.pack(f"<{len(row)}f", *row) for row in rows)
        stored = [struct.unpack_from(f"<{len(rows[0])}f", data, i * 4 * len(rows[0])) for i in range(len(rows))]
        bounds = {"min": list(map(min, zip(*stored))), "max": list(map(max, zip(*stored)))} if limits else {}
        return self.accessor(data, f"VEC{len(rows[0])}", 5126, len(rows), **bounds)

    def primitive(self, name, triangles):
        """Triangles with shared vertices; texture coordinates where the material has a picture."""
        textured, vertices, indices = MATERIALS[name][4], {}, []
        for corners in triangles:
            corners = [tuple(round(c, 4) + 0.0 for c in corner) for corner in corners]
            for corner, uv in zip(corners, planar(corners)):
                indices.append(vertices.setdefault(corner + (uv if textured else ()), len(vertices)))
        rows = list(vertices)
        attributes = {"POSITION": self.floats([row[:3] for row in rows], True)}
        if textured:
            attributes["TEXCOORD_0"] = self.floats([row[3:] for row in rows])
        wide = len(rows) > 255
        packed = struct.pack(f"<{len(indices)}{'H' if wide else 'B'}", *indices)
        return {"attributes": attributes, "material": self.material(name),
                "indices": self.accessor(packed, "SCALAR", 5123 if wide else 5121, len(indices))}

    def texture(self, name):
        if name not in self.textures:
            image = self.append("images", {"mimeType": "image/png", "bufferView": self.view(PICTURES[name]())})
            self.textures[name] = self.append("textures", {"source": image})
        return self.textures[name]

    def material(self, name):
        if name not in self.materials:
            self.materials[name] = self.append("materials", self.describe(name, *MATERIALS[name]))
        return self.materials[name]

    def describe(self, name, colour, roughness, metallic, emission, picture):
        pbr = {"baseColorFactor": [*colour, 1.0], "roughnessFactor": roughness, "metallicFactor": metallic}
        material = {"name": name, "pbrMetallicRoughness": pbr}
        if picture:
            scale = 1.0 / picture[1]
            reference = {"index": self.texture(picture[0]),
                         "extensions": {"KHR_texture_transform": {"scale": [scale, scale]}}}
            pbr["baseColorTexture"] = reference
            if picture[0] in ("damp", "slabs"):
                pbr["metallicRoughnessTexture"] = reference
        if emission:
            most = max(emission)
            material["emissiveFactor"] = [round(c / most, 6) for c in emission]
            material["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": most}}
        return material

    def mesh(self, name, make, *arguments):
        if name not in self.meshes:
            primitives = [self.primitive(material, triangles)
                          for material, triangles in make(*arguments).triangles.items()]
            self.meshes[name] = self.append("meshes", {"name": name, "primitives": primitives})
        return self.meshes[name]

    def node(self, mesh, translation=None, rotation=None, scale=None, children=None, **more):
        item = {"mesh": mesh, "translation": translation and [round(t, 4) + 0.0 for t in translation],
                "rotation": rotation and [round(r, 6) + 0.0 for r in rotation],
                "scale": scale and [round(s, 4) for s in scale], "children": children, **more}
        return self.append("nodes", {key: value for key, value in item.items() if value is not None})

    def root(self, node):
        self.json["scenes"][0]["nodes"].append(node)

    def bytes(self):
        self.json["buffers"] = [{"byteLength": len(self.data)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text, data = text + b" " * (-len(text) % 4), bytes(self.data) + bytes(-len(self.data) % 4)
        size = 12 + 8 + len(text) + 8 + len(data)
        return (struct.pack("<4sII", b"glTF", 2, size) + struct.pack("<I4s", len(text), b"JSON") + text
                + struct.pack("<I4s", len(data), b"BIN\0") + data)


def place_camera(glb):
    """Low above the wet road, a little left of its middle, looking up at the blast."""
    lens = glb.append("cameras", {"name": "street", "type": "perspective",
                                  "perspective": {"yfov": round(math.radians(38.0), 6), "aspectRatio": 16 / 9,
                                                  "znear": 0.1}})
    glb.root(glb.node(None, (-0.9, 0.8, 24.5), product(turn(-3.0), turn(6.5, 0)), camera=lens, name="camera"))


def street():
    """The bytes of street.glb."""
    glb = Glb()
    place_camera(glb)
    glb.root(glb.node(glb.mesh("ground", ground)))
    glb.root(glb.node(glb.mesh("skyline", skyline)))
    place_houses(glb)
    place_things(glb)
    return glb.bytes()


def main(arguments):
    if len(arguments) != 1:
        sys.exit(__doc__)
    folder = pathlib.Path(arguments[0])
    (folder / "street.glb").write_bytes(street())
    (folder / "street_sky.hdr").write_bytes(sky())


if __name__ == "__main__":
    main(sys.argv[1:])
