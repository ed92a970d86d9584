#!/usr/bin/env python3
"""Whether two files segments.ply have the same points in the same segments, whatever the order of the points and the
ids of the segments. The ids depend on the order in which patches came, and so on losses.

Usage: same_partition.py A.ply B.ply      exit code 1, and the difference, if not
"""

import struct
import sys

TYPES = {"float": "f", "double": "d", "uchar": "B", "char": "b", "ushort": "H", "short": "h", "uint": "I", "int": "i"}
SEGMENT = "segment_id"


def read_table(path):
    """The names of the properties of the points, and the values of each point."""
    with open(path, "rb") as file:
        data = file.read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode("ascii").splitlines()
    if "format binary_little_endian 1.0" not in header:
        raise ValueError(f"{path}: is not binary_little_endian")
    count = next(int(line.split()[2]) for line in header if line.startswith("element vertex "))
    fields = [line.split()[1:] for line in header if line.startswith("property ")]
    record = struct.Struct("<" + "".join(TYPES[kind] for kind, _ in fields))
    if len(data) != end + count * record.size:
        raise ValueError(f"{path}: has {len(data) - end} bytes of points, expected {count * record.size}")
    return [name for _, name in fields], list(record.iter_unpack(data[end:]))


def read_points(path):
    """Each point as (its record without the segment, its segment), sorted."""
    names, table = read_table(path)
    place = names.index(SEGMENT)
    return sorted((values[:place] + values[place + 1:], values[place]) for values in table)


def difference(path_a, path_b):
    """What differs; empty: nothing."""
    a, b = read_points(path_a), read_points(path_b)
    if len(a) != len(b):
        return f"{path_a} has {len(a)} points, {path_b} has {len(b)}"
    segment_in_b, segment_in_a = {}, {}
    for (point_a, segment_a), (point_b, segment_b) in zip(a, b, strict=True):
        if point_a != point_b:
            return f"the point {point_a} of {path_a} is not in {path_b}"
        if segment_in_b.setdefault(segment_a, segment_b) != segment_b:
            return f"segment {segment_a} of {path_a} is more than one in {path_b}"
        if segment_in_a.setdefault(segment_b, segment_a) != segment_a:
            return f"segment {segment_b} of {path_b} is more than one in {path_a}"
    return ""


def main(arguments):
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    text = difference(*arguments)
    if text:
        print(f"same_partition: {text}", file=sys.stderr)
    return 1 if text else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
