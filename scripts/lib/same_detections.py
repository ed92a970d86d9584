#!/usr/bin/env python3
"""Compares two files of kintsugi-objects detect --json: the same objects at the same poses. Numbers of detections, ids of
segments and times may differ, as they do from run to run.

Usage: same_detections.py FILE OTHER      exit code 1, and what differs, if they are not the same"""

import json
import sys

NEAR = 1e-4  # metres, and elements of a rotation: the same points in another order round otherwise


def detections(path):
    with open(path) as file:
        return sorted(((each["name"], tuple(each["X_WO"]), each["points"], each["score"])
                       for each in json.load(file)["detections"]))


def are_same(first, other):
    (name, pose, points, score), (other_name, other_pose, other_points, other_score) = first, other
    return (name == other_name and points == other_points and abs(score - other_score) < NEAR and
            all(abs(a - b) < NEAR for a, b in zip(pose, other_pose, strict=True)))


def difference(first, other):
    """What is only in one of the two, as lines; each detection is paired with one of the other list."""
    left = list(other)
    lines = []
    for each in first:
        pair = next((candidate for candidate in left if are_same(each, candidate)), None)
        if pair is None:
            lines.append(f"- {each}")
        else:
            left.remove(pair)
    return lines + [f"+ {each}" for each in left]


def main(arguments):
    if len(arguments) != 2:
        print(__doc__.split("Usage: ")[1], file=sys.stderr)
        return 2
    lines = difference(*map(detections, arguments))
    if lines:
        print("\n".join([f"{arguments[1]} has other detections than {arguments[0]}:", *lines]), file=sys.stderr)
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
