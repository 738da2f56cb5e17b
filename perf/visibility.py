# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""What views of a known object see. Needs PYTHONPATH=build/release/python.

A view sees a sample of the surface under these conditions, which are those of the policy `oracle`:

- The sample is in the image and within the sensor's range limits.
- The angle of incidence is below 72 deg.
- No triangle is in front of the sample.

The last condition is checked with a depth image of three times the resolution. The depth of the
nearest pixel must agree with that of the sample. The tolerance is the change of depth within half a
pixel, given the slope of the surface. On the camel this is wrong for one sample in 100, mostly near
the silhouette.
"""
import numpy as np
import viewgain

FINER = 3
LEAST_COSINE = np.cos(np.radians(72))
EXACT = 2e-4  # tolerance of depths in addition to the slope's [m]


class KnownObject:
    """Samples of equal area on an object centred at the origin, and which of them a view sees."""

    def __init__(self, vertices, triangles, sensor, samples):
        camera = sensor.camera
        centre = lambda c: FINER * c + (FINER - 1) / 2  # keeps the rays: the centre of pixel (0, 0) is at (0, 0)
        self.camera = viewgain.PinholeCamera(width=FINER * camera.width, height=FINER * camera.height, fx=FINER * camera.fx,
                                             fy=FINER * camera.fy, cx=centre(camera.cx), cy=centre(camera.cy),
                                             distortion=camera.distortion)
        self.sensor = viewgain.Sensor(self.camera, min_range=sensor.min_range, max_range=sensor.max_range,
                                      working_distance=sensor.working_distance, noise=viewgain.ConstantNoise())
        self.simulated = viewgain.SimulatedSensor(vertices, triangles, self.sensor)
        corners = vertices[triangles]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        areas = np.linalg.norm(normals, axis=1) / 2
        self.area = float(areas.sum())
        # Stratified over the area of the triangles in order, random within each triangle.
        random = np.random.default_rng(1)
        at = (np.arange(samples) + random.random(samples)) / samples * self.area
        of = np.minimum(np.searchsorted(np.cumsum(areas), at), len(areas) - 1)
        s, t = np.sqrt(random.random(samples))[:, None], random.random(samples)[:, None]
        self.points = (1 - s) * corners[of, 0] + s * (1 - t) * corners[of, 1] + s * t * corners[of, 2]
        self.normals = normals[of] / (2 * areas[of][:, None])

    def sees(self, T_world_camera, least_cosine=LEAST_COSINE):
        """One bool per sample."""
        sight = self.points - T_world_camera[:3, 3]
        ranges = np.linalg.norm(sight, axis=1)
        cosine = np.abs((sight * self.normals).sum(axis=1)) / ranges
        at_camera = sight @ T_world_camera[:3, :3]
        asked = np.flatnonzero((cosine >= least_cosine) & (ranges > self.sensor.min_range) & (ranges < self.sensor.max_range) &
                               (at_camera[:, 2] > 0))
        seen = np.zeros(len(self.points), bool)
        if len(asked) == 0:
            return seen
        pixel = np.rint(self.camera.project(at_camera[asked])).astype(int)
        inside = ((pixel >= 0) & (pixel < [self.camera.width, self.camera.height])).all(axis=1)
        asked, (column, row) = asked[inside], pixel[inside].T
        depth = self.simulated.acquire(T_world_camera).depth[row, column]
        z = at_camera[asked, 2]
        half_pixel = z / min(self.camera.fx, self.camera.fy) / np.sqrt(2)
        slope = np.sqrt(1 - cosine[asked] ** 2) / cosine[asked]
        seen[asked] = z <= depth + half_pixel * slope + EXACT
        return seen

    def matrix(self, poses):
        """A row per pose, a column per sample."""
        return np.array([self.sees(pose) for pose in poses]).reshape(len(poses), len(self.points))
