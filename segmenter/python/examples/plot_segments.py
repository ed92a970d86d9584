#!/usr/bin/python3
"""Draws a floor plan of a saved map, coloured by segment, with matplotlib. Needs python3-matplotlib.

    plot_segments.py out/trio/segmenter.map plan.png
"""

import sys

import kintsugi
import matplotlib

matplotlib.use("Agg")  # without a screen
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    saved = kintsugi.load_map(sys.argv[1])
    position = saved.points["position"]
    shown = np.argsort(-position[:, 1])  # y points down: what is higher is drawn later
    figure, axes = plt.subplots(figsize=(8, 8))
    axes.scatter(position[shown, 0], position[shown, 2], c=saved.labels[shown] * 7919 % 20, cmap="tab20", s=1)
    for segment in saved.query(largest=10).segments:
        axes.annotate(str(segment["id"]), segment["centroid"][[0, 2]])
    axes.set(xlabel="x, m", ylabel="z, m", aspect="equal", title="%d segments" % len(saved.segments()))
    figure.savefig(sys.argv[2], dpi=100)
    print("%s: the %d largest of %d segments have their number" % (
        sys.argv[2], min(10, len(saved.segments())), len(saved.segments())))


if __name__ == "__main__":
    main()
