# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Stands for the package viewgain.mesh, which goes before it, where that was not built."""
from ._missing import MESH

raise ImportError(MESH, name=__name__)
