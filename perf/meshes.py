# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Reads and writes meshes, for the scripts."""
import pathlib
import re
import sys
import tarfile
import zipfile

import numpy as np

CGAL = pathlib.Path("/usr/share/doc/libcgal-dev/data.tar.gz")
FURNITURE = pathlib.Path("/usr/share/sweethome3d/furniture")


def packaged(path):
    """The file's name and bytes for "cgal:NAME", a mesh of libcgal-demo, or "LIBRARY:NAME", one of sweethome3d-furniture;
    None for other paths."""
    library, colon, name = str(path).partition(":")
    if not colon or not re.fullmatch(r"[\w-]+", library) or pathlib.Path(path).exists():
        return None
    if library == "cgal":
        with tarfile.open(CGAL) as archive:
            return f"{name}.off", archive.extractfile(f"data/meshes/{name}.off").read()
    if not FURNITURE.is_dir():
        sys.exit(f"{path}: the meshes of furniture are not installed; run apps/install_dependencies.sh --furniture")
    with zipfile.ZipFile(FURNITURE / f"{library}.sh3f") as archive:
        wanted = re.compile(rf"[^/]+/{re.escape(name)}/{re.escape(name)}\.obj", re.IGNORECASE)
        found = next((one for one in sorted(archive.namelist()) if wanted.fullmatch(one)), f"{name}.obj")
        return found, archive.read(found)


def read_mesh(path):
    """Vertices and triangles of an OFF or OBJ file, or of a mesh that packaged() finds. Exits with a message if it is not a mesh."""
    try:
        name, data = packaged(path) or (str(path), pathlib.Path(path).read_bytes())
        text = data.decode("utf-8", errors="replace")
        lines = [words for words in (line.split("#")[0].split() for line in text.splitlines()) if words]
        if name.lower().endswith(".obj"):
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
            raise ValueError("no faces, or a face with a vertex that does not exist")
    except (OSError, ValueError, KeyError, IndexError, zipfile.BadZipFile, tarfile.TarError) as error:
        sys.exit(f"{path}: expected a mesh in an OFF or OBJ file: {error}")
    return vertices, triangles.astype(np.uint32)


def scaled(vertices, size):
    """Centres the bounding box at the origin and scales its longest side to `size` [m], unless None."""
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    return (vertices - (low + high) / 2) * (1 if size is None else size / (high - low).max())


def box(low, high):
    """Corners and faces of a box."""
    corners = [[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)]
    return corners, [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def write_off(path, parts):
    """Writes parts, each of corners and faces, as one OFF file."""
    corners, faces = [], []
    for own, sides in parts:
        faces += [[len(corners) + i for i in side] for side in sides]
        corners += own
    rows = [" ".join(map(repr, map(float, c))) for c in corners] + [" ".join(map(str, [len(f), *f])) for f in faces]
    path.write_text(f"OFF\n{len(corners)} {len(faces)} 0\n" + "\n".join(rows) + "\n")
