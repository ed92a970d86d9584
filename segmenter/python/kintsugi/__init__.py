"""Kintsugi: incremental segmentation of dense RGB-D maps.

Segmenter    segments a cloud that is given in pieces, which may change and move
load_map     reads a saved map
connect      follows a map on the bus; open_log, read_log: the same from an LCM log
kintsugi.lcm the message types, for programs that use LCM themselves

Metres, seconds and microseconds (utime); frame W is the map, C the depth camera (x right, y down,
z forward), P a piece; X_AB is the pose of B in A, p_A = X_AB p_B. Arrays of records (POINT, SEGMENT,
...) are numpy's structured arrays: points["position"] is an array (N, 3), without a copy.
"""

from ._kintsugi import (CONTACT, DESCRIBED_SEGMENT, EVENT, POINT, RUN, SEGMENT, Answer, CameraPose, Changes,
                        MapClient, Object, SavedMap, Segmenter, Update, __version__, connect, estimate_normals,
                        load_map, open_log, read_log)

# Types of events (EVENT["type"]).
CREATED, GROWN, MERGED, SPLIT, RETIRED = range(5)

__all__ = ["CONTACT", "CREATED", "DESCRIBED_SEGMENT", "EVENT", "GROWN", "MERGED", "POINT", "RETIRED", "RUN",
           "SEGMENT", "SPLIT", "Answer", "CameraPose", "Changes", "MapClient", "Object", "SavedMap", "Segmenter",
           "Update", "__version__", "connect", "estimate_normals", "load_map", "open_log", "read_log"]
