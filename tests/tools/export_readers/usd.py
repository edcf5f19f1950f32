"""USD, by the strict reader."""
import numpy as np

from export_readers import usda
from export_readers.poses import rotation
from export_readers.run import check, check_small, triangles


def check_usda(run, path):
    try:
        stage = usda.read(path)
    except usda.Bad as bad:
        check("the strict reader takes it", False, str(bad))
        return
    meta, world = stage.metadata, stage.prims[stage.metadata["defaultPrim"]]
    check("the strict reader takes it", True)
    prims = {p.custom.get("name", p.name): p for p in world.children.values()}
    check("a mesh a body", set(prims) == set(run.names))
    rate = meta["timeCodesPerSecond"]
    codes = {f: next((c for c in [round(run.time(f) * rate), run.time(f) * rate] if abs(c / rate - run.time(f)) <= 1e-9), None) for f in run.frames}
    check("time codes are the frames' times", None not in codes.values() and meta["startTimeCode"] == codes[run.frames[0]] and
          meta["endTimeCode"] == codes[run.frames[-1]] and meta["framesPerSecond"] == rate)
    check("y is up, in metres", meta["upAxis"] == "Y" and meta["metersPerUnit"] == 1)
    errors, same, once = [], True, True
    for name, prim in prims.items():
        attributes = usda.compose(stage, prim)
        once = once and (name in run.moving() or all(a.samples is None for a in attributes.values()))
        truth = triangles(run.surface(0, name))
        same = same and np.array_equal(np.array(attributes["faceVertexIndices"].value).reshape(-1, 3), truth)
        for frame in run.frames:
            points, x, q = (np.array(attributes[a].at(float(codes[frame])), dtype) for a, dtype in
                            (("points", np.float32), ("xformOp:translate", float), ("xformOp:orient", float)))
            errors.append(np.abs(points.astype(float) @ rotation(q).T + x - run.surface(frame, name).points).max() / run.size)
    check_small("positions / size", errors, 1e-6)
    check("triangles are the run's", same)
    check("what never moves has no time samples", once)
