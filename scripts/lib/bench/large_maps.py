"""Labelled clouds that are as large as is wanted, for measuring times: their floors are level for W, not for the
room, so that what is detected in them is not what is detected in the room."""

import math
from pathlib import Path

from .object_libraries import layout_of, read_ply

FLOOR_POINTS = 250_000  # of a floor of one segment: 20 m^2 at 9 mm
SPACING_M = 0.009
APART_M = 3.0  # between floors


def add_floors(labelled, file, count):
    """Writes the labelled PLY file with level floors of one segment each, 100 m aside, up to so many points."""
    names, vertices = read_ply(labelled)
    num_points, highest = 0, 0
    for vertex in vertices:
        num_points += 1
        highest = max(highest, vertex[names.index("segment_id")])
    header, _, body = Path(labelled).read_bytes().partition(b"end_header\n")
    layout = layout_of(header.decode())
    missing = max(count - num_points, 0)
    header = header.replace(b"element vertex %d" % num_points, b"element vertex %d" % (num_points + missing))
    with open(file, "wb") as out:
        out.write(header + b"end_header\n" + body[:num_points * layout.size])
        for number in range(math.ceil(missing / FLOOR_POINTS)):
            size = min(FLOOR_POINTS, missing - number * FLOOR_POINTS)
            out.write(floor(names, layout, size, 100.0 + APART_M * number, highest + 1 + number))


def floor(names, layout, size, level_m, segment):
    """Bytes of the vertices. y of the map is down."""
    side = math.isqrt(FLOOR_POINTS)
    known = {"ny": -1.0, "y": level_m, "red": 120, "green": 120, "blue": 120, "segment_id": segment}
    values = [known.get(name, 1.0 if name == "weight" else 0) for name in names]
    x, z = names.index("x"), names.index("z")
    content = bytearray(size * layout.size)
    for i in range(size):
        values[x], values[z] = SPACING_M * (i % side), SPACING_M * (i // side)
        layout.pack_into(content, i * layout.size, *values)
    return bytes(content)
