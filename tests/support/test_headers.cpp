// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Nothing but the precompiled headers of the tests (tests/CMakeLists.txt).
