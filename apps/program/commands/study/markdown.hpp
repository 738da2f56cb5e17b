// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "program/commands/study/results.hpp"

namespace viewgain::app {

/// A study's results for people, as Markdown: for each sensor, voxel and size the policies' means,
/// their paired differences to the spec's `against`, views by object, and how well their scores
/// tell what candidates bring.
[[nodiscard]] std::string results_markdown(const StudySpec& spec,
                                           const std::vector<ResultRow>& rows);

}  // namespace viewgain::app
