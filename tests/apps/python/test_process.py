# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""What happens to the process: exit after a fork, exit beside a call, memory that is not there."""
import os
import subprocess
import sys

import pytest

# The names that each program below finds.
BEFORE = """
import os, resource, signal, sys, threading, time
import numpy as np
import viewgain
labels = np.ones((16, 16, 16), np.uint8)
labels[4:12, 4:12, 4:12] = 0
sensor = viewgain.sensor_preset("sr4000")
grid = viewgain.BeliefGrid.from_labels(labels, voxel_size=0.02, origin=[-0.16] * 3, sensor=sensor)
evaluator = viewgain.GainEvaluator(viewgain.VoxelScene(grid), sensor, pixel_stride=4, num_threads=2)
poses = viewgain.sphere_poses(40, 0.6)
"""


def run(program, before=BEFORE):
    """Exit code, output and errors of a program in a process of its own."""
    # Python 3.12 and later warn of any fork of a process with threads.
    quiet = "ignore:This process:DeprecationWarning"
    done = subprocess.run([sys.executable, "-W", quiet, "-c", before + program],
                          capture_output=True, text=True, timeout=120)
    return done.returncode, done.stdout, done.stderr


# exit_code(child): of a process that has 20 s, else "killed".
WAIT = """
def exit_code(child):
    for _ in range(400):
        pid, status = os.waitpid(child, os.WNOHANG)
        if pid == child:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.05)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return "killed"
"""


@pytest.mark.parametrize("before, work", [
    ("import os, signal, sys, time, viewgain\n", "pass"),
    (BEFORE, "evaluator.evaluate(poses)"),
    (BEFORE, "if (inner := os.fork()) == 0: sys.exit(0)\n    assert exit_code(inner) == 0")],
    ids=["import", "evaluate", "grandchild"])
def test_a_child_of_a_fork_ends_by_sys_exit(before, work):
    program = WAIT + f"""
child = os.fork()
if child == 0:
    {work}
    print("from the child", end="")
    sys.exit(3)
print(" code", exit_code(child))
"""
    assert run(program, before) == (0, "from the child code 3\n", "")


@pytest.mark.parametrize("call", [
    "evaluator.evaluate(poses)", "evaluator.evaluate(poses[0])", "repr(grid)",
    "evaluator.evaluate_own(poses, lambda pose, hits: 1.0)",
    "evaluator.evaluate(poses, control=viewgain.BatchControl(lambda done, total: None))",
    "viewgain.ReachRegion(predicate=lambda pose: True).contains(poses)"])
def test_the_end_does_not_mind_a_daemon_thread_in_a_call(call):
    program = f"""
def work():
    while True:
        {call}

threading.Thread(target=work, daemon=True).start()
time.sleep(0.2)
print("end")
sys.exit(0)
"""
    ends = [run(program) for _ in range(4)]
    assert ends == [(0, "end\n", "")] * 4


def test_other_threads_run_while_a_file_of_rates_is_read(tmp_path):
    os.mkfifo(tmp_path / "rates.vdb")
    program = f"""
def read():
    try:
        viewgain.VoxelScene(grid, hazard={str(tmp_path / "rates.vdb")!r})
    except (OSError, viewgain.Error):
        print("no rates")

thread = threading.Thread(target=read)
thread.start()
while thread.is_alive():  # it waits for somebody who writes
    try:
        os.close(os.open({str(tmp_path / "rates.vdb")!r}, os.O_WRONLY | os.O_NONBLOCK))
    except OSError:
        time.sleep(0.01)
"""
    assert run(program) == (0, "no rates\n", "")


def test_memory_that_is_not_there_is_memory_error():
    program = """
def with_little_memory(call):
    pages = int(open("/proc/self/statm").read().split()[0])
    limit = pages * resource.getpagesize() + 2**28
    resource.setrlimit(resource.RLIMIT_AS, (limit, resource.RLIM_INFINITY))
    try:
        call()
    except MemoryError:
        print("MemoryError")
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))

many = np.broadcast_to(np.uint8(0), (2048, 2048, 1024))
with_little_memory(lambda: viewgain.BeliefGrid.from_labels(many, voxel_size=0.01, prior_sigma=0.01))
eyes = np.broadcast_to(np.eye(4, dtype=np.float32), (2**27, 4, 4))
with_little_memory(lambda: evaluator.evaluate(eyes))
"""
    assert run(program) == (0, "MemoryError\n" * 2, "")
