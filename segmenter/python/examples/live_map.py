#!/usr/bin/python3
"""Follows the map on the bus while it is built, asks for its largest segment, and ends with the map.

    live_map.py [SECONDS]     ends after so many seconds without the end of the map (default 60)
"""

import sys
import time

import kintsugi


def main():
    end_s = time.monotonic() + (float(sys.argv[1]) if len(sys.argv) > 1 else 60.0)
    client = kintsugi.connect()
    print("listening", flush=True)
    while not client.has_ended and time.monotonic() < end_s:
        changes = client.wait(timeout=0.5)
        for update in changes.updates:
            print("piece %d: %d points, %d segments" % (update.piece, update.num_points, update.num_segments))
        if changes.poses:
            print("camera at %s" % changes.poses[-1].X_WC[:3, 3])

    if client.newest_update is None:
        sys.exit("no segment update was received; are mapper and segmenter running?")
    answer = client.query(largest=1, timeout=10.0)
    largest = answer.segments[0]
    print("map '%s', %s: %d pieces here, %d segments; the largest is %d, %.2f m^2" % (
        answer.map_name, "complete" if client.is_complete else "not complete", len(client.pieces),
        answer.map_segments, largest["id"], largest["area"]))


if __name__ == "__main__":
    main()
