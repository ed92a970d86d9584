"""compare_tables.py SEGMENTS.json TABLE.json: compares the segments that the segmenter wrote with the table of a
client. Exit code 1, and the first difference, if they are not equal."""

import json
import sys

SAME = ("map_name", "map_session", "complete", "num_slices", "num_points", "num_segments")


def read(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def compare(name, theirs, ours):
    if theirs != ours:
        sys.exit("%s: %s is %s, expected %s" % (sys.argv[2], name, ours, theirs))


segments, table = read(sys.argv[1]), read(sys.argv[2])
for key in SAME:
    compare(key, segments[key], table[key])
compare("whole", True, table["whole"])
compare("number of segments", len(segments["segments"]), len(table["segments"]))
for theirs, ours in zip(segments["segments"], table["segments"]):
    for key in ours.keys() - {"born"}:  # only clients know it
        compare("%s of segment %d" % (key, theirs["id"]), theirs[key], ours[key])
