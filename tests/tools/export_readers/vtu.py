"""VTU and PVD, read by VTK and by meshio, and a picture by VTK's renderer."""
from xml.etree import ElementTree

import meshio
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from export_readers.run import check, check_small, impulse_on_a, vector


class Grid:
    """By VTK, and the same by meshio."""

    def __init__(self, path):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(path))
        reader.Update()
        grid = self.vtk = reader.GetOutput()
        if reader.GetErrorCode() != 0:
            check(f"VTK reads {path.name}", False)
        n = grid.GetNumberOfPoints()
        self.points = vtk_to_numpy(grid.GetPoints().GetData()) if n else np.zeros((0, 3))
        self.is_double = n == 0 or grid.GetPoints().GetDataType() == 11  # VTK_DOUBLE
        self.cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()) if grid.GetNumberOfCells() else np.zeros(0, int)
        self.point_data, self.cell_data = [
            {d.GetArrayName(i): vtk_to_numpy(d.GetArray(i)) for i in range(d.GetNumberOfArrays())} for d in (grid.GetPointData(), grid.GetCellData())]
        if n:
            other = meshio.read(path)
            same = np.array_equal(other.points, self.points)
            for ours, theirs in ((self.point_data, other.point_data), (self.cell_data, {k: np.concatenate(v) for k, v in other.cell_data.items()})):
                same = same and set(ours) == set(theirs) and all(np.array_equal(ours[k], theirs[k].reshape(ours[k].shape), equal_nan=True) for k in ours)
            if not same:
                check(f"meshio reads {path.name} as VTK does", False)


def read_pvd(path):
    root = ElementTree.parse(path).getroot()
    if root.tag != "VTKFile" or root.get("type") != "Collection" or [c.tag for c in root] != ["Collection"]:
        raise ValueError(f"{path}: no collection")
    times = {}
    for entry in root[0]:
        if entry.tag != "DataSet" or set(entry.attrib) != {"timestep", "group", "part", "file"}:
            raise ValueError(f"{path}: {entry.tag}")
        parts = times.setdefault(float(entry.get("timestep")), [])
        if int(entry.get("part")) != len(parts):
            raise ValueError(f"{path}: parts out of order")
        parts.append(path.parent / entry.get("file"))
    return times


def bodies_of(grid, names):
    """name: places of its points, in order."""
    corners, body = grid.cells.reshape(len(grid.cell_data["body"]), -1), grid.cell_data["body"]
    return {names[b]: np.arange(corners[body == b].min(), corners[body == b].max() + 1) for b in np.unique(body)}


def check_surfaces(run, folder, names):
    times = read_pvd(folder / "surfaces.pvd")
    check("surfaces.pvd has the frames' times", sorted(times) == [run.time(f) for f in run.frames])
    check("what never moves is one file", len({p for parts in times.values() for p in parts if p.name == "static.vtu"}) ==
          any(k == "static" for n, k in run.kinds.items() if n in run.names))
    start = {n: run.surface(0, n).points for n in run.names}
    positions, displacements, impulses, gaps, doubles = [], [], [], [], True
    for frame in run.frames:
        on, lowest = {n: np.zeros(3) for n in run.names}, {n: np.inf for n in run.names}
        for row in run.contacts[frame]:
            for body, sign in ((row["body_a"], 1), (row["body_b"], -1)):
                if body in on:
                    on[body] = on[body] + sign * impulse_on_a(row)
                    lowest[body] = min(lowest[body], float(row["gap_m"]))
        seen = set()
        for part in times[run.time(frame)]:
            grid = Grid(part)
            doubles = doubles and grid.is_double
            for name, place in bodies_of(grid, names).items():
                seen.add(name)
                truth = run.surface(frame, name)
                positions.append(np.abs(grid.points[place] - truth.points).max())
                if part.name == "static.vtu":
                    continue
                displacements.append(np.abs(grid.point_data["displacement"][place] - (truth.points - start[name])).max())
                impulses.append(np.abs(grid.point_data["contact_impulse"][place].sum(0) - on[name]).max() / max(1e-3, np.abs(on[name]).max()))
                gap = grid.point_data["gap"][place]
                gap = gap[~np.isnan(gap)]
                gaps.append(abs(gap.min() - lowest[name]) if len(gap) and np.isfinite(lowest[name]) else float(len(gap) != np.isfinite(lowest[name])))
        if seen != set(run.names):
            check(f"every body is in frame {frame}", False, str(set(run.names) ^ seen))
    check("doubles", doubles)
    check_small("positions of surfaces / size", np.array(positions) / run.size, 1e-12)
    check_small("displacements / size", np.array(displacements) / run.size, 1e-12)
    check_small("impulses on bodies, summed over vertices", impulses, 1e-9)
    check_small("smallest gaps (m)", gaps, 1e-12)


def volume(points, tets):
    a, b, c, d = (points[tets[:, k]] for k in range(4))
    return np.einsum("ij,ij->i", b - a, np.cross(c - a, d - a)) / 6


