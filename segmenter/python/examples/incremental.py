#!/usr/bin/python3
"""Adds a room and a box as two pieces, moves the box, and tells what happens to segments.

The segments of what did not change keep their ids, and a change costs what it touches.
"""

import time

import kintsugi
import numpy as np
import room

NAMES = {kintsugi.CREATED: "created", kintsugi.GROWN: "has grown", kintsugi.MERGED: "absorbed another",
         kintsugi.SPLIT: "was split", kintsugi.RETIRED: "is gone"}


def tell(what, segmenter, start_s):
    print("%s (%.1f ms): %d segments" % (what, 1000 * (time.monotonic() - start_s), segmenter.num_segments))
    for event in segmenter.events:
        print("    segment %d %s" % (event["id"], NAMES[event["type"]]))


def main():
    segmenter = kintsugi.Segmenter(resolution=room.SPACING)
    start_s = time.monotonic()
    segmenter.add(*room.walls())
    tell("the room", segmenter, start_s)

    start_s = time.monotonic()
    box = segmenter.add(*room.box(-0.2, 1.8))
    tell("a box", segmenter, start_s)
    top = segmenter.query(at=(0.0, 0.6, 2.0)).segments["id"][0]

    X_WP = np.eye(4)
    X_WP[:3, 3] = 0.5, 0.0, -0.3  # metres
    start_s = time.monotonic()
    segmenter.move(box, X_WP)
    tell("the box elsewhere", segmenter, start_s)
    print("the top of the box is segment %d, and was %d" % (
        segmenter.query(at=(0.5, 0.6, 1.7)).segments["id"][0], top))

    segmenter.remove(box)
    print("without the box: %d segments" % segmenter.num_segments)


if __name__ == "__main__":
    main()
