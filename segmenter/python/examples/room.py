"""A small room as arrays, for the examples: a floor, two walls and a box on the floor."""

import numpy as np

SPACING = 0.02  # metres


def rectangle(corner, side_u, side_v, normal, color):
    """Points (N, 3) in metres, normals (N, 3) and colours (N, 3) of a rectangle; y points down."""
    corner, side_u, side_v = (np.asarray(vector, float) for vector in (corner, side_u, side_v))
    steps = [np.arange(0, np.linalg.norm(side) + 1e-9, SPACING) / np.linalg.norm(side)
             for side in (side_u, side_v)]
    u, v = (steps.ravel() for steps in np.meshgrid(*steps))
    points = corner + u[:, None] * side_u + v[:, None] * side_v
    return points, np.tile(np.asarray(normal, float), (len(points), 1)), np.tile(np.uint8(color), (len(points), 1))


def joined(*parts):
    return tuple(np.concatenate(arrays) for arrays in zip(*parts))


def box(x, z, side=0.4):
    """The box on the floor with its front left corner at (x, z)."""
    top = 1.0 - side
    red = (200, 40, 30)
    return joined(rectangle((x, top, z), (side, 0, 0), (0, 0, side), (0, -1, 0), red),
                  rectangle((x, top, z), (side, 0, 0), (0, side, 0), (0, 0, -1), red))


def walls():
    return joined(rectangle((-1, 1, 1), (2, 0, 0), (0, 0, 2), (0, -1, 0), (150, 120, 90)),
                  rectangle((-1, -1, 3), (2, 0, 0), (0, 2, 0), (0, 0, -1), (220, 220, 210)),
                  rectangle((-1, -1, 1), (0, 0, 2), (0, 2, 0), (1, 0, 0), (220, 220, 210)))
