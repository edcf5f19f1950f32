"""Small random scenes for the comparison of two commits: the same number makes the same scene everywhere.

Every response, cone solver, integrator, material, broad and narrow phase comes up, with rigid, deformable and mixed
bodies; methods go round in step so that none is left to chance.
"""
import random

RESPONSES = ["constraint_anticipation", "iterative_constraint_anticipation", "penalty", "sequential_impulse",
             "simultaneous_impulse", "soft_constraint"]
SOLVERS = ["automatic", "projected_gauss_seidel", "nonsmooth_nonlinear_conjugate_gradient",
           "accelerated_projected_gradient", "semismooth_newton"]
INTEGRATORS = ["linearly_implicit_euler", "implicit_euler", "newmark", "symplectic_euler"]
MATERIALS = ["corotational", "linear", "fixed_corotated", "stvk", "neo_hookean", "mass_spring"]
BROAD = ["sweep_and_prune", "brute_force"]
NARROW = ["spatial_hash", "brute_force"]
KINDS = ["rigid", "deformable", "mixed"]


def numbers(values):
    return "[" + ", ".join(f"{v:.6g}" for v in values) + "]"


def shape_keys(rng, size, meshes):
    kind = rng.choice(["sphere", "box", "capsule"] + (["mesh"] if meshes else []))
    if kind == "sphere":
        return f"shape = {{ sphere = {{ radius = {0.5 * size:.6g} }} }}"
    if kind == "box":
        return f"shape = {{ box = {{ size = {numbers([size * rng.uniform(0.6, 1.3) for _ in range(3)])} }} }}"
    if kind == "capsule":
        return f"shape = {{ capsule = {{ radius = {0.3 * size:.6g}, length = {0.8 * size:.6g} }} }}"
    name, extent = rng.choice(meshes)
    return f'surface = "{name}"\nscale = {size / extent:.6g}'


def rigid_body(rng, i, place, size, meshes):
    lines = ["[[body]]", f'name = "rigid_{i}"', 'kind = "dynamic"', shape_keys(rng, size, meshes),
             f"position = {numbers(place)}", f"rotation = {numbers([rng.uniform(-90, 90) for _ in range(3)])}",
             f"velocity = {numbers([rng.uniform(-0.5, 0.5), rng.uniform(-2, 0), rng.uniform(-0.5, 0.5)])}",
             f"angular_velocity = {numbers([rng.uniform(-3, 3) for _ in range(3)])}",
             f"material = {{ density = {rng.choice([300, 1000, 4000])} }}"]
    if rng.random() < 0.3:
        lines.append(f"friction = {rng.uniform(0, 1):.3g}")
    if rng.random() < 0.3:
        lines.append(f"restitution = {rng.uniform(0, 0.9):.3g}")
    return lines


def deformable_body(rng, i, place, size, material):
    lines = ["[[body]]", f'name = "soft_{i}"', 'kind = "deformable"']
    if rng.random() < 0.6:
        lines += [f"shape = {{ box = {{ size = {numbers([size * rng.uniform(0.8, 1.2) for _ in range(3)])} }} }}",
                  f"volume = {{ lattice = {{ cells = {rng.choice([2, 3])} }} }}"]
    else:
        lines += [f"shape = {{ sphere = {{ radius = {0.5 * size:.6g} }} }}", "volume = { cage = { cells = 4 } }"]
    mass = rng.choice(["lumped", "consistent"])
    lines += [f'material = {{ model = "{material}", young = {rng.choice([5e3, 2e4, 1e5]):g}, '
              f'poisson = {rng.choice([0.25, 0.4])}, density = 1000, damping = [0, 0.005], mass = "{mass}" }}',
              f"position = {numbers(place)}", f"rotation = {numbers([0, rng.uniform(-40, 40), rng.uniform(-20, 20)])}",
              f"velocity = {numbers([0, rng.uniform(-1, 0), 0])}"]
    if rng.random() < 0.2:
        x, y, z = place
        lines.append(f"fixed = {{ sphere = {{ center = {numbers([x, y + 0.4 * size, z])}, radius = {0.5 * size:.6g} }} }}")
    if rng.random() < 0.2:
        lines.append("self_collision = true")
    return lines