def check_tetrahedra(run, folder, names):
    soft = [n for n in run.names if run.kinds[n] == "deformable"]
    check("tetrahedra.pvd where there are any", (folder / "tetrahedra.pvd").exists() == bool(soft))
    if not soft:
        return
    times = read_pvd(folder / "tetrahedra.pvd")
    check("tetrahedra.pvd has the frames' times", sorted(times) == [run.time(f) for f in run.frames])
    ratios, mises, momenta, stressed = [], [], [], 0.0
    for frame in run.frames:
        grid = Grid(times[run.time(frame)][0])
        tets = grid.cells.reshape(-1, 4)
        check_bodies = {names[b] for b in np.unique(grid.cell_data["body"])} == set(soft)
        if not check_bodies:
            check(f"bodies of the tetrahedra of frame {frame}", False)
        rest = volume(grid.points - grid.point_data["displacement"], tets)
        ratios.append(np.abs(volume(grid.points, tets) / rest - grid.cell_data["volume_ratio"]).max())
        s = grid.cell_data["stress"]
        xx, yy, zz, xy, yz, xz = s.T
        by_hand = np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * (xy**2 + yz**2 + xz**2))
        mises.append(np.abs(by_hand - grid.cell_data["von_mises_stress"]).max() / max(1.0, by_hand.max()))
        stressed = max(stressed, by_hand.max())
    check_small("volume ratios from positions and displacements", ratios, 1e-9)
    check_small("von Mises stress from the six components", mises, 1e-12)
    check("there is stress", stressed > 1.0, f"{stressed:.4g} Pa")


def check_contacts(run, folder, names):
    times = read_pvd(folder / "contacts.pvd")
    check("contacts.pvd has the frames' times", sorted(times) == [run.time(f) for f in run.frames])
    same, errors, count = True, [], 0
    for frame in run.frames:
        rows = run.contacts[frame]
        grid = Grid(times[run.time(frame)][0])
        same = same and len(grid.points) == len(rows)
        for i, row in enumerate(rows if len(grid.points) == len(rows) else []):
            count += 1
            data = {k: v[i] for k, v in grid.point_data.items()}
            same = same and names[data["body_a"]] == row["body_a"] and names[data["body_b"]] == row["body_b"]
            same = same and ("open", "stick", "slip")[data["state"]] == row["state"]
            errors += [np.abs(data[f] - vector(row, *(c + x for x in ("x", "y", "z")))).max() for f, c in (("point_a", "pa_"), ("point_b", "pb_"), ("normal", "n_"))]
            errors += [abs(data["gap"] - float(row["gap_m"])), np.abs(data["impulse"] - impulse_on_a(row)).max(), abs(data["friction"] - float(row["mu"]))]
    check("contacts are those of contacts.csv", same and count > 0, f"{count} of them")
    check_small("their points, normals, gaps, impulses", errors, 1e-12)


def draw(run, folder, picture):
    from vtkmodules import vtkRenderingOpenGL2, vtkInteractionStyle  # noqa: F401, the factories of what follows
    from vtkmodules.vtkCommonCore import vtkLookupTable
    from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
    from vtkmodules.vtkIOImage import vtkPNGWriter
    from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter
    renderer = vtkRenderer()
    renderer.SetBackground(0.1, 0.11, 0.13)
    colors = vtkLookupTable()
    colors.SetHueRange(0.66, 0.0)
    for part in read_pvd(folder / "surfaces.pvd")[run.time(run.frames[-1])]:
        surface, mapper, actor = vtkGeometryFilter(), vtkPolyDataMapper(), vtkActor()
        grid = Grid(part)
        surface.SetInputData(grid.vtk)
        mapper.SetInputConnection(surface.GetOutputPort())
        field = "von_mises_stress" if "von_mises_stress" in grid.point_data else "velocity" if "velocity" in grid.point_data else None
        if field:
            values = grid.point_data[field]
            values = np.linalg.norm(values, axis=1) if values.ndim == 2 else values
            mapper.SetScalarModeToUsePointFieldData()
            mapper.SelectColorArray(field)
            colors.SetVectorModeToMagnitude()
            mapper.SetLookupTable(colors if field == "velocity" else vtkLookupTable())
            mapper.GetLookupTable().SetHueRange(0.66, 0.0)
            mapper.SetScalarRange(0.0, float(np.quantile(values, 0.99)) or 1.0)
        else:
            mapper.ScalarVisibilityOff()
            actor.GetProperty().SetOpacity(0.25)
        actor.SetMapper(mapper)
        renderer.AddActor(actor)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(1280, 720)
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(0.6, 0.7, 1.0)
    renderer.ResetCamera()
    camera.Zoom(1.3)
    window.Render()
    image, writer = vtkWindowToImageFilter(), vtkPNGWriter()
    image.SetInput(window)
    writer.SetFileName(str(picture))
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()
    print(f"picture: {picture}")
