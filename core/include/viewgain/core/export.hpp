// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the shared libraries show: the libraries are compiled with hidden visibility, and every
/// class and function of a public header carries this. Enumerations and wholly inline functions
/// need it not. On the exception type and the interfaces it also makes their type information one
/// and the same on both sides of the boundary, so that `catch` and `dynamic_cast` work across it.
/// core/README.md says what a version promises of the binary interface.
#define VIEWGAIN_EXPORT __attribute__((visibility("default")))