def make(number, meshes):
    """The scene's text and its last frame. `meshes`: (path, longest side in metres) of closed surfaces, or none."""
    rng = random.Random(20261122 + number)
    kind = KINDS[number % 3]
    response = RESPONSES[(number // 3) % 6]
    solver = SOLVERS[(number // 18) % 5] if number < 90 else rng.choice(SOLVERS)
    integrator = INTEGRATORS[(number // 3 + number // 12) % 4]
    explicit = integrator == "symplectic_euler" and kind != "rigid"
    lines = ["[simulation]", "frame_time = 0.0166666666667", f"substeps = {24 if explicit else rng.choice([1, 2, 4])}",
             f'integrator = "{integrator}"', f"sleeping = {rng.choice(['true', 'false'])}",
             f"sleep_speed = {rng.choice([1e-4, 0.05])}", "sleep_time = 0.05", "",
             "[contact]", f"friction = {rng.choice([0, 0.2, 0.5, 1.0])}", f"restitution = {rng.choice([0, 0, 0.4])}",
             f'points = "{"intersection" if rng.random() < 0.15 else "proximity"}"',
             f'push_out = "{"velocity" if rng.random() < 0.25 else "split"}"',
             f"warm_start = {'false' if rng.random() < 0.2 else 'true'}", "",
             "[broad_phase]", f'method = "{BROAD[number % 2]}"', "",
             "[narrow_phase]", f'method = "{NARROW[(number // 2) % 2]}"', "",
             "[lcp]", f'method = "{solver}"', f"tolerance = {rng.choice([1e-4, 1e-8])}",
             f"max_iterations = {rng.choice([50, 400])}", "",
             "[response]", f'method = "{response}"', "max_iterations = 200"]
    if response == "iterative_constraint_anticipation" and rng.random() < 0.3:
        lines.append('stop = "change"')
    if response == "penalty":
        lines.append(f'penalty_form = "{rng.choice(["implicit", "explicit"])}"')
    if response == "soft_constraint":
        lines += [f"soft_frequency = {rng.choice([10, 30])}", f"soft_iterations = {rng.choice([1, 4])}"]
    lines += ["", "[[body]]", 'name = "floor"', 'kind = "static"']
    if rng.random() < 0.7:
        lines.append("shape = { plane = { normal = [0, 1, 0], offset = 0 } }")
    else:
        lines += ["shape = { box = { size = [3, 0.2, 3] } }", "position = [0, -0.1, 0]"]
    if rng.random() < 0.3:
        lines += ["", "[[body]]", 'name = "paddle"', 'kind = "scripted"', "shape = { box = { size = [0.1, 0.2, 0.6] } }",
                  "motion = [ { time = 0, position = [-0.5, 0.12, 0] }, { time = 0.3, position = [0.2, 0.12, 0], "
                  "rotation = [0, 40, 0] } ]"]
    count = rng.choice([2, 3, 5]) if kind == "rigid" else rng.choice([1, 2, 3])
    names = []
    height = 0.0
    for i in range(count):
        soft = kind == "deformable" or (kind == "mixed" and i % 2 == 0)
        size = rng.uniform(0.12, 0.25)
        height += 0.75 * size
        place = [rng.uniform(-0.05, 0.05), height, rng.uniform(-0.05, 0.05)]
        height += 0.75 * size
        material = MATERIALS[(number + i) % 6]
        lines.append("")
        if soft:
            lines += deformable_body(rng, i, place, size, material)
            names.append((f"soft_{i}", place))
        else:
            lines += rigid_body(rng, i, place, size, meshes)
            names.append((f"rigid_{i}", place))
    if rng.random() < 0.25:
        name, place = rng.choice(names)
        lines += ["", "[[attachment]]", f'body_a = "{name}"', f"point = {numbers(place)}"]
    if len(names) > 1 and rng.random() < 0.2:
        (a, at), (b, _) = names[0], names[1]
        lines += ["", "[[attachment]]", f'body_a = "{a}"', f'body_b = "{b}"', f"point = {numbers(at)}"]
    return "\n".join(lines) + "\n", 12 if explicit else 24
