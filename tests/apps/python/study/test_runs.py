# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""``python3 -m viewgain.study`` as a user calls it: from the sources, without the extension module. Most runs are made up by a
program that answers as the real one does."""
import csv
import json
import os
import pathlib
import signal
import subprocess
import sys
import time

import pytest

SOURCES = str(pathlib.Path(os.environ["VIEWGAIN_EXAMPLES"]).parent / "python")
REAL = os.environ["VIEWGAIN_PROGRAM"]
SPEC = """objects = ["cube.off"]
policies = ["gain:combined", "frontier", "random"]
seeds = [1, 2]
sensors = ["tof.toml"]
voxels = [0.0125]
sizes = [0.15]
max_views = 12
tolerance = 0.0125
"""
TIMES = ("seconds", "deciding_seconds")


def start(*words, program=None, environment=None):
    return subprocess.Popen([sys.executable, "-m", "viewgain.study", *words, *(["--program", program] if program else [])],
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                            env={**os.environ, "PYTHONPATH": SOURCES, "PYTHONDONTWRITEBYTECODE": "1", **(environment or {})})


def study(*words, code=0, **more):
    process = start(*words, **more)
    out, error = process.communicate(timeout=300)
    assert process.returncode == code, error
    return out if code == 0 else error


def rows_in(folder):
    return [{key: value for key, value in row.items() if key not in TIMES} for row in json.loads(pathlib.Path(folder, "results.json").read_text())]


def names(folder):
    return sorted(path.name for path in pathlib.Path(folder).iterdir())


def runs_in(folder):
    return len(list(pathlib.Path(folder).glob("runs/*/run.json")))


def test_leaves_what_it_says(folder, program, calls):
    (folder / "spec.toml").write_text(SPEC)
    printed = study("spec.toml", "--out", "out", program=program)
    assert names("out") == ["coverage.png", "differences.png", "results.csv", "results.json", "runs", "table.md"]
    assert printed.startswith((folder / "out/table.md").read_text())
    rows = rows_in("out")
    assert [(row["policy"], row["gain"], row["seed"]) for row in rows] == [
        (policy, gain, seed) for seed in (1, 2) for policy, gain in (("gain", "combined"), ("frontier", None), ("random", None))]
    for row in rows:
        assert len(row["coverage_by_view"]) == 12 and row["coverage_by_view"][-1] == row["coverage_visible"]
    with open("out/results.csv", newline="", encoding="utf-8") as file:
        table = list(csv.DictReader(file))
    assert [float(row["auc"]) for row in table] == [row["auc"] for row in rows] and table[1]["gain"] == ""
    for name in ("coverage.png", "differences.png"):
        assert (folder / "out" / name).read_bytes().startswith(b"\x89PNG")
    assert names(f"out/runs/{rows[0]['hash']}") == ["run.json"]
    assert not list((folder / "out").rglob(".run-*")) and not list((folder / "out").rglob("*.tmp"))
    # A check of one view for each policy, then a call for each run; none when all are there, in seconds.
    assert len(calls()) == 6 and len(calls(all_of_them=True)) == 9
    begin = time.monotonic()
    study("spec.toml", "--out", "out", program=program)
    assert len(calls(all_of_them=True)) == 9 and time.monotonic() - begin < 30


def test_only_what_is_new_is_made_and_progress_says_how_long(folder, program, calls):
    (folder / "spec.toml").write_text(SPEC)
    study("spec.toml", "--out", "out", program=program)
    (folder / "out/results.json").chmod(0o600)
    (folder / "spec.toml").write_text(SPEC.replace("[1, 2]", "[1, 2, 3]"))
    process = start("spec.toml", "--out", "out", program=program)
    said = process.communicate()[1].splitlines()
    assert process.returncode == 0 and len(calls()) == 9
    assert said[0] == "6 of 9 runs are done already" and [line.startswith("warning: ") for line in said[4:]] == [True] * (len(said) - 4)
    assert "ended before 12 views (no_gain 1); for the remaining views, their last coverage counts" in said[4]
    assert said[1].startswith("run 7 of 9: cube, ") and said[3].endswith("; 0 s left")
    assert (folder / "out/results.json").stat().st_mode & 0o777 == 0o600  # as of every file that is written anew


def test_keeps_candidates_of_each_view(folder, program):
    (folder / "spec.toml").write_text("kept_candidates = 3\n" + SPEC)
    study("spec.toml", "--out", "out", "--quiet", program=program)
    for run in pathlib.Path("out/runs").glob("*/run.json"):
        lines = (run.parent / "candidates.txt").read_text().splitlines()
        assert [line.split()[:3] for line in lines] == [[view, str(i), str(int(view) - 1)] for view in "12" for i in (0, 1, 3)]


def test_wrong_words_are_known_before_the_first_run(folder, program, calls):
    (folder / "spec.toml").write_text(SPEC.replace('"frontier"', '"nonsense"'))
    error = study("spec.toml", "--out", "out", code=1, program=program)
    assert "spec.toml: cube, nonsense, seed 1: --policy: unknown policy nonsense; to use a gain, write \"gain:nonsense\"" in error
    assert calls() == [] and not (folder / "out").exists()
    (folder / "spec.toml").write_text(SPEC.replace("max_views", "max_view"))
    assert "line 7" in study("spec.toml", "--out", "other", code=2, program=program) and not (folder / "other").exists()
    assert "is not the program viewgain" in study("spec.toml", "--out", "other", code=2, program="/bin/true")
    assert "--program" in study("spec.toml", "--out", "other", code=2, program="no-such-program")
    assert "--jobs" in study("spec.toml", "--out", "other", "--jobs", "0", code=2, program=program)
    assert names(folder) == ["calls", "cube.off", "more", "program", "spec.toml", "tof.toml"]


def test_killed_it_goes_on(folder, program, calls):
    (folder / "spec.toml").write_text(SPEC.replace("max_views", 'flags = ["--distance=0.3"]\nmax_views'))
    study("spec.toml", "--out", "whole", program=program)
    kills = 0
    for wanted in (0, 1, 3, 4):
        process = start("spec.toml", "--out", "killed", "--jobs", "1", program=program)
        while runs_in("killed") < wanted or not (folder / "killed/runs/.lock").exists():
            assert process.poll() is None
            time.sleep(0.01)
        process.kill()
        process.communicate()
        kills += process.returncode == -signal.SIGKILL
        assert not (folder / "killed/results.json").exists()
    assert kills == 4 and runs_in("killed") >= 4
    study("spec.toml", "--out", "killed", program=program)
    assert rows_in("killed") == rows_in("whole")
    assert names("killed/runs") == names("whole/runs")  # nothing half-done is left
    for run in (folder / "whole/runs").glob("*/run.json"):
        assert (folder / "killed/runs" / run.parent.name / "run.json").read_bytes() == run.read_bytes()


@pytest.mark.parametrize("wish", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_wish_to_stop_leaves_what_is_whole(folder, program, wish):
    (folder / "spec.toml").write_text(SPEC.replace("max_views", 'flags = ["--distance=0.5"]\nmax_views'))
    process = start("spec.toml", "--out", "out", "--jobs", "1", program=program)
    while runs_in("out") < 1:
        assert process.poll() is None
        time.sleep(0.01)
    process.send_signal(wish)
    error = process.communicate(timeout=60)[1]
    assert process.returncode == 130 and "the same call continues" in error
    assert names("out") == ["runs"] and 1 <= runs_in("out") < 6
    assert len(names("out/runs")) == runs_in("out") + 1  # and the lock


def test_one_study_at_a_time_in_a_folder(folder, program):
    (folder / "spec.toml").write_text(SPEC.replace("max_views", 'flags = ["--distance=0.5"]\nmax_views'))
    process = start("spec.toml", "--out", "out", "--jobs", "1", program=program)
    while runs_in("out") < 1:
        assert process.poll() is None
        time.sleep(0.01)
    assert "another study uses this folder" in study("spec.toml", "--out", "out", code=2, program=program)
    process.terminate()
    process.communicate()


def test_damaged_runs_are_named_and_nothing_is_left(folder, program):
    (folder / "spec.toml").write_text(SPEC)
    study("spec.toml", "--out", "out", program=program)
    path = folder / "out/runs" / rows_in("out")[0]["hash"] / "run.json"
    whole, cases = path.read_text(), 0
    for old, new in (('"per_view"', '"other"'), ('"stop_reason"', '"other"'), ('"seed": 1', '"seed": 7'), ("{", ""), (whole, "")):
        for name in ("results.csv", "results.json"):
            (folder / "out" / name).unlink(missing_ok=True)
        path.write_text(whole.replace(old, new, 1))
        assert f"{path.relative_to(folder)}" in study("spec.toml", "--out", "out", code=2, program=program)
        assert not (folder / "out/results.csv").exists()
        cases += 1
    assert cases == 5


def test_a_folder_of_other_things_is_refused(folder, program):
    (folder / "spec.toml").write_text(SPEC)
    (folder / "other").mkdir()
    (folder / "other/notes.txt").write_text("mine")
    assert "--out other: the folder has files that no study wrote; choose another folder" in study("spec.toml", "--out", "other", code=2, program=program)
    assert names("other") == ["notes.txt"]
    (folder / "other/runs").mkdir()  # of something else
    assert "--out other: the folder has files that no study wrote; choose another folder" in study("spec.toml", "--out", "other", code=2, program=program)
    # The spec may lie there, and stays as it is.
    (folder / "home").mkdir()
    spec = SPEC.replace("cube.off", "../cube.off").replace("tof.toml", "../tof.toml")
    (folder / "home/my.toml").write_text(spec)
    study("home/my.toml", "--out", "home", "--quiet", program=program)
    assert (folder / "home/results.csv").exists() and (folder / "home/my.toml").read_text() == spec


def test_runs_that_fail_keep_nobody_from_the_others(folder, program, calls):
    (folder / "mine.sh").write_text(f"""case "$*" in *--max-views=12*--seed=1*|*--seed=1*--max-views=12*) echo "no luck" >&2; exit 1;; esac
