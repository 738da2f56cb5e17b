# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces, views at their open boundaries, and the whole reconstruction loop.

This package uses parts of CGAL that are GPL-3.0-or-later, so programs that import it must be
GPL-3.0-or-later too. ``import viewgain`` does not load this package, and is Apache-2.0.
"""

try:
    from ._mesh import *
except ModuleNotFoundError as error:
    from .._missing import MESH as _text
    if error.name != __name__ + "._mesh":
        raise
    raise ImportError(_text, name=__name__) from None
from .. import _calls
from . import _mesh

_calls.explain(_mesh)
from ._mesh import *
from .results import BoundaryCandidates, BoundaryClass, ViewRecord
