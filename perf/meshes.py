# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes from files, for the scripts."""
import sys

import numpy as np


def read_mesh(path):
    """Vertices and triangles of an OFF or OBJ file, by its ending. What is none ends the script, named."""
    try:
        with open(path, encoding="utf-8") as file:
            lines = [words for words in (line.split("#")[0].split() for line in file) if words]
        if str(path).lower().endswith(".obj"):
            vertices = [words[1:4] for words in lines if words[0] == "v"]
            faces = [[int(word.split("/")[0]) for word in words[1:]] for words in lines if words[0] == "f"]
            faces = [[i - 1 if i > 0 else len(vertices) + i for i in face] for face in faces]
        else:
            words = [word for line in lines for word in line]
            count, size = int(words[1]), int(words[2])
            vertices = np.reshape(words[4:4 + 3 * count], (count, 3))
            faces, at = [], 4 + 3 * count
            for _ in range(size if words[0] == "OFF" else 0):
                faces.append([int(word) for word in words[at + 1:at + 1 + int(words[at])]])
                at += 1 + int(words[at])
        triangles = np.array([[face[0], face[k], face[k + 1]] for face in faces for k in range(1, len(face) - 1)], np.int64)
        vertices = np.array(vertices, float)
        if len(triangles) == 0 or triangles.min() < 0 or triangles.max() >= len(vertices):
            raise ValueError("no faces, or corners that are not there")
    except (OSError, ValueError, IndexError) as error:
        sys.exit(f"{path}: no OFF or OBJ file of a mesh: {error}")
    return vertices, triangles.astype(np.uint32)


def scaled(vertices, size):
    """The middle of the box in the origin; its longest side `size` [m], or as it is for None."""
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    return (vertices - (low + high) / 2) * (1 if size is None else size / (high - low).max())
