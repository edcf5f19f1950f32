"""PLY and OBJ, read by meshio."""
import meshio
import numpy as np

from export_readers.run import check, check_small, triangles


def check_sequence(run, folder, ending):
    expected = {f"{n}.{frame:06}.{ending}" for n in run.moving() for frame in run.frames}
    expected |= {f"{n}.{ending}" for n in run.names if n not in run.moving()}
    check("the files of the sequences, and no others", {p.name for p in folder.glob(f"*.{ending}")} == expected)
    errors, same = [], True
    for n in run.names:
        for frame in run.frames if n in run.moving() else run.frames[:1]:
            ours = meshio.read(folder / (f"{n}.{frame:06}.{ending}" if n in run.moving() else f"{n}.{ending}"))
            truth = run.surface(frame, n)
            errors.append(np.abs(ours.points - truth.points).max())
            same = same and np.array_equal(triangles(ours), triangles(truth))
    check_small("vertices are the run's to the bit", errors, 0.0)
    check("triangles are the run's", same)
