#!/usr/bin/env python3
"""Prints which segments of a map appear, merge, split and go, and at the end the table of those
that there are. An example of a client in Python; kintsugi-segment-events is the same in C++.

    scripts/segment_events.py --log run.lcm   needs Python 3 and the built tree, nothing else
    scripts/segment_events.py                 from the bus; needs LCM's Python module (import lcm)

What it cannot do: ask for what was lost, or for the full state that tells who begins late what was
before. kintsugi-segment-events does. What is missing is said at the end (exit status 1); the table
is right again after the next update that lists all segments, which the segmenter sends when
somebody else asks.
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

PATIENCE_S = 10.0  # a map that is complete, and a table that is not: nobody sends what is missing


class Listener:
    """The table of one map, from messages of a log or the bus."""

    def __init__(self, types, options):
        self.options = options
        self.map_name = options.map_name
        self.assembler = Assembler(types)
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
    """What is wrong with the log; empty: nothing."""
    log = LogReader(path)
    for channel, data in log:
        listener.handle(channel, data)
    return log.damage


def listen(listener, options):
    """Until Ctrl-C, or the end of the map."""
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
        bus.subscribe(channel, handle).set_queue_capacity(0)  # nothing is dropped
    say("listening; what is lost is not asked for")
    while not stops:
        try:
            bus.handle_timeout(100)
        except OSError:
            if not stops:  # not the signal's doing
                raise
        if options.exit_on_final and listener.table.is_final:
            if not listener.problem() or time.monotonic() - last_news_s > PATIENCE_S:
                return


def generated_types(folder):
    sys.path.insert(0, folder)
    try:
        import kintsugi
    except ImportError:
        sys.exit("segment_events.py: no message types in %s; run scripts/build, or "
                 "lcm-gen -p --ppath DIR lcmtypes/*.lcm, and give --types DIR" % folder)
    return kintsugi


def parse_options():
    programs = os.environ.get("KINTSUGI_BIN", os.path.join(ROOT, "build", "release", "bin"))
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--log", help="read this LCM log instead of the bus")
    parser.add_argument("--lcm-url", help="bus; default: LCM_DEFAULT_URL, or LCM's own")
    parser.add_argument("--map-name", default="",
                        help="follow the map with this name (default: the first that is heard)")
    parser.add_argument("--exit-on-final", action="store_true",
                        help="exit when the map is complete, and not only on Ctrl-C")
    parser.add_argument("--grown", action="store_true", help="a line for each segment that grew, too")
    parser.add_argument("--quiet", action="store_true", help="only the table at the end")
    parser.add_argument("--top", type=int, default=20, help="segments in the table that is printed")
    parser.add_argument("--json", help="the whole table into this file, as JSON")
    parser.add_argument("--types", default=os.path.join(programs, "..", "share", "python"),
                        help="folder of the types that lcm-gen -p has made")
    return parser.parse_args()


def main():
    options = parse_options()
    listener = Listener(generated_types(options.types), options)
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
