#!/usr/bin/env python3
"""Reads what `impinge export` wrote with readers that are not ours, and holds it against the run.

usage: read_export.py RUN FORMAT FOLDER [FIRST:LAST:STEP] [--picture FILE]

RUN is a run's folder made with --contacts --export ply: its surfaces/, stats.csv and contacts.csv are the truth. FORMAT is ply, obj, vtu, usda, poses.csv or
poses.json; FOLDER is where the export is. Prints a line a check and exits with 1 if one fails, with 77 where python3-vtk9, python3-meshio or numpy are missing.
--picture (vtu): the last frame's surfaces, drawn by VTK's own renderer off screen.
"""
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).parent))
try:
    from export_readers import poses, run, sequence, usd, vtu
except ImportError as missing:
    print(f"not read: {missing}")
    sys.exit(77)


def main():
    words = sys.argv[1:]
    picture = None
    if "--picture" in words:
        at = words.index("--picture")
        picture = words[at + 1]
        del words[at:at + 2]
    kind, folder = words[1], Path(words[2])
    made = run.Run(Path(words[0]), words[3] if len(words) > 3 else "")
    if kind in ("ply", "obj"):
        sequence.check_sequence(made, folder, kind)
    elif kind == "vtu":
        names = {int(row["body"]): row["name"] for row in run.table(folder / "bodies.csv")}
        vtu.check_surfaces(made, folder, names)
        vtu.check_tetrahedra(made, folder, names)
        vtu.check_contacts(made, folder, names)
        if picture:
            vtu.draw(made, folder, picture)
    elif kind == "usda":
        usd.check_usda(made, next(folder.glob("*.usda")))
    elif kind == "poses.csv":
        poses.check_poses(made, poses.read_poses_csv(folder / kind), {})
    elif kind == "poses.json":
        poses.check_poses(made, *poses.read_poses_json(folder / kind))
    else:
        sys.exit(f"no check of {kind}")
    sys.exit(run.failures > 0)


main()
