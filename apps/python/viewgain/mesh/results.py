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
BoundaryClass.__doc__ = 'Side of the image at which the surface ends: ``boundary_candidates()``, ``reasons["boundary_class"]``.'


@named("viewgain.mesh")
class BoundaryCandidates(NamedTuple):
    """Views that look past a surface's open boundaries, from ``boundary_candidates``."""

    T_world_camera: Annotated[NDArray[np.float64], "(n, 4, 4), float64."]
    reasons: Annotated[NDArray[np.void], "(n,), structured: boundary_class, run, run_length, patch, target, distance [m], tilt, roll [rad], nominal; see ``boundary_candidates``."]


@named("viewgain.mesh")
class ViewRecord(NamedTuple):
    """One iteration of the loop, in ``Reconstruction.views`` and for ``reconstruct``'s observer."""

    index: Annotated[int, "Number of the view, from 0."]
    T_world_camera: Annotated[NDArray[np.float64], "(4, 4), float64: the pose that the camera reached."]
    generator: Annotated[str, "\"start\", \"boundary\" or \"candidates\"."]
    boundary_class: Annotated[str, "One of ``BOUNDARY_CLASS_NAMES``; empty without a boundary."]
    predicted_gain: Annotated[float, "Gain when it was chosen [nat; with gain \"surface\" m**2]; NaN for the start."]
    realised_gain: Annotated[float, "Increase of entropy_removed [nat, or m**2 for trace]."]
    entropy_removed: Annotated[float, "Entropy removed so far [nat, or m**2 for trace]."]
    unknown_voxels: Annotated[int, "Number of voxels that are still unknown."]
    predicted_area: Annotated[float, "Expected new surface [m**2]; NaN if unknown."]
    realised_area: Annotated[float, "New surface shown [m**2]."]
    surface_area: Annotated[float, "Area of the surface so far [m**2]."]
    travelled: Annotated[float, "Path length between camera centres so far [m]."]
    candidates: Annotated[int, "Number of possible candidates for the next view."]
    dropped: Annotated[dict[str, int], "Number of dropped candidates by reason."]
