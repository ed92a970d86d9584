"""points_in_100_cells.py FILE.ply SIDE_M: how many points there are in 100 cells of this side that have any. Where a
surface is there twice they are twice as many.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts" / "lib"))

from same_partition import read_table  # noqa: E402

path, side_m = sys.argv[1], float(sys.argv[2])
names, points = read_table(path)
axes = [names.index(axis) for axis in "xyz"]
cells = {tuple(int(point[axis] // side_m) for axis in axes) for point in points}
print(round(100 * len(points) / len(cells)))
