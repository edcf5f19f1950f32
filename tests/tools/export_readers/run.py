"""The run that an export is held against, and what is said of it."""
import csv

import meshio
import numpy as np

failures = 0


def check(what, good, more=""):
    global failures
    failures += not good
    print(f"{'ok ' if good else 'FAILED '}{what}{': ' if more else ''}{more}")


def check_small(what, values, bound):
    worst = max([float(v) for v in values], default=0.0)
    check(what, worst <= bound and worst == worst, f"{worst:.3g} (bound {bound:.3g}, {len(values)} compared)")


def table(path):
    with open(path) as file:
        return list(csv.DictReader(file))


class Run:
    """What the run itself wrote."""

    def __init__(self, folder, frames):
        self.folder = folder
        self.stats = {int(row["frame"]): row for row in table(folder / "stats.csv")}
        first, last, step = ([int(x) for x in frames.split(":")] + [1])[:3] if frames else (0, max(self.stats), 1)
        self.frames = list(range(first, last + 1, step))
        self.names = sorted(p.stem for p in (folder / "surfaces/000000").iterdir())
        start = [self.surface(0, n).points for n in self.names]
        ends = np.concatenate(start)
        self.size = float(np.linalg.norm(ends.max(0) - ends.min(0)))
        self.kinds = {}
        name = kind = None
        for line in (folder / "run.toml").read_text().splitlines():
            key, _, value = line.partition(" = ")
            if line.startswith("[") and line != "[[body]]":
                name = None
            if line == "[[body]]":
                name = ""
            elif key == "name" and name == "":
                name = value.strip('"')
            elif key == "kind" and name:
                self.kinds[name] = value.strip('"')
        self.contacts = {frame: [] for frame in self.stats}
        for row in table(folder / "contacts.csv"):
            self.contacts[int(row["frame"])].append(row)

    def surface(self, frame, name):
        return meshio.read(self.folder / f"surfaces/{frame:06}/{name}.ply")

    def time(self, frame):
        return float(self.stats[frame]["time_s"])

    def moving(self):
        return [n for n in self.names if self.kinds[n] != "static"]


def triangles(mesh):
    return np.concatenate([c.data for c in mesh.cells])


def vector(row, *names):
    return np.array([float(row[n]) for n in names])


def impulse_on_a(row):
    """N·s in the world, by the definition of contacts.csv."""
    n = vector(row, "n_x", "n_y", "n_z")
    t1 = np.cross(np.eye(3)[int(np.argmin(np.abs(n)))], n)
    t1 /= np.linalg.norm(t1)
    return float(row["lambda_n"]) * n + float(row["lambda_t1"]) * t1 + float(row["lambda_t2"]) * np.cross(n, t1)
