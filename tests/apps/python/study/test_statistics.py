# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Statistics of a study, held against counting and against formulas by hand; tables, held against recorded ones."""
import json
import math
import os
import pathlib
import random
import re

import pytest
import records
from viewgain.study import rows, spec, table

DATA = pathlib.Path(os.environ["VIEWGAIN_DATA"], "study")


def p_by_counting(differences, weights):
    """Share of all signs whose sum of positive weights is at least as far from the middle."""
    found = sum(w for d, w in zip(differences, weights) if d > 0)
    middle, far = sum(weights) / 2, 0
    for bits in range(1 << len(weights)):
        far += abs(sum(w for i, w in enumerate(weights) if bits >> i & 1) - middle) >= abs(found - middle) - 1e-9
    return far / (1 << len(weights))


def test_small_samples_are_counted():
    draw, cases = random.Random(7).uniform, 0
    for n in range(1, 12):
        for has_ties in (False, True) * 2:
            d = [round(draw(-4, 6)) or 1 for _ in range(n)] if has_ties else [draw(-1, 1.7) for _ in range(n)]
            sizes = [abs(x) for x in d]
            places = {size: sum(other < size for other in sizes) + (sizes.count(size) + 1) / 2 for size in sizes}
            padded = d + [0.0, math.nan] * (n % 2)  # which say nothing
            assert rows.sign_test(padded) == pytest.approx(p_by_counting(d, [1] * n), abs=1e-12)
            assert rows.signed_rank_test(padded) == pytest.approx(p_by_counting(d, [places[abs(x)] for x in d]), abs=1e-12)
            cases += 1
    assert cases == 44
    assert rows.sign_test([]) == rows.signed_rank_test([0.0, math.nan]) == 1


