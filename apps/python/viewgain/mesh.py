# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Replaces the package viewgain.mesh if that was not built. If both exist, Python imports the package."""
from ._missing import MESH

raise ImportError(MESH, name=__name__)
