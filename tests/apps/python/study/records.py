# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Records of runs that nobody made: curves that reach a goal, lose it again, never get there or end early; ties; figures without a value."""
import random

OBJECTS, SEEDS, SENSORS = ("camel", "lion-head", "elephant"), tuple(range(1, 21)), ("sr4000", "d435")
POLICIES = ("gain:combined", "frontier", "random", "tour:3:2")
AGAINST, MAX_VIEWS, TOLERANCE = "frontier", 12, 0.02


def record_of(sensor, name, seed, policy):
    """What run.json of this run has of figures. Uses random.random() alone, whose numbers are the same in every Python."""
    draw = random.Random(f"{sensor} {name} {seed} {policy}").random
    quality = {"gain:combined": 0.30, "frontier": 0.25, "random": 0.15, "tour:3:2": 0.28}[policy] * (0.8 if sensor == "d435" else 1)
    count = MAX_VIEWS if draw() < 0.8 else 3 + int(8 * draw())
    covered, views, way = 0.3 + 0.01 * int(10 * draw()), [], 0.0
    for i in range(count):
        generator = "start" if i == 0 else "plan" if policy.startswith("tour") and i % 2 == 0 else "boundary"
        views.append({"coverage_visible": None if draw() < 0.01 else round(covered, 2), "travelled": way, "generator": generator})
        covered = min(0.99, covered + quality * draw() * (1 - covered) - (0.03 if draw() < 0.1 else 0))
        way += 0.1 + 0.3 * draw()
    return {"stop_reason": "max_views" if count == MAX_VIEWS else "no_gain", "views": count, "coverage": 0.9 * covered,
            "rms_error": 1e-3 * (1 + draw()), "consistency": None if draw() < 0.05 else 0.5 + draw(), "outliers": int(5 * draw()),
            "travelled": way, "seconds": {"candidates": draw(), "score": draw(), "total": 3 + draw()}, "per_view": views}
