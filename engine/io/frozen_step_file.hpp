// A frozen step as a file: DIR/frozen/NNNNNN.step of `impinge run --freeze`, the input of `impinge step`. Numbers are little-endian;
// u8, i32, u32, u64 and f64 (IEEE 754) as named, text a u32 length and its bytes, vec 3 f64, mat 9 f64 row by row. SI units.
//
//   "impinge frozen step\n", u32 version (2), u32 0, u64 length of what follows the head, u64 its 64-bit FNV-1a checksum
//   text scene, i32 frame, f64 time at the sub-step's start, f64 Δt, vec gravity
//   text integrator, linear_solver, response, form, stop, lcp; f64 tolerance, i32 max_iterations (lcp), i32 max_iterations (response)
//   f64 max_push_out, f64 restitution_threshold, i32 impulse_iterations, text penalty_form, f64 penalty_stiffness, penalty_damping,
//   penalty_slip_speed, soft_frequency, soft_damping_ratio, i32 soft_iterations, soft_relax_iterations
//   u32 bodies, and the name of each (text), scene order
//   u32 groups, and of each:
//     u32 rigid bodies, each: i32 scene index, f64 1/m, mat I⁻¹ (world axes), vec v*, vec ω*
//     u32 deformable bodies, each: i32 scene index, u8 whether A is block diagonal, f64 s/Δt, u32 free nodes n,
//       u32 begin of block rows 0 … n in the list of blocks, u32 column of each block, mat of each block of A (both triangles),
//       vec v* of each node, vec (s v* + d)/Δt of each node
//     u32 contacts, each: u8 kind (0 contact, 1 attachment, 2 sliding), i32 body_a, body_b, triangle_a, triangle_b (-1: none),
//       vec p_A, p_B, u64 feature, mat directions (rows n, t1, t2), vec what prescribed motion adds to J v, f64 g0, f64 bound (J v >=
//       bound along n), f64 mu, f64 restitution, f64 J v along n before the sub-step, vec λ where the run started (n, t1, t2), vec λ that the run found, then side a and side b:
//       i32 index of the rigid body in the group, i32 of the deformable one (-1: not of that kind), vec arm from the centre of mass,
//       u32 nodes, each i32 node, f64 weight.   J: d^T and (r x d)^T by arm, weight d^T by node; side b with the opposite sign
//     the run's Δv: of each rigid body vec Δv, vec Δω; of each deformable body vec by node
#pragma once

#include <filesystem>

#include "engine/world/frozen_step.hpp"

namespace impinge {

/// Throws InputError where it can't be written.
void write_frozen_step(const std::filesystem::path& path, const FrozenStep& step);

/// Throws InputError `file: byte N: found; allowed; remedy` unless the file is whole, of this version and consistent: indices in
/// range, matrices with symmetric patterns, finite numbers.
FrozenStep read_frozen_step(const std::filesystem::path& path);

/// Whether the file begins as a frozen step does. False where it can't be read.
bool is_frozen_step(const std::filesystem::path& path);

}  // namespace impinge
