# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
import os
import struct
import zlib

import numpy as np
import pytest

import viewgain


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item):
    """Where CI is set, a test that is skipped has failed."""
    report = (yield).get_result()
    if report.skipped and os.environ.get("CI"):
        report.outcome, report.longrepr = "failed", f"skipped: {report.longrepr}"


@pytest.fixture(scope="session")
def sensor():
    return viewgain.sensor_preset("sr4000")


@pytest.fixture(scope="session")
def labels():
    """An occupied box, unknown inside and on one side, free around."""
    array = np.ones((32, 32, 32), np.uint8)
    array[8:24, 8:24, 8:24] = 2
    array[10:22, 10:22, 10:22] = 0
    array[:, 24:, :8] = 0
    return array


@pytest.fixture(scope="session")
def grid(labels, sensor):
    return viewgain.BeliefGrid.from_labels(
        labels, voxel_size=0.01, origin=(-0.16, -0.16, -0.16), sensor=sensor)


@pytest.fixture(scope="session")
def evaluator(grid, sensor):
    return viewgain.GainEvaluator(viewgain.VoxelScene(grid), sensor, gain="paper", pixel_stride=4, num_threads=2)


@pytest.fixture(scope="session")
def poses():
    return viewgain.sphere_poses(60, 0.6)


def box_mesh(low, high):
    """Vertices (8, 3) and triangles (12, 3) of a box, outward."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    vertices = np.asarray(low) + corners * (np.asarray(high) - np.asarray(low))
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return vertices, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def gray_png(pixels):
    """A PNG of 16 bits."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in pixels)
    height, width = pixels.shape
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 16, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
