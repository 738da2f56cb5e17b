"""Makes a reach file from any inverse kinematics: the camera poses that an arm can reach.

    reach_from_ik.py OUT.toml [POSES, 2000]

Replace only `ik`: it takes T_base_flange (4x4) and returns joint angles, or None if there are none. Here it
is the closed form of a UR5-like arm; MoveIt, KDL or a vendor's interface can take its place.
"""
import itertools
import sys

import numpy as np

import viewgain

# Denavit-Hartenberg parameters of the arm: d, a, alpha of each joint [m, rad].
D = np.array([0.0892, 0, 0, 0.1092, 0.0947, 0.0823])
A = np.array([0, -0.425, -0.3922, 0, 0, 0])
ALPHA = np.array([np.pi / 2, 0, 0, np.pi / 2, -np.pi / 2, 0])
LIMIT = np.radians(170)  # of each joint, so that cables do not wind up
TABLE = 0.05  # least height of every joint [m]
# The robot's base in the world, and the camera on its flange.
T_WORLD_BASE = np.eye(4)
T_WORLD_BASE[:3, 3] = [-0.6, 0, 0]
T_FLANGE_CAMERA = np.eye(4)
T_FLANGE_CAMERA[:3, 3] = [0, -0.05, 0.04]


def link(i, angle):
    c, s, ca, sa = np.cos(angle), np.sin(angle), np.cos(ALPHA[i]), np.sin(ALPHA[i])
    return np.array([[c, -s * ca, s * sa, A[i] * c], [s, c * ca, -c * sa, A[i] * s], [0, sa, ca, D[i]], [0, 0, 0, 1]])


def forward(joints):
    """T_base_link of all six links."""
    return list(itertools.accumulate((link(i, q) for i, q in enumerate(joints)), np.matmul))


def arm_solutions(T):
    """Up to eight sets of joint angles that place the flange at T."""
    wrist = T @ [0, 0, -D[5], 1]
    radius = np.hypot(wrist[0], wrist[1])
    if radius < D[3]:
        return
    for shoulder, flip, elbow in itertools.product((1, -1), repeat=3):
        q1 = np.arctan2(wrist[1], wrist[0]) + shoulder * np.arccos(D[3] / radius) + np.pi / 2
        s, c = np.sin(q1), np.cos(q1)
        q5 = flip * np.arccos(np.clip((T[0, 3] * s - T[1, 3] * c - D[3]) / D[5], -1, 1))
        if abs(np.sin(q5)) < 1e-6:
            continue  # the last axis is parallel to the second: q6 is arbitrary
        inverse = T[:3, :3].T
        q6 = np.arctan2((-inverse[1, 0] * s + inverse[1, 1] * c) / np.sin(q5), (inverse[0, 0] * s - inverse[0, 1] * c) / np.sin(q5))
        T14 = np.linalg.inv(link(0, q1)) @ T @ np.linalg.inv(link(4, q5) @ link(5, q6))
        p = (T14 @ [0, -D[3], 0, 1])[:2]
        cosine = (p @ p - A[1] ** 2 - A[2] ** 2) / (2 * A[1] * A[2])
        if abs(cosine) > 1:
            continue
        q3 = elbow * np.arccos(cosine)
        q2 = np.arctan2(-p[1], -p[0]) - np.arcsin(-A[2] * np.sin(q3) / np.hypot(*p))
        T34 = np.linalg.inv(link(1, q2) @ link(2, q3)) @ T14
        q4 = np.arctan2(T34[1, 0], T34[0, 0])
        joints = np.array([q1, q2, q3, q4, q5, q6])
        yield (joints + np.pi) % (2 * np.pi) - np.pi


def ik(T_base_flange):
    for joints in arm_solutions(T_base_flange):
        links = forward(joints)
        is_there = np.allclose(links[-1], T_base_flange, atol=1e-6)
        if is_there and np.all(np.abs(joints) < LIMIT) and min(T[2, 3] for T in links[1:]) > TABLE:
            return joints
    return None


def reachable(poses, ik, T_world_base, T_flange_camera):
    """The poses T_world_camera (N, 4, 4) that have a solution."""
    T_base_flange = np.linalg.inv(T_world_base) @ poses @ np.linalg.inv(T_flange_camera)
    return poses[[ik(T) is not None for T in T_base_flange]]


def main():
    out, count = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 2000
    # Candidates around the object: three distances, each with four rolls about the optical axis.
    spheres = [viewgain.sphere_poses(max(count // 12, 1), radius) for radius in (0.35, 0.45, 0.55)]
    turns = [np.eye(4) for _ in range(4)]
    for turn, angle in zip(turns, np.radians([0, 90, 180, 270])):
        turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    poses = np.concatenate([sphere @ turn for sphere in spheres for turn in turns])
    found = reachable(poses, ik, T_WORLD_BASE, T_FLANGE_CAMERA)
    viewgain.ReachRegion(poses=found).save(out)
    print(f"{len(found)} of {len(poses)} poses are reachable: {out}")


if __name__ == "__main__":
    main()
