# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Import errors of parts that are missing."""

MESH = ("viewgain.mesh was not built. Install CGAL (Debian: libcgal-dev), configure with -DVIEWGAIN_BUILD_MESH=ON and build the "
        "target viewgain_python_package (with pip: pip install . -C cmake.define.VIEWGAIN_BUILD_MESH=ON); among viewgain's Debian "
        "packages it is python3-viewgain-mesh")
