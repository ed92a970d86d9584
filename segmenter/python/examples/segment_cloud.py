#!/usr/bin/python3
"""Segments one point cloud and prints its largest segments.

    segment_cloud.py                 a small room
    segment_cloud.py CLOUD.npy 0.01  an array (N, 3) of positions in metres, 1 cm apart
"""

import sys

import kintsugi
import numpy as np
import room


def main():
    if len(sys.argv) == 3:
        segmenter = kintsugi.Segmenter(resolution=float(sys.argv[2]))
        piece = segmenter.add(np.load(sys.argv[1]))  # normals are estimated
    elif len(sys.argv) == 1:
        segmenter = kintsugi.Segmenter(resolution=room.SPACING)
        points, normals, colors = room.joined(room.walls(), room.box(-0.2, 1.8))
        piece = segmenter.add(points, normals, colors)
    else:
        sys.exit(__doc__)

    labels = segmenter.labels(piece)
    print("%d points, %d segments" % (len(labels), segmenter.num_segments))
    for segment in segmenter.query(largest=10).segments:
        print("segment %d: %d points, %.2f m^2, %s, at %s" % (
            segment["id"], segment["points"], segment["area"],
            "planar" if segment["planar"] else "not planar", np.round(segment["centroid"], 2)))


if __name__ == "__main__":
    main()
