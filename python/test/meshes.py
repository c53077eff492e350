# SPDX-License-Identifier: Apache-2.0
"""Meshes that the tests refine, as (positions, faces)."""

import numpy as np

CUBE_POSITIONS = np.array(
    [[x, y, z] for z, y, x in np.ndindex(2, 2, 2)], dtype=np.float32) * 2 - 1
CUBE_FACES = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]

# A pyramid over a square, of faces of three and four sides.
PYRAMID_POSITIONS = np.array(
    [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, 1]], dtype=np.float32)
PYRAMID_FACES = [[3, 2, 1, 0], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]


def make_grid(columns, rows):
    """An open sheet of quads."""
    y, x = np.mgrid[0:rows + 1, 0:columns + 1]
    positions = np.stack([x, y, np.sin(x * 0.7) * np.cos(y)], axis=-1).astype(np.float32)
    corner = (y * (columns + 1) + x)[:-1, :-1]
    faces = np.stack([corner, corner + 1, corner + columns + 2, corner + columns + 1], axis=-1)
    return positions.reshape(-1, 3), faces.reshape(-1, 4)


def make_torus(columns, rows):
    """A closed mesh of quads."""
    y, x = np.mgrid[0:rows, 0:columns]
    u, v = 2 * np.pi * x / columns, 2 * np.pi * y / rows
    radius = 2 + np.cos(v)
    positions = np.stack([radius * np.cos(u), radius * np.sin(u), np.sin(v)], axis=-1)
    right, up = (x + 1) % columns, (y + 1) % rows
    faces = np.stack([y * columns + x, y * columns + right, up * columns + right,
                      up * columns + x], axis=-1)
    return positions.reshape(-1, 3).astype(np.float32), faces.reshape(-1, 4)


def refine_literally(positions, faces, weights):
    """One step on a closed mesh as the paper says it, with dictionaries.

    weights(n) is the mask of a face of n sides.  Returns positions and faces in the numbering of
    the library: V-vertices, F-vertices by corner; F-faces, then E-faces in any order.
    """
    new_points, faces_at, beside = [], [[] for _ in positions], {}
    children, corner = [], len(positions)
    for face in faces:
        n = len(face)
        mask = weights(n)
        for i in range(n):
            point = sum(mask[j] * positions[face[(i + j) % n]] for j in range(n))
            new_points.append(point)
            faces_at[face[i]].append(point)
            after = (i + 1) % n
            beside[face[i], face[after]] = (corner + i, corner + after)
        children.append(list(range(corner, corner + n)))
        corner += n
    moved = [(p + sum(points)) / (len(points) + 1) for p, points in zip(positions, faces_at)]
    for (start, end), (a_start, a_end) in beside.items():
        if start < end:
            b_end, b_start = beside[end, start]
            children.append([start, b_start, b_end, end, a_end, a_start])
    return np.array(moved + new_points), children
