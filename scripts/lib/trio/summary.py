"""What a run took and wrote, for the person."""

from .messages import STDOUT, say, write

WRITTEN_FILES = (
    ("segments.ply", "the map: x y z, normal, colour, segment_id, slice_id, weight"),
    ("segments.json", "every segment: points, boxes, plane, normal, colour, area, neighbours"),
    ("segments.csv", "the same as a table"),
    ("final.png", "the map, its segments and the newest slice"),
    ("map_final.png", "the whole map in true colour"),
    ("segments_final.png", "the whole map, each segment in its own colour"),
    ("run.mp4", "the run as a video"),
    ("trajectory.txt", "the camera's path (TUM format)"),
    ("mapper.lcm", "everything the mapper published (scripts/replay plays it; --resume continues it)"),
    ("segmenter.map", "the segment map, for kintsugi-segmenter --resume and kintsugi-query --map"),
    ("run.lcm", "everything that was on the bus (scripts/replay plays it)"),
    ("status.csv", "every number in the statuses of the processes"),
)


def show_summary(folder, processes):
    """CPU time and peak memory of the processes, and the files of the run that exist."""
    cpu = ", ".join(f"{p.name} {p.cpu_s:.2f} s" for p in processes if p.cpu_s is not None)
    memory = ", ".join(f"{p.name} {p.peak_memory_MB} MB" for p in processes if p.peak_memory_MB is not None)
    write(STDOUT, f"  CPU: {cpu}\n  memory at most: {memory}\n")
    say("written:")
    for name, text in WRITTEN_FILES:
        if (folder.path / name).exists():
            write(STDOUT, f"  {folder.file(name):<28} {text}\n")
    num_snapshots = len(list(folder.path.glob("snapshot_*.png")))
    write(STDOUT, f"  {folder.file('snapshot_*.png'):<28} {num_snapshots} pictures of the run\n")
