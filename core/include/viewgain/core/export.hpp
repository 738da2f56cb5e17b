// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Exports a symbol from the shared libraries, which are compiled with hidden visibility. All
/// classes and functions of public headers are exported, except enumerations and fully inline
/// functions. Because the exception type and the interfaces are exported, `catch` and
/// `dynamic_cast` work across libraries. core/README.md documents the stability of the binary
/// interface.
#define VIEWGAIN_EXPORT __attribute__((visibility("default")))
