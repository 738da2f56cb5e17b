# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
import os
import subprocess
import sys


def test_next_best_view_draws_a_picture(tmp_path):
    picture = tmp_path / "views.png"
    run = subprocess.run([sys.executable, os.environ["VIEWGAIN_EXAMPLE"], picture], check=True,
                         capture_output=True, text=True)
    unknown = [int(line.split()[2]) for line in run.stdout.splitlines()]
    assert len(unknown) == 8 and all(b < a for a, b in zip(unknown, unknown[1:3]))
    assert unknown[-1] < unknown[0]
    assert picture.read_bytes()[:4] == b"\x89PNG"
