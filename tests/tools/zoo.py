#!/usr/bin/env python3
"""Runs every surface file below some folders as a static body, and mended as a dynamic one, and says what came of it.

usage: zoo.py PROGRAM FOLDER... [--out FILE.csv] [--seconds N]

PROGRAM is impinge. Which files are asked about is decided by assimp alone (libassimp.so.5, through its C interface, each file in a process of its own): what it
opens with at least 4 triangles, all vertices finite and all indices in range, is a sound surface file. All else is listed with the reason why it is left out. A
sound file is run for one frame as it is, `kind = "static"`, and as `kind = "dynamic"` with `mend = true`, N seconds (120) at most each. Prints the shares a folder and in
all, what was refused and why, and writes a row a file. Nothing is fetched; the folders that tests/README.md speaks of are

  the Debian package assimp-testmodels:                usr/share/assimp/models
  github.com/alecjacobson/common-3d-test-models:       data
  github.com/ipc-sim/IPC:                              input/triMeshes
"""
import csv
import ctypes
import math
import os
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

TRIANGULATE = 0x8
LEAST = 4


class Vector(ctypes.Structure):
    _fields_ = [("x", ctypes.c_float), ("y", ctypes.c_float), ("z", ctypes.c_float)]


class Face(ctypes.Structure):
    _fields_ = [("count", ctypes.c_uint), ("indices", ctypes.POINTER(ctypes.c_uint))]


class Mesh(ctypes.Structure):  # the front of aiMesh
    _fields_ = [("kinds", ctypes.c_uint), ("vertex_count", ctypes.c_uint), ("face_count", ctypes.c_uint),
                ("vertices", ctypes.POINTER(Vector)), ("normals", ctypes.c_void_p), ("tangents", ctypes.c_void_p),
                ("bitangents", ctypes.c_void_p), ("colors", ctypes.c_void_p * 8), ("uvs", ctypes.c_void_p * 8),
                ("uv_components", ctypes.c_uint * 8), ("faces", ctypes.POINTER(Face))]


class Node(ctypes.Structure):
    pass


class String(ctypes.Structure):
    _fields_ = [("length", ctypes.c_uint32), ("data", ctypes.c_char * 1024)]


Node._fields_ = [("name", String), ("transform", ctypes.c_float * 16), ("parent", ctypes.c_void_p),
                 ("child_count", ctypes.c_uint), ("children", ctypes.POINTER(ctypes.POINTER(Node))),
                 ("mesh_count", ctypes.c_uint), ("meshes", ctypes.POINTER(ctypes.c_uint))]


class Scene(ctypes.Structure):  # the front of aiScene
    _fields_ = [("flags", ctypes.c_uint), ("root", ctypes.POINTER(Node)), ("mesh_count", ctypes.c_uint),
                ("meshes", ctypes.POINTER(ctypes.POINTER(Mesh)))]


def judge_mesh(mesh):
    """The triangles of a mesh, or what is wrong with it."""
    for i in range(mesh.vertex_count):
        v = mesh.vertices[i]
        if not (math.isfinite(v.x) and math.isfinite(v.y) and math.isfinite(v.z)):
            return 0, "a vertex is not finite"
    triangles = 0
    for i in range(mesh.face_count):
        face = mesh.faces[i]
        if any(face.indices[k] >= mesh.vertex_count for k in range(face.count)):
            return 0, "an index is out of range"
        triangles += face.count == 3
    return triangles, ""


def count_triangles(node, of_mesh):
    """Those of all nodes: a mesh that two nodes have is there twice."""
    own = sum(of_mesh[node.meshes[i]] for i in range(node.mesh_count))
    return own + sum(count_triangles(node.children[i].contents, of_mesh) for i in range(node.child_count))


def judge(path):
    """"N" triangles, or why the file is none of ours; in a process of its own, since assimp may crash."""
    library = ctypes.CDLL("libassimp.so.5")
    library.aiIsExtensionSupported.argtypes = [ctypes.c_char_p]
    library.aiImportFile.argtypes = [ctypes.c_char_p, ctypes.c_uint]
    library.aiImportFile.restype = ctypes.POINTER(Scene)
    if not library.aiIsExtensionSupported(path.suffix.encode()):
        return "no mesh format of assimp"
    scene = library.aiImportFile(str(path).encode(), TRIANGULATE)
    if not scene or not scene.contents.root:
        return "assimp can't open it"
    judged = [judge_mesh(scene.contents.meshes[i].contents) for i in range(scene.contents.mesh_count)]
    wrong = [problem for _, problem in judged if problem]
    if wrong:
        return wrong[0]
    triangles = count_triangles(scene.contents.root.contents, [count for count, _ in judged])
    return str(triangles) if triangles >= LEAST else f"fewer than {LEAST} triangles"


