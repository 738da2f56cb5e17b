# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Scores camera poses by expected information gain.

>>> import numpy, viewgain
>>> sensor = viewgain.sensor_preset("sr4000")
>>> workspace = [(0, 0, 0), (0.32, 0.32, 0.32)]
>>> scorer = viewgain.ViewScorer(sensor, voxel_size=0.005, workspace=workspace)
>>> changed = scorer.set((0, 0, 0), numpy.ones((64, 64, 32), numpy.uint8))   # 0 unknown, 1 free, 2 occupied
>>> poses = viewgain.sphere_poses(500, 0.6, center=(0.16, 0.16, 0.16))   # (500, 4, 4) T_world_camera
>>> gains = scorer.evaluate(poses)                              # (500,), nat
>>> best = scorer.best(poses, 3).indices                        # best first

Frames and units: a pose is ``T_world_camera``, a 4x4 matrix that maps points from the camera frame (x right, y down, z forward) to the world
frame. 3x4 matrices and rows of tx ty tz qx qy qz qw are also accepted, as float32 or float64 in any memory order. Lengths are in metres, and
gains in nats unless stated otherwise. ``viewgain.mesh``, which is GPL-3.0-or-later, has surfaces and the whole reconstruction loop.
``viewgain.plot`` draws with matplotlib.

Errors: ``ValueError`` names an argument with a wrong shape, an argument that is not numeric, masked or out of bounds, or an invalid pose.
``TypeError`` names an argument of the wrong class, and how to get an object of the right class. ``OSError``, such as ``FileNotFoundError``,
names a file that cannot be opened or written. ``viewgain.Error`` names a file with invalid contents, or a size that a data structure does not
support. Exceptions of your functions pass through. Docstrings list further exceptions.
"""

import importlib.util as _util

try:
    import numpy as _numpy  # here, because the extension would fail without stating the reason
except ImportError as error:
    raise ImportError(f"viewgain needs numpy, which cannot be imported: {error}") from error

if _util.find_spec("viewgain._viewgain") is None:  # in a source folder; viewgain.study does not need the extension

    def __getattr__(name):
        if name.startswith("__"):
            raise AttributeError(name)
        raise ImportError(f"viewgain.{name} needs the extension module, which is not in {__path__[0]}; build it, or install the package")

else:
    from . import _calls, _viewgain

    _calls.explain(_viewgain)
    from ._viewgain import *
    from ._viewgain import __version__
    from .codes import HitKind, Infeasibility, ViewStatus, VoxelState
    from .results import (AddedView, BestViews, Cloud, Frame, FrameConsistency, FrameRegistration, GridStatistics, IntegrationReport, MapUpdate,
                          Proposal, Ranking, RayOutcomes, Sigmas, SimulatedFrame, Suspicion, TimedPoses, ViewSet, ViewTour)
    from . import plot
