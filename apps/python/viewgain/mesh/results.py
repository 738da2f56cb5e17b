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
    """Views of the space beyond a surface's open boundaries, from ``boundary_candidates``."""

    T_world_camera: Annotated[NDArray[np.float64], "(n, 4, 4), float64."]
    reasons: Annotated[NDArray[np.void], "(n,), structured: why each view was proposed; ``boundary_candidates`` describes the fields."]


@named("viewgain.mesh")
class ViewRecord(NamedTuple):
    """One iteration of the loop, in ``Reconstruction.views`` and for ``reconstruct``'s observer."""

    index: Annotated[int, "Number of the view, from 0."]
    T_world_camera: Annotated[NDArray[np.float64], "(4, 4), float64: pose that the camera reached."]
    generator: Annotated[str, "Origin of the view: \"start\", \"boundary\" or \"candidates\"."]
    boundary_class: Annotated[str, "One of ``BOUNDARY_CLASS_NAMES``; empty without a boundary."]
    predicted_gain: Annotated[float, "Expected gain when the view was chosen [nat; with gain \"surface\" m**2]; NaN for the start."]
    realised_gain: Annotated[float, "Increase of entropy_removed [nat; m**2 with criterion \"trace\"]."]
    entropy_removed: Annotated[float, "Entropy removed so far [nat; m**2 with criterion \"trace\"]."]
    unknown_voxels: Annotated[int, "Number of voxels that are still unknown."]
    predicted_area: Annotated[float, "Expected new surface when the view was chosen [m**2]; NaN if unknown."]
    realised_area: Annotated[float, "New surface that the view showed [m**2]."]
    surface_area: Annotated[float, "Area of the surface so far [m**2]."]
    travelled: Annotated[float, "Length of the path along the camera centres so far [m]."]
    candidates: Annotated[int, "Number of feasible candidates for the next view."]
    dropped: Annotated[dict[str, int], "Number of dropped candidates per reason."]