exec {program} reconstruct "$@"
""")
    (folder / "spec.toml").write_text(SPEC.replace('"frontier"', '{name = "mine", command = "sh mine.sh"}'))
    error = study("spec.toml", "--out", "out", "--jobs", "1", code=1, program=program)
    assert "1 of 6 runs failed. Repeat the call to run them again. The first failure: cube, mine, seed 1: no luck" in error
    assert runs_in("out") == 5 and not (folder / "out/results.csv").exists()
    (folder / "mine.sh").write_text(f'exec {program} reconstruct "$@"\n')
    study("spec.toml", "--out", "out", program=program)
    assert len(rows_in("out")) == 6


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"seconds": {}}', "\\377"])
def test_a_run_that_is_none_is_refused_at_once(folder, program, text):
    (folder / "mine.sh").write_text(f"""for word in "$@"; do case "$word" in --out=*) out=${{word#--out=}};; esac; done
mkdir "$out" && printf '{text}' >"$out/run.json"
""")
    (folder / "spec.toml").write_text(SPEC.replace('"frontier"', '{name = "mine", command = "sh mine.sh"}'))
    assert "cube, mine, seed 1: run.json is invalid: " in study("spec.toml", "--out", "out", code=2, program=program)
    assert not (folder / "out").exists()


def test_names_that_matplotlib_would_read_otherwise(folder, program):
    spec = SPEC.replace('"frontier"', '{name = "_a$\\\\frac$", command = "PROGRAM reconstruct"}').replace("PROGRAM", program)
    (folder / "spec.toml").write_text(spec.replace("voxels = [0.0125]", "voxels = [0.01, 0.011, 0.012, 0.013, 0.014]"))
    study("spec.toml", "--out", "out", program=program)
    assert names("out") == ["coverage.png", "differences.png", "results.csv", "results.json", "runs", "table.md"]


def test_without_matplotlib_there_are_no_plots(folder, program):
    (folder / "spec.toml").write_text(SPEC)
    (folder / "hidden").mkdir()
    (folder / "hidden/matplotlib.py").write_text("raise ImportError('not here')\n")
    process = start("spec.toml", "--out", "out", program=program, environment={"PYTHONPATH": f"{folder}/hidden:{SOURCES}"})
    error = process.communicate()[1]
    assert process.returncode == 0 and "warning: coverage.png was not drawn: not here; install matplotlib" in error
    assert names("out") == ["results.csv", "results.json", "runs", "table.md"]


def test_voxels_larger_than_the_tolerance_are_said(folder, program):
    (folder / "spec.toml").write_text(SPEC.replace("tolerance = 0.0125", "tolerance = 0.005"))
    process = start("spec.toml", "--out", "out", "--quiet", program=program)
    assert "warning: coverage is measured at 5 mm, less than a voxel of 12.5 mm; set tolerance = 0.0125 in the spec" in process.communicate()[1]


def test_a_cluster_gives_what_this_machine_gives(folder, program, calls):
    """On two workers, one of which is killed while it works."""
    distributed = pytest.importorskip("distributed")
    (folder / "spec.toml").write_text(SPEC.replace("max_views", 'flags = ["--distance=0.3"]\nmax_views'))
    study("spec.toml", "--out", "here", program=program)
    os.environ["PYTHONPATH"], before = f"{SOURCES}:{os.environ['PYTHONPATH']}", os.environ["PYTHONPATH"]
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50) as cluster:
        process = start("spec.toml", "--out", "there", "--scheduler", cluster.scheduler_address, program=program)
        while runs_in("there") < 1:
            assert process.poll() is None, process.communicate()[1]
            time.sleep(0.01)
        os.kill(next(iter(cluster.workers.values())).pid, signal.SIGKILL)
        error = process.communicate(timeout=120)[1]
    os.environ["PYTHONPATH"] = before
    assert process.returncode == 0, error
    assert rows_in("there") == rows_in("here") and names("there/runs") == names("here/runs")
    assert (folder / "there/table.md").read_text().splitlines()[:10] == (folder / "here/table.md").read_text().splitlines()[:10]
    assert "expected the address of a scheduler" in study("spec.toml", "--out", "there2", "--scheduler", "tcp://127.0.0.1", code=2, program=program)
    assert "no scheduler answers" in study("spec.toml", "--out", "there2", "--scheduler", "tcp://127.0.0.1:9", code=2, program=program)


CUBE = """OFF
8 6 0
0 0 0
2 0 0
2 2 0
0 2 0
0 0 2
2 0 2
2 2 2
0 2 2
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
"""


def test_a_run_is_that_of_reconstruct(folder):
    """The real program, a policy and a program of one's own beside it."""
    (folder / "cube.off").write_text(CUBE)
    (folder / "mine.sh").write_text(f"exec {REAL} reconstruct --policy=random \"$@\"\n")
    (folder / "spec.toml").write_text(
        'objects = ["cube.off"]\npolicies = ["frontier", "random", {name = "mine", command = "sh mine.sh"}]\nseeds = [2]\n'
        'sensors = ["sr4000"]\nvoxels = [0.0125]\nsizes = [0.15]\nmax_views = 3\nkept_candidates = 4\n')
    study("spec.toml", "--out", "out", program=REAL)
    rows = rows_in("out")
    alone = json.loads(subprocess.run(
        [REAL, "reconstruct", "cube.off", "--sensor", "sr4000", "--voxel", "0.0125", "--size", "0.15", "--max-views", "3", "--seed", "2",
         "--policy", "frontier", "--stop", "gain=0,area=0,idle=0,promises=0", "--pictures", "off", "--quiet", "--json", "--out", "alone"],
        check=True, capture_output=True, text=True).stdout)
    for key in ("coverage_visible", "rms_error", "consistency", "travelled", "views"):
        assert rows[0][key] == alone[key], key
    assert rows[0]["decisions"] == 2 and rows[0]["coverage_by_view"] == [view["coverage_visible"] for view in alone["per_view"]]
    same = [{key: value for key, value in row.items() if key not in ("policy", "hash")} for row in rows[1:]]
    assert rows[2]["decisions"] == 2
    assert same[0] == same[1] and [row["policy"] for row in rows] == ["frontier", "random", "mine"]
    kept = (folder / "out/runs" / rows[0]["hash"] / "candidates.txt").read_text().splitlines()
    assert [line.split()[0] for line in kept] == ["1"] * 4 + ["2"] * 4 and all(len(line.split()) == 8 for line in kept)
    (folder / "spec.toml").write_text((folder / "spec.toml").read_text().replace('"frontier"', '"unknown_count"'))
    assert "to use a gain, write \"gain:unknown_count\"" in study("spec.toml", "--out", "out", code=2, program=REAL)
