#!/usr/bin/env python3
"""Prints which segments of a map are created, merged, split and retired, and at the end the table
of all segments. An example of a client in Python; kintsugi-segment-events is the same in C++.

    scripts/segment_events.py --log run.lcm   needs Python 3 and the built tree, nothing else
    scripts/segment_events.py                 from the bus; needs LCM's Python module (import lcm)

Unlike kintsugi-segment-events, it cannot request lost chunks, nor the full state that a client needs
that joins late. If something is missing at the end, it says so, and the exit status is 1. The table
is correct again after the next update that lists all segments, which the segmenter sends when
another client requests a full state.
"""

import argparse
import os
import signal
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(ROOT, "scripts", "lib"))

from segment_table import SegmentTable  # noqa: E402
from segment_text import print_table, print_update, write_json  # noqa: E402
from segment_updates import CHANNEL, HEARTBEAT, Assembler, BadMessage, LogReader  # noqa: E402

PATIENCE_S = 10.0  # how long to wait for missing updates after the map is complete


class Listener:
    """Keeps the table of one map, from messages of a log or the bus."""

    def __init__(self, types, layout, options):
        self.options = options
        self.map_name = options.map_name
        self.assembler = Assembler(types, layout)
        self.table = SegmentTable()
        self.num_bad = 0
        self.last_bad = ""

    def handle(self, channel, data):
        try:
            update = self.assembler.handle(channel, data)
        except BadMessage as reason:
            self.num_bad += 1
            self.last_bad = str(reason)
            return
        if update is None:
            return
        self.map_name = self.map_name or update.header.map_name
        if update.header.map_name == self.map_name and self.table.apply(update):
            if not self.options.quiet:
                print_update(update, self.options.grown)

    def problem(self):
        return self.table.problem(self.assembler)


def say(text):
    print("segment_events.py: " + text, file=sys.stderr)


def read_log(listener, path):
    """Reads the log up to its end or first damage. Returns the damage; empty: none."""
    log = LogReader(path)
    for channel, data in log:
        listener.handle(channel, data)
    return log.damage


def listen(listener, options):
    """Receives until Ctrl-C, or the end of the map."""
    try:
        import lcm
    except ImportError:
        sys.exit("segment_events.py: there is no Python module 'lcm' here, so it cannot listen on the bus; "
                 "give it --log FILE, or use kintsugi-segment-events")
    stops = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stops.append(1))
    bus = lcm.LCM(options.lcm_url) if options.lcm_url else lcm.LCM()
    last_news_s = time.monotonic()

    def handle(channel, data):
        nonlocal last_news_s
        if channel == CHANNEL:
            last_news_s = time.monotonic()
        listener.handle(channel, data)

    for channel in (CHANNEL, HEARTBEAT):
        bus.subscribe(channel, handle).set_queue_capacity(0)  # no limit
    say("listening; lost chunks are not requested")
    while not stops:
        try:
            bus.handle_timeout(100)
        except OSError:
            if not stops:  # not interrupted by the signal
                raise
        if options.exit_on_final and listener.table.is_final:
            if not listener.problem() or time.monotonic() - last_news_s > PATIENCE_S:
                return


def generated_modules(folder):
    """The message types and the layout of packed records."""
    sys.path.insert(0, folder)
    try:
        import kintsugi
        import kintsugi_layout
    except ImportError:
        sys.exit("segment_events.py: no message types in %s; run scripts/build, or give --types DIR, "
                 "the folder share/python of a build" % folder)
    return kintsugi, kintsugi_layout


def parse_options():
    programs = os.environ.get("KINTSUGI_BIN", os.path.join(ROOT, "build", "release", "bin"))
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--log", help="read this LCM log instead of the bus")
    parser.add_argument("--lcm-url", help="bus; default: LCM_DEFAULT_URL, or LCM's own")
    parser.add_argument("--map-name", default="",
                        help="follow the map with this name (default: the first that is received)")
    parser.add_argument("--exit-on-final", action="store_true",
                        help="exit when the map is complete, not only on Ctrl-C")
    parser.add_argument("--grown", action="store_true", help="print a line for each segment that grew, too")
    parser.add_argument("--quiet", action="store_true", help="print only the table at the end")
    parser.add_argument("--top", type=int, default=20, help="number of segments in the printed table")
    parser.add_argument("--json", help="write the whole table to this file, as JSON")
    parser.add_argument("--types", default=os.path.join(programs, "..", "share", "python"),
                        help="folder of the generated Python modules")
    return parser.parse_args()


def main():
    options = parse_options()
    listener = Listener(*generated_modules(options.types), options)
    damage = ""
    if options.log:
        damage = read_log(listener, options.log)
    else:
        listen(listener, options)
    problem = listener.problem()
    print_table(listener.table, options.top)
    if options.json and listener.table.newest:
        write_json(listener.table, not problem, options.json)
    if listener.num_bad:
        say("messages dropped: %d, the last: %s" % (listener.num_bad, listener.last_bad))
    for text in (damage, problem):
        if text:
            say(text)
    return 1 if damage or problem else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except OSError as error:
        sys.exit("segment_events.py: %s" % error)
