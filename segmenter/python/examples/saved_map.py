#!/usr/bin/python3
"""Lists the planar segments of a saved map, the largest first.

    saved_map.py out/trio/segmenter.map
"""

import sys

import kintsugi
import numpy as np


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    saved = kintsugi.load_map(sys.argv[1])
    print(saved)
    for segment in saved.query(planar=True, largest=20).segments:
        mine = saved.points[saved.labels == segment["id"]]
        print("segment %d: %d points, %.2f m^2, normal %s, colour %s" % (
            segment["id"], len(mine), segment["area"], np.round(segment["plane_normal"], 2),
            mine["color"].mean(axis=0).astype(int)))


if __name__ == "__main__":
    main()
