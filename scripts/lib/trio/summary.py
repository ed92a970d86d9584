"""What a run took and wrote, for the person."""

import re

from .messages import STDOUT, say, write

WRITTEN_FILES = (
    ("segments.ply", "the map: x y z, normal, colour, segment_id, slice_id, weight"),
    ("segments.json", "every segment: points, boxes, plane, normal, colour, area, neighbours"),
    ("segments.csv", "the same as a table"),
    ("objects.json", "known objects that were found: name, pose, score, segments"),
    ("final.png", "the map in true colour and in the colours of its segments"),
    ("map_final.png", "the whole map in true colour"),
    ("segments_final.png", "the whole map, each segment in its own colour"),
    ("objects_final.png", "the objects that were found, in the whole map"),
    ("run.mp4", "the run as a video (H.264): the camera's image with the segments in it, and the map"),
    ("trajectory.txt", "the camera's path (TUM format)"),
    ("mapper.lcm", "everything the mapper published (scripts/replay plays it; --resume continues it)"),
    ("segmenter.map", "the segment map, for kintsugi-query --map, -diff, -objects, and -segmenter --resume"),
    ("run.lcm", "everything that was on the bus (scripts/replay plays it)"),
    ("status.csv", "every number in the statuses of the processes"),
)


def show_summary(folder, processes, since=0.0):
    """CPU time and peak memory of the processes, and the files of the run that exist and were written since then (seconds
    of the system's clock)."""
    cpu = ", ".join(f"{p.name} {p.cpu_s:.2f} s" for p in processes if p.cpu_s is not None)
    memory = ", ".join(f"{p.name} {p.peak_memory_MB} MB" for p in processes if p.peak_memory_MB is not None)
    write(STDOUT, f"  CPU: {cpu}\n  memory at most: {memory}\n")
    parts = named_parts(folder)
    if parts:
        say(f"the camera stayed lost, so the map has {len({0, *parts})} parts, and nobody knows where they are relative "
            "to each other; final.png shows the last")
    say("written:")
    for name, text in WRITTEN_FILES:
        show_file(folder, name, text, since)
        for part in parts:
            show_file(folder, name_in_part(name, part), f"the same of part {part}", since)
    num_snapshots = len(list(folder.path.glob("snapshot_*.png")))
    write(STDOUT, f"  {folder.file('snapshot_*.png'):<28} {num_snapshots} pictures of the run\n")


def show_file(folder, name, text, since):
    """If there is one."""
    path = folder.path / name
    if path.exists() and path.stat().st_mtime >= since:
        write(STDOUT, f"  {folder.file(name):<28} {text}\n")


def named_parts(folder):
    """The parts of the map that have files with their number in the name: those after part 0, and part 0 where the
    plain names of the pictures belong to a later one."""
    found = (re.search(r"\.part(\d+)\.", file.name) for file in folder.path.glob("*.part*.*"))
    return sorted({int(match[1]) for match in found if match})


def name_in_part(name, part):
    stem, dot, extension = name.rpartition(".")
    return f"{stem}.part{part}{dot}{extension}"
