# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Names of the codes that arrays contain. Each is an int, so it can be compared with values of arrays."""
from enum import IntEnum

from ._viewgain import HIT_KIND_NAMES, INFEASIBILITY_NAMES, VIEW_STATUS_NAMES


class VoxelState(IntEnum):
    """State of a voxel: ``BeliefGrid.states()``, labels, ``contributions()["state"]``."""

    __module__ = "viewgain"

    UNKNOWN = 0
    FREE = 1
    OCCUPIED = 2


def _enumeration(name, names, doc):
    return IntEnum(name, [(word.upper(), code) for code, word in enumerate(names)], module="viewgain"), doc


ViewStatus, ViewStatus.__doc__ = _enumeration(
    "ViewStatus", VIEW_STATUS_NAMES, 'Whether a view could be scored: ``evaluate_detailed()["status"]``.')
HitKind, HitKind.__doc__ = _enumeration(
    "HitKind", HIT_KIND_NAMES, 'What a ray ends in: ``trace()["kind"]``.')
Infeasibility, Infeasibility.__doc__ = _enumeration(
    "Infeasibility", INFEASIBILITY_NAMES, "Why a pose is not feasible: ``FeasibilityChecker.reasons()``; NONE: it is feasible.")
