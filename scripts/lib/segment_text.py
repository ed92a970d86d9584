"""Segment updates and tables as text and as JSON, the same as kintsugi-segment-events writes."""

import json
import struct
import sys

from segment_updates import CREATED, GROWN, MERGED, RETIRED, SPLIT


def summary_text(update):
    header = update.header
    revision = " revision %d" % header.slice_revision if header.slice_revision > 0 else ""
    text = "slice %d%s: %d points, %d segments" % (
        header.slice_id, revision, header.num_points, header.num_segments)
    if not update.events and update.lists_all():
        return text + ", all listed"
    counts = [sum(1 for event in update.events if event.type == kind) for kind in range(5)]
    return text + "; %d created, %d grown, %d merged, %d split, %d retired" % tuple(counts)


def event_text(event, changed):
    text = {CREATED: "  {0} created", GROWN: "  {0} grown", MERGED: "  {1} merged into {0}",
            SPLIT: "  {1} split off {0}", RETIRED: "  {0} retired"}[event.type]
    text = text.format(event.segment_id, event.other_id)
    subject = changed.get(event.other_id if event.type == SPLIT else event.segment_id)
    return text + (": %d points at %.2f %.2f %.2f m" % (subject.points, *subject.centroid) if subject else "")


def print_update(update, with_grown):
    if not update.events and not update.statistics:
        return
    print(summary_text(update))
    changed = {row.id: row for row in update.statistics}
    for event in update.events:
        if event.type != GROWN or with_grown:
            print(event_text(event, changed))
    sys.stdout.flush()


def print_table(table, num_listed):
    if not table.newest:
        print("no segment updates")
        return
    header = table.newest.header
    print("map '%s' of session %d: %d slices, %d points, %d segments%s" % (
        header.map_name, header.map_session, header.num_slices, header.num_points,
        len(table.segments), ", complete" if table.is_final else ""))
    rows = sorted(table.statistics(), key=lambda row: -row.points)[:num_listed]
    if rows:
        print("      id    points  area m^2   centroid in W, m         box, m              "
              "colour        slices")
    for row in rows:
        sides = [high - low for low, high in zip(row.box_min, row.box_max)]
        print("%8d %9d %9.3f   %6.2f %6.2f %6.2f   %5.2f %5.2f %5.2f   %3d %3d %3d   %d-%d" % (
            row.id, row.points, row.area, *row.centroid, *sides, *row.mean_color,
            row.first_slice, row.last_slice))
    if len(table.segments) > len(rows):
        print("and %d smaller ones" % (len(table.segments) - len(rows)))


def readable(value):
    """The fewest decimals that identify this float32, as in segments.json."""
    for digits in range(1, 10):
        text = "%.*g" % (digits, value)
        if struct.pack("<f", float(text)) == struct.pack("<f", value):
            return float(text)
    return value


def field_json(value):
    if isinstance(value, tuple):
        return [field_json(element) for element in value]
    return readable(value) if isinstance(value, float) else value


def segment_json(statistics, born):
    entry = {name: field_json(value) for name, value in statistics._asdict().items()}
    entry["born"] = born
    return entry


def write_json(table, is_whole, path):
    header = table.newest.header
    names = ("map_name", "map_session", "session", "num_slices", "num_points", "num_segments")
    document = {name: getattr(header, name) for name in names}
    document.update(complete=table.is_final, whole=is_whole)
    document["segments"] = [segment_json(row, table.born.get(row.id))
                            for row in table.statistics()]
    with open(path, "w", encoding="utf-8") as file:
        json.dump(document, file, indent=1)
        file.write("\n")
