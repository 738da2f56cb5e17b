# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
import os
import pathlib
import stat
import sys
import textwrap

import pytest

sys.path.insert(0, os.path.dirname(__file__))


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The folder that calls are made from, with two meshes and a sensor's file; no run looks into them here."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "more").mkdir()
    for name in ("cube.off", "more/ball.off", "tof.toml"):
        (tmp_path / name).write_text(f"{name}\n")
    return tmp_path


@pytest.fixture
def program(tmp_path):
    """A program that answers as ``viewgain reconstruct`` does, at once, with records.py's figures, and notes its calls in "calls"."""
    path = tmp_path / "program/viewgain"
    path.parent.mkdir()
    path.write_text(f"#!{sys.executable}\n" + textwrap.dedent(f"""\
        import json, pathlib, sys, time
        sys.path.insert(0, {os.path.dirname(__file__)!r})
        import records
        if sys.argv[1:] == ["--version"]:
            sys.exit(print("viewgain 1.2.3"))
        flags = dict(word[2:].split("=", 1) for word in sys.argv[1:] if word.startswith("--") and "=" in word)
        with open({str(tmp_path / "calls")!r}, "a") as calls:
            calls.write(" ".join(sys.argv[1:]) + "\\n")
        if flags.get("policy") == "nonsense":
            sys.exit("viewgain: --policy: unknown policy nonsense")
        if flags["max-views"] != "1":
            time.sleep(float(flags.get("distance", 0)))
        policy = f"gain:{{flags['gain']}}" if flags.get("policy") == "gain" else flags.get("policy", "own")
        policy = policy if policy in records.POLICIES else "random"
        out = pathlib.Path(flags["out"])
        out.mkdir()
        if flags.get("save-maps") == "on":
            (out / "maps").mkdir()
            for view in range(2):
                (out / f"maps/{{view:02}}.txt").write_text("".join(f"{{i}} {{i}} {{view}} 0 0 0 0 1\\n" for i in range(5)))
        sensor, name = pathlib.Path(flags["sensor"]).stem, pathlib.Path(sys.argv[-1]).stem
        (out / "run.json").write_text(json.dumps(records.record_of(sensor, name, int(flags["seed"]), policy)))
        """))
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return str(path)


@pytest.fixture
def calls(tmp_path):
    """The calls of that program so far, without those that only check."""
    def read(all_of_them=False):
        path = pathlib.Path(tmp_path / "calls")
        lines = path.read_text().splitlines() if path.exists() else []
        return [line for line in lines if all_of_them or "--max-views=1 " not in line]
    return read