def ask(path):
    try:
        done = subprocess.run([sys.executable, __file__, "--judge", path], capture_output=True, text=True, timeout=120)
    except subprocess.TimeoutExpired:
        return "assimp takes more than 120 s"
    return done.stdout.strip().split("\n")[-1] if done.returncode == 0 else "assimp crashes on it"


def run(program, path, keys, seconds):
    """"" if one frame of the body was made, else the message."""
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "s.toml"
        name = str(path).replace("\\", "\\\\").replace('"', '\\"')
        scene.write_text(f'scene.allow_outside_files = true\n[[body]]\nname = "b"\nsurface = "{name}"\n{keys}\n')
        words = [program, "run", str(scene), "--frames", "1", "--no-images", "--quiet", "--out", str(Path(folder) / "out")]
        try:
            done = subprocess.run(words, capture_output=True, text=True, errors="replace", timeout=seconds,
                                  env=dict(os.environ, IMPINGE_CACHE="off"))
        except subprocess.TimeoutExpired:
            return f"more than {seconds} s"
        if done.returncode == 0:
            return ""
        message = done.stderr.strip().split("\n")[-1].replace(str(scene), "s.toml").replace(name, path.name)
        return f"exit {done.returncode}: {message}"


def group_of(message):
    """The fault in words that files share."""
    for words in ("more than", "is not closed", "is not manifold", "is not oriented", "degenerate", "inside out",
                  "encloses no", "encloses nothing", "out of range", "not finite", "can't be read", "importer failed",
                  "leads out", "no faces", "extent", "kg", "memory"):
        if words in message:
            return words
    return message[:60]


def main():
    words = sys.argv[1:]
    if words[:1] == ["--judge"]:
        sys.stderr = open(os.devnull, "w")
        print(judge(Path(words[1])))
        return 0
    out, seconds = None, 120
    if "--out" in words:
        at = words.index("--out")
        out = Path(words[at + 1])
        del words[at:at + 2]
    if "--seconds" in words:
        at = words.index("--seconds")
        seconds = int(words[at + 1])
        del words[at:at + 2]
    if len(words) < 2:
        print(__doc__)
        return 2
    program, folders = os.path.abspath(words[0]), [Path(word).resolve() for word in words[1:]]
    rows, left_out = [], []
    for folder in folders:
        for path in sorted(p for p in folder.rglob("*") if p.is_file()):
            verdict = ask(path)
            if not verdict.isdigit():
                left_out.append((folder, path.relative_to(folder), verdict))
                continue
            static = run(program, path, 'kind = "static"', seconds)
            mended = run(program, path, 'kind = "dynamic"\nmend = true', seconds)
            rows.append((folder, path.relative_to(folder), int(verdict), static, mended))
    if out:
        with out.open("w", newline="") as file:
            table = csv.writer(file)
            table.writerow(["folder", "file", "triangles", "static", "mended", "left out"])
            for folder, path, triangles, static, mended in rows:
                table.writerow([folder, path, triangles, static or "runs", mended or "runs", ""])
            for folder, path, why in left_out:
                table.writerow([folder, path, "", "", "", why])
    print(f"{'folder':<40} {'files':>5} {'static':>13} {'mended':>13}")
    for folder in folders + [None]:
        own = [row for row in rows if folder is None or row[0] == folder]
        share = [f"{sum(not row[k] for row in own)} ({100 * sum(not row[k] for row in own) / max(1, len(own)):.1f} %)" for k in (3, 4)]
        print(f"{'all' if folder is None else '...' + str(folder)[-36:]:<40} {len(own):>5} {share[0]:>13} {share[1]:>13}")
    for name, k in (("static", 3), ("mended", 4)):
        faults = [row for row in rows if row[k]]
        print(f"\n{name}: {len(faults)} refused")
        for group, count in Counter(group_of(row[k]) for row in faults).most_common():
            print(f"  {count:>3} {group}")
            for row in faults:
                if group_of(row[k]) == group:
                    print(f"        {row[1]}: {row[k]}")
    print(f"\nleft out: {len(left_out)}")
    for why, count in Counter(why for _, _, why in left_out).most_common():
        print(f"  {count:>3} {why}")
        if why != "no mesh format of assimp":
            print("        " + ", ".join(str(path) for _, path, reason in left_out if reason == why))
    return 0


if __name__ == "__main__":
    sys.exit(main())
