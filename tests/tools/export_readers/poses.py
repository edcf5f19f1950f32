"""Poses as a table and as JSON."""
import json

import numpy as np

from export_readers.run import check, check_small, table, vector


def rotation(q):
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def check_poses(run, poses, mass):
    """poses: (frame, time, name) -> position, quaternion, velocity, angular velocity, centre of mass."""
    posed = [n for n in run.names if run.kinds[n] != "deformable"]
    expected = {(f, n) for f in run.frames for n in posed if n in run.moving()} | {(run.frames[0], n) for n in posed if n not in run.moving()}
    check("every body with a pose in every frame, those that never move once", {(f, n) for f, _, n in poses} == expected)
    check("times", all(t == run.time(f) for f, t, _ in poses))
    check_small("quaternions have length 1", [abs(np.dot(p[1], p[1]) - 1) for p in poses.values()], 1e-14)
    errors, turned, before = [], [], {}
    for (frame, _, name), (x, q, v, w, c) in sorted(poses.items(), key=lambda e: e[0][0]):
        truth = run.surface(frame, name).points
        local = before.setdefault(name, (truth - x) @ rotation(q))  # of the first frame
        errors.append(np.abs(local @ rotation(q).T + x - truth).max() / run.size)
        if (name, "q") in before:
            turned.append(-float(np.dot(q, before[(name, "q")])))
        before[(name, "q")] = q
    check_small("vertices of the first frame moved by the poses / size", errors, 1e-12)
    check_small("quaternions don't jump to the other sign", turned, 0.0)
    if mass and all(k != "deformable" for k in run.kinds.values()):
        momenta = []
        for frame in run.frames:
            p = sum((mass[n] * poses[(frame, run.time(frame), n)][2] for n in posed if run.kinds[n] == "dynamic"), np.zeros(3))
            truth = vector(run.stats[frame], "momentum_x", "momentum_y", "momentum_z")
            momenta.append(np.abs(p - truth).max() / max(1e-3, np.abs(truth).max()))
        check_small("momentum from masses and velocities", momenta, 1e-9)


def read_poses_csv(path):
    poses = {}
    for row in table(path):
        poses[(int(row["frame"]), float(row["time_s"]), row["body"])] = (
            vector(row, "x_m", "y_m", "z_m"), vector(row, "q_w", "q_x", "q_y", "q_z"), vector(row, "v_x", "v_y", "v_z"), vector(row, "omega_x", "omega_y", "omega_z"),
            vector(row, "center_x_m", "center_y_m", "center_z_m"))
    return poses


def read_poses_json(path):
    data, poses, zero = json.load(open(path)), {}, np.zeros(3)
    for frame in data["frames"]:
        for body, pose in zip(data["bodies"], frame["bodies"], strict=True):
            x, q = np.array(pose["position"]), np.array(pose["quaternion"])
            poses[(frame["frame"], frame["time"], body["name"])] = (
                x, q, np.array(pose["velocity"]), np.array(pose["angular_velocity"]), x + rotation(q) @ np.array(body["center_of_mass"]))
    for body in data["static"]:
        first = data["frames"][0]
        poses[(first["frame"], first["time"], body["name"])] = (np.array(body["position"]), np.array(body["quaternion"]), zero, zero, zero)
    return poses, {b["name"]: b["mass"] for b in data["bodies"] if b["kind"] == "dynamic"}
