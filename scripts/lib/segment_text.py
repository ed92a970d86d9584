"""Segment updates and tables as text and as JSON, the same as kintsugi-segment-events writes."""

import json
import struct
import sys

CREATED, GROWN, MERGED, SPLIT, RETIRED = range(5)


def rows(segments):
    """The segments of an array of kintsugi.SEGMENT, each as a dict of Python's own numbers and lists."""
    columns = {name: segments[name].tolist() for name in segments.dtype.names}
    return [dict(zip(columns, values)) for values in zip(*columns.values())]


def summary_text(update):
    revision = " revision %d" % update.revision if update.revision > 0 else ""
    text = "slice %d%s: %d points, %d segments" % (
        update.piece, revision, update.num_points, update.num_segments)
    if len(update.events) == 0 and update.lists_all:
        return text + ", all listed"
    types = update.events["type"].tolist()
    return text + "; %d created, %d grown, %d merged, %d split, %d retired" % tuple(
        types.count(kind) for kind in range(5))


def event_text(event, changed):
    kind, segment_id, other_id = event
    text = {CREATED: "  {0} created", GROWN: "  {0} grown", MERGED: "  {1} merged into {0}",
            SPLIT: "  {1} split off {0}", RETIRED: "  {0} retired"}[kind]
    text = text.format(segment_id, other_id)
    subject = changed.get(other_id if kind == SPLIT else segment_id)
    if subject is None:
        return text
    return text + ": %d points at %.2f %.2f %.2f m" % (subject["points"], *subject["centroid"])


def print_update(update, with_grown):
    if len(update.events) == 0 and len(update.segments) == 0:
        return
    print(summary_text(update))
    changed = {row["id"]: row for row in rows(update.segments)}
    for event in update.events.tolist():
        if event[0] != GROWN or with_grown:
            print(event_text(event, changed))
    sys.stdout.flush()


def print_table(client, num_listed):
    newest = client.newest_update
    if newest is None:
        print("no segment updates")
        return
    segments = rows(client.segments())
    print("map '%s' of session %d: %d slices, %d points, %d segments%s" % (
        newest.map_name, newest.map_session, newest.num_pieces, newest.num_points,
        len(segments), ", complete" if client.is_complete else ""))
    listed = sorted(segments, key=lambda row: -row["points"])[:num_listed]
    if listed:
        print("      id    points  area m^2   centroid in W, m         box, m              "
              "colour        slices")
    for row in listed:
        sides = [high - low for low, high in zip(row["box_min"], row["box_max"])]
        print("%8d %9d %9.3f   %6.2f %6.2f %6.2f   %5.2f %5.2f %5.2f   %3d %3d %3d   %d-%d" % (
            row["id"], row["points"], row["area"], *row["centroid"], *sides, *row["mean_color"],
            row["first_slice"], row["last_slice"]))
    if len(segments) > len(listed):
        print("and %d smaller ones" % (len(segments) - len(listed)))


def readable(value):
    """The fewest decimals that identify this float32, as in segments.json."""
    for digits in range(1, 10):
        text = "%.*g" % (digits, value)
        if struct.pack("<f", float(text)) == struct.pack("<f", value):
            return float(text)
    return value


def field_json(value):
    if isinstance(value, list):
        return [field_json(element) for element in value]
    return readable(value) if isinstance(value, float) else value


def segment_json(row, birth):
    entry = {name: field_json(value) for name, value in row.items()}
    entry["born"] = birth and {"slice": birth[0], "parent": birth[1]}
    return entry


def write_json(client, path):
    newest = client.newest_update
    document = {"map_name": newest.map_name, "map_session": newest.map_session, "session": newest.session,
                "num_slices": newest.num_pieces, "num_points": newest.num_points,
                "num_segments": newest.num_segments, "complete": client.is_complete,
                "whole": not client.problem}
    document["segments"] = [segment_json(row, client.birth(row["id"])) for row in rows(client.segments())]
    with open(path, "w", encoding="utf-8") as file:
        json.dump(document, file, indent=1)
        file.write("\n")