def test_ties_and_many_pairs_follow_the_normal_distribution():
    cases = 0
    for n in (14, 51, 200):
        for twice in (1, 2):
            if n == 14 and twice == 1:
                continue  # that is counted
            d = [(1 if i >= 0.6 * n else -1) * (1 + i // twice) for i in range(n)]
            sizes = [abs(x) for x in d]
            places = [sum(other < x for other in sizes) + (sizes.count(x) + 1) / 2 for x in sizes]
            total = sum(place for place, x in zip(places, d) if x > 0)
            ties = (n // 2) * 6 / 48 if twice == 2 else 0  # (t^3 - t) / 48 for each two alike
            z = (total - n * (n + 1) / 4) / math.sqrt(n * (n + 1) * (2 * n + 1) / 24 - ties)
            assert rows.signed_rank_test(d) == pytest.approx(math.erfc(abs(z) / math.sqrt(2)), abs=1e-12)
            cases += 1
    assert cases == 5
    d = [-1] * 140 + [1] * 60
    assert rows.sign_test(d) == pytest.approx(2 * sum(math.comb(200, k) for k in range(61)) / 2**200, rel=1e-9)


def test_means_errors_and_intervals_by_hand():
    mean, error, count = rows.mean_and_error([1, 2, 6, math.nan], [0, 0, 0, 0])  # over the runs
    assert (mean, count) == (3, 3) and error == pytest.approx(math.sqrt(14 / 2 / 3))
    # Two objects: sums of deviations from 2.5 are -2 and 2, of four runs.
    mean, error, count = rows.mean_and_error([1, 2, 3, 4], ["a", "a", "b", "b"])
    assert (mean, count) == (2.5, 4) and error == pytest.approx(math.sqrt(2 / 1 * 8) / 4)
    assert math.isnan(rows.mean_and_error([5], ["a"])[1])
    assert rows.mean_and_error([math.nan], ["a"])[2] == 0 and math.isnan(rows.mean_and_error([], [])[0])
    # Two values d off their mean: Student's t of one degree of freedom is 12.706.
    assert rows.half_interval([1, 3], ["a", "a"]) == pytest.approx(12.7062047, rel=1e-7)
    # Within objects: squares 2 and 2, four runs, two degrees of freedom, t = 4.3027.
    assert rows.half_interval([0, 2, 10, 12], ["a", "a", "b", "b"]) == pytest.approx(4.30265273 * math.sqrt(4 / (2 * 4)), rel=1e-7)
    assert math.isnan(rows.half_interval([1, 2], ["a", "b"]))


def run_of(sensor, name, seed, policy):
    gain = policy[5:] if policy.startswith("gain:") else None
    of = spec.Policy(policy, "gain" if gain else policy, gain)
    return spec.Run(spec.Object(name, pathlib.Path(), ()), of, seed, sensor, 0.02, 0.35, {}, "0")


def test_figures_of_a_run():
    views = [{"coverage_visible": c, "travelled": 0.5 * i, "generator": g}
             for i, (c, g) in enumerate([(0.5, "start"), (0.85, "boundary"), (0.79, "plan"), (0.9, "hazard")])]
    record = {"views": 4, "stop_reason": "max_views", "coverage": 0.4, "rms_error": 1e-3, "consistency": None, "outliers": 2,
              "travelled": 1.5, "seconds": {"candidates": 0.75, "score": 0.25, "total": 4.0}, "per_view": views}
    row = rows.row_of(run_of("sr4000", "cube", 3, "gain:combined"), record, 5)
    # Falls under a goal again: the first time counts. Ends early: keeps its last.
    assert row["coverage_by_view"] == [0.5, 0.85, 0.79, 0.9, 0.9] and row["auc"] == pytest.approx(0.788)
    assert (row["views_to_80"], row["views_to_90"], row["views_to_95"]) == (2, 4, None)
    assert (row["metres_to_80"], row["metres_to_90"], row["metres_to_95"]) == (0.5, 1.5, 1.5)
    assert (row["policy"], row["gain"], row["decisions"]) == ("gain", "combined", 2)
    assert row["deciding_seconds"] == pytest.approx(1 / 3) and row["consistency"] is None
    assert list(rows.counted_views([row], 0.95, 5)) == [6]
    cases = 0
    for wrong in ({"per_view": [{}]}, {"per_view": []}, {"rms_error": math.nan}, {"rms_error": "1"}, {"seconds": []}, {"views": None}):
        with pytest.raises((LookupError, TypeError, ValueError, AttributeError)):
            rows.row_of(run_of("sr4000", "cube", 3, "random"), {**record, **wrong}, 5)
        cases += 1
    assert cases == 6
    assert rows.row_of(run_of("sr4000", "cube", 3, "mine"), {**record, "seconds": {"total": 9}}, 5)["deciding_seconds"] is None
    assert rows.early_ends([row, {**row, "views": 5}, {**row, "gain": "paper", "views": 5}], 5) == [
        "1 of 2 runs of gain:combined ended before 5 views (max_views 1); for the remaining views, their last coverage counts"]


def cells(text):
    """The numbers and words of a table, with p of the signed-rank test apart: it was exact there with ties and up to 100 pairs."""
    ranks = [float(p.lstrip("<")) for p in re.findall(r"; [<.\d]+, ([<.\d]+)\)", text)]
    return re.sub(r"(; [<.\d]+, )[<.\d]+\)", r"\1p)", text), ranks


@pytest.mark.parametrize("name", ["made_up", "six_objects"])
def test_tables_are_those_of_the_program_before(name):
    """The tables that the former command `viewgain study` printed (commit b0ffded8): of records.py, and of runs of six objects."""
    if name == "made_up":
        keys = [(sensor, one, seed, policy) for sensor in records.SENSORS for one in records.OBJECTS for seed in records.SEEDS
                for policy in records.POLICIES]
        of = [rows.row_of(run_of(*key), records.record_of(*key), records.MAX_VIEWS) for key in keys]
        made = table(of, records.AGAINST, records.MAX_VIEWS, records.TOLERANCE)
        assert len(of) == 480
    else:
        of = json.loads((DATA / "six_objects.json").read_text())
        made = table(of, "frontier", 6, 0.01)
        assert len(of) == 54
    text, ranks = cells(made)
    expected, expected_ranks = cells((DATA / f"{name}.md").read_text())
    assert text == expected
    assert ranks == pytest.approx(expected_ranks, abs=0.01) and len(ranks) == {"made_up": 22, "six_objects": 12}[name]
