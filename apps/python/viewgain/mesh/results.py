# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Named tuples and codes of viewgain.mesh."""
from enum import IntEnum
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..results import named
from ._mesh import BOUNDARY_CLASS_NAMES

BoundaryClass = IntEnum("BoundaryClass", [(word.upper(), code) for code, word in enumerate(BOUNDARY_CLASS_NAMES)],
                        module="viewgain.mesh")
BoundaryClass.__doc__ = 'Which way a boundary of the surface lies in the view: ``boundary_candidates()``, ``reasons["boundary_class"]``.'


@named("viewgain.mesh")
class BoundaryCandidates(NamedTuple):
    """Views that look past a surface's open boundaries, of ``boundary_candidates``."""

    T_world_camera: Annotated[NDArray[np.float64], "(n, 4, 4), float64."]
    reasons: Annotated[NDArray[np.void], "(n,), structured: boundary_class, run, run_length, patch, target, distance [m], tilt, roll [rad], nominal; see ``boundary_candidates``."]


@named("viewgain.mesh")
class ViewRecord(NamedTuple):
    """One turn of the loop, of ``Reconstruction.views`` and for ``reconstruct``'s observer."""

    index: Annotated[int, "Number of the view, from 0."]
    T_world_camera: Annotated[NDArray[np.float64], "(4, 4), float64: where the camera really was."]
    generator: Annotated[str, "\"start\", \"boundary\" or \"candidates\"."]
    boundary_class: Annotated[str, "One of ``BOUNDARY_CLASS_NAMES``; empty if it is of no boundary."]
    predicted_gain: Annotated[float, "When it was chosen [nat; by gain \"surface\" m**2]; NaN of the start."]
    realised_gain: Annotated[float, "What it added to entropy_removed [nat, or m**2 for trace]."]
    entropy_removed: Annotated[float, "Entropy removed so far [nat, or m**2 for trace]."]
    unknown_voxels: Annotated[int, "Unknown voxels that are left."]
    predicted_area: Annotated[float, "New surface that was expected of it [m**2]; NaN if nothing was."]
    realised_area: Annotated[float, "New surface that it showed [m**2]."]
    surface_area: Annotated[float, "Of the surface so far [m**2]."]
    travelled: Annotated[float, "Between camera centres so far [m]."]
    candidates: Annotated[int, "How many were possible for the next view."]
    dropped: Annotated[dict[str, int], "Reason -> how many were not."]
