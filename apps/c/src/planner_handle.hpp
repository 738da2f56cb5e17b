// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewgain/planner.h"
#include "viewgain/planner/view_planner.hpp"

struct vg_planner {
  viewgain::ViewPlanner planner;
};
