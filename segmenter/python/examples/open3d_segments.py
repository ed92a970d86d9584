#!/usr/bin/python3
"""Segments a cloud that Open3D reads, and writes it coloured by segment. Needs python3-open3d.

    open3d_segments.py CLOUD.ply SEGMENTS.ply [RESOLUTION]     any format of Open3D; metres (default 0.02)
    open3d_segments.py ROOM.ply                                writes the segments of a small room
"""

import sys

import kintsugi
import numpy as np
import open3d as o3d
import room


def room_cloud():
    points, normals, colors = room.joined(room.walls(), room.box(-0.2, 1.8))
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points))
    cloud.normals = o3d.utility.Vector3dVector(normals)
    cloud.colors = o3d.utility.Vector3dVector(colors / 255.0)
    return cloud


def segment(cloud, resolution):
    """The segment of each point of an Open3D cloud, (N,) uint32."""
    segmenter = kintsugi.Segmenter(resolution)
    colors = np.round(255 * np.asarray(cloud.colors)).astype(np.uint8) if cloud.has_colors() else None
    normals = np.asarray(cloud.normals) if cloud.has_normals() else None
    return segmenter.labels(segmenter.add(np.asarray(cloud.points), normals, colors))


def main():
    if not 2 <= len(sys.argv) <= 4:
        sys.exit(__doc__)
    cloud = room_cloud() if len(sys.argv) == 2 else o3d.io.read_point_cloud(sys.argv[1])
    labels = segment(cloud, float(sys.argv[3]) if len(sys.argv) == 4 else room.SPACING)
    palette = np.random.default_rng(0).uniform(0.2, 1.0, (labels.max(initial=0) + 1, 3))
    palette[0] = 0.0  # no segment
    cloud.colors = o3d.utility.Vector3dVector(palette[labels])
    output = sys.argv[2] if len(sys.argv) > 2 else sys.argv[1]
    if not o3d.io.write_point_cloud(output, cloud):
        sys.exit("cannot write %s" % output)
    print("%s: %d points, %d segments" % (output, len(labels), len(np.unique(labels[labels > 0]))))


if __name__ == "__main__":
    main()
