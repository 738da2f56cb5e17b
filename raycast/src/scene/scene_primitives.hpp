// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene_data.hpp"

namespace viewgain::detail {

/// Makes the primitives of data.snapshot. Regions that the snapshot shares with `before` (null:
/// none), the data of the scene that its snapshot was made from, are copied from there. Throws
/// Error(capacity).
void gather_primitives(SceneData& data, const SceneData* before);

}  // namespace viewgain::detail
