#!/usr/bin/python3
"""Reads a log and prints how the map grew, and its points and segments at the end.

    read_log.py out/trio/run.lcm
"""

import sys

import kintsugi
import numpy as np


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    client = kintsugi.open_log(sys.argv[1])
    num_poses = 0
    while not client.has_ended:
        changes = client.wait()
        num_poses += len(changes.poses)
        for update in changes.updates:
            merged = np.count_nonzero(update.events["type"] == kintsugi.MERGED)
            print("piece %d: %d points, %d segments, %d merged" % (
                update.piece, update.num_points, update.num_segments, merged))

    points = sum(len(client.points(piece)) for piece in client.pieces)
    segmented = sum(np.count_nonzero(client.labels(piece)) for piece in client.pieces)
    print("%d pieces with %d points, %d of them in %d segments; %d camera poses" % (
        len(client.pieces), points, segmented, len(client.segments()), num_poses))
    if client.damage or client.problem:
        sys.exit(client.damage or client.problem)


if __name__ == "__main__":
    main()
