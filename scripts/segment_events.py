#!/usr/bin/python3
"""Prints which segments of a map are created, merged, split and retired, and at the end the table
of all segments. An example of a client in Python; kintsugi-segment-events is the same in C++.

    scripts/segment_events.py --log run.lcm   from a log
    scripts/segment_events.py                 from the bus

It needs the Python package kintsugi of the built tree, and nothing else. If something is missing at
the end, it says so, and the exit status is 1.
"""

import argparse
import os
import signal
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(ROOT, "scripts", "lib"))

from segment_text import print_table, print_update, write_json  # noqa: E402


def say(text):
    if text:
        print("segment_events.py: " + text, file=sys.stderr, flush=True)


def print_updates(changes, options):
    for update in changes.updates:
        if not options.quiet:
            print_update(update, options.grown)


def read_log(kintsugi, options):
    """The map of the log, read up to its end or first damage."""
    client = kintsugi.open_log(options.log, options.map_name, with_points=False, bus_key=options.bus_key,
                               trust_log=options.trust_log)
    while not client.has_ended:
        print_updates(client.wait(), options)
    return client


def listen(kintsugi, options):
    """The map on the bus, received until Ctrl-C or the end of the map."""
    stops = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stops.append(1))
    client = kintsugi.connect(options.lcm_url or "", options.map_name, with_points=False, bus_key=options.bus_key)
    say("listening")
    while not stops and not (options.exit_on_final and client.has_ended):
        print_updates(client.wait(timeout=0.1), options)
    return client


def package(folder):
    """The Python package of a build, or one that is installed."""
    if os.path.isdir(folder):
        sys.path.insert(0, folder)
    try:
        import kintsugi
    except ImportError as reason:
        sys.exit("segment_events.py: no Python package kintsugi in %s (%s); run scripts/build, or give --types DIR, "
                 "the folder share/python of a build" % (folder, reason))
    return kintsugi


def parse_options():
    programs = os.environ.get("KINTSUGI_BIN", os.path.join(ROOT, "build", "release", "bin"))
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--log", help="read this LCM log instead of the bus")
    parser.add_argument("--lcm-url", help="bus; default: LCM_DEFAULT_URL, or multicast on this host")
    parser.add_argument("--bus-key", default="", help="key of a signed bus; default: KINTSUGI_BUS_KEY, or none")
    parser.add_argument("--trust-log", action="store_true",
                        help="read the log whether or not it is signed, and verify nothing in it")
    parser.add_argument("--map-name", default="",
                        help="follow the map with this name (default: the first that is received)")
    parser.add_argument("--exit-on-final", action="store_true",
                        help="exit when the map is complete, not only on Ctrl-C")
    parser.add_argument("--grown", action="store_true", help="print a line for each segment that grew, too")
    parser.add_argument("--quiet", action="store_true", help="print only the table at the end")
    parser.add_argument("--top", type=int, default=20, help="number of segments in the printed table")
    parser.add_argument("--json", help="write the whole table to this file, as JSON")
    parser.add_argument("--types", default=os.path.join(programs, "..", "share", "python"),
                        help="folder of the Python package kintsugi")
    return parser.parse_args()


def main():
    options = parse_options()
    kintsugi = package(options.types)
    client = (read_log if options.log else listen)(kintsugi, options)
    print_table(client, options.top)
    if options.json and client.newest_update:
        write_json(client, options.json)
    for text in (client.dropped, client.damage, client.problem):
        say(text)
    return 1 if client.damage or client.problem else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (OSError, RuntimeError) as error:
        sys.exit("segment_events.py: %s" % error)
