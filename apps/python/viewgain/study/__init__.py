# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Compares policies and gains in one table. A spec lists objects, policies, seeds, sensors, voxel sizes and object sizes; each combination is
one run of ``viewgain reconstruct``. Command: ``python3 -m viewgain.study SPEC.toml --out DIR``. The tutorial "Compare methods" lists the keys of
a spec.

Needs the program ``viewgain``, numpy and scipy, but not the extension module. Frames and units are those of the program.

>>> from viewgain import study                                  # doctest: +SKIP
>>> spec = study.read_spec("spec.toml")
>>> rows = study.make_runs(spec, "out", jobs=4)                 # one dict per run; skips finished runs
>>> print(study.table(rows, spec.against, spec.max_views, spec.tolerance))
"""
from .rows import SpecError, row_of
from .runs import RunError, find_program, make_runs
from .spec import Spec, read_spec
from .table import table

__all__ = ["RunError", "Spec", "SpecError", "find_program", "make_runs", "read_spec", "row_of", "table"]
