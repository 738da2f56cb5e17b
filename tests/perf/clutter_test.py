# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""perf/clutter.py: its specs are complete, and its tables are right for runs that are known.
clutter_test.py PERF_FOLDER VIEWGAIN"""
import pathlib
import subprocess
import sys
import tempfile
import types
import unittest

import numpy as np

PERF, VIEWGAIN = (str(pathlib.Path(name).resolve()) for name in sys.argv[1:3])
del sys.argv[1:3]
sys.path.insert(0, PERF)
import clutter  # noqa: E402
import meshes  # noqa: E402

HAS_MESHES = meshes.CGAL.exists() and meshes.FURNITURE.is_dir()


def run(scene, policy, seed, auc, views_to=(2, 3, 4, 5), visible=.5):
    return types.SimpleNamespace(scene=scene, policy=policy, seed=seed, sensor="sr4000", auc=auc, end=auc + .1, rms=1.5, visible=visible,
                                 views_to=list(views_to), metres_to=[(count or 20) / 10 for count in views_to])


def cells(table, name):
    row = next(line for line in table.splitlines() if line.startswith(f"| {name} |"))
    return [cell.strip() for cell in row.strip("|").split("|")][1:]


class Clutter(unittest.TestCase):
    def setUp(self):
        self.runs = []
        for scene, more in (("bin", .1), ("shelf", -.02)):
            for seed in (1, 2, 3):
                self.runs += [run(scene, "gain:combined", seed, .6 + .01 * seed + more), run(scene, "frontier", seed, .6, (2, 3, 4, None))]

    def test_means_are_of_scenes_and_count_runs_that_never_get_there(self):
        table = clutter.means(self.runs + [run("bin", "frontier", 4, .6, (2, 3, 4, None))])
        ours, other = cells(table, "gain:combined"), cells(table, "frontier")
        self.assertEqual((ours.pop(0), other.pop(0)), ("6", "6"))  # seed 4 has no partner
        self.assertEqual(ours[:4], ["2.00; 0.2", "3.00; 0.3", "4.00; 0.4", "5.00; 0.5"])
        self.assertEqual(other[3], f"≥ {clutter.MAX_VIEWS + 1}.00; 2.0 (6 never)")
        self.assertEqual(ours[4:], ["0.660", "76.0 %", "1.50"])

    def test_pairs_are_of_the_same_scene_and_seed(self):
        got = cells(clutter.pairs(self.runs), "frontier")
        # Differences .11, .12, .13 and -.01, 0, .01; t(2) = 4.303, t(1) = 12.706, t(4) = 2.776.
        half = 4.3027 * .01 / np.sqrt(3)
        self.assertEqual(got[0], f"+0.120 ± {half:.3f}")
        self.assertEqual(got[1], f"+0.000 ± {half:.3f}")
        self.assertEqual(got[2], f"+0.060 ± {12.7062 * np.std([.12, 0], ddof=1) / np.sqrt(2):.3f}")
        self.assertEqual(got[3], f"± {2.7764 * np.sqrt(4e-4 / (4 * 6)):.3f}")
        self.assertEqual(got[4], "4 of 6")

    def test_pairs_without_a_partner_are_left_out(self):
        some = [one for one in self.runs if not (one.policy == "gain:combined" and one.scene == "shelf")]
        got = cells(clutter.pairs(some), "frontier")
        self.assertEqual((got[1], got[4]), ("-", "3 of 3"))
        self.assertEqual(clutter.interval([.1]), "+0.100")
        self.assertEqual(len(clutter.pairs([one for one in self.runs if one.policy == "frontier"]).splitlines()), 2)  # the head

    def test_the_rest_of_the_visible_share(self):
        self.assertEqual(cells(clutter.not_visible(self.runs + [run("table", "oracle", 1, .6, visible=.75)]), "table"), ["25 %"])
        self.assertEqual(clutter.tables([]), "")

    def test_toml_is_read_back(self):
        value = {"name": 'a "b"', "words": ["x", 2, .5], "own": {"k": "v"}}
        self.assertEqual(clutter.scenes.tomllib.loads(f"v = {clutter.toml(value)}")["v"], value)

    @unittest.skipUnless(HAS_MESHES, "needs libcgal-demo and sweethome3d-furniture")
    def test_specs_have_every_run_once(self):
        with tempfile.TemporaryDirectory() as folder:
            specs = list(clutter.specs(pathlib.Path(folder), VIEWGAIN))
            self.assertEqual([len(spec.runs) for spec in specs], [6 * 4] * 6 + [2 * 4] * 2)
            runs = [one for spec in specs for one in spec.runs]
            self.assertEqual(len({one.hash for one in runs}), len(runs))
            starts = {(one.object.name, word) for one in runs for word in one.object.words if word.startswith("--from=")}
            self.assertEqual(len(starts), 6 * 3)
            done = subprocess.run([sys.executable, f"{PERF}/clutter.py", folder, "--tables", "--program", VIEWGAIN], capture_output=True,
                                  text=True, check=True)
            self.assertEqual(done.stdout, "")  # no run yet


if __name__ == "__main__":
    unittest.main()
