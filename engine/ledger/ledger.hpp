// Keeps the books of a frame (frame_ledger.hpp) while it is made.
//
// A motion takes a body from v₀ to v₁ by a sum of impulses, M (v₁ − v₀) = Σ p, and then to another place at v₁. For
// each of the two the books have identities that hold for any step length:
//
//   ½ v₁ᵀ M v₁ − ½ v₀ᵀ M v₀ = ½ (v₀ + v₁)ᵀ M (v₁ − v₀) = Σ p · v̄,   v̄ = ½ (v₀ + v₁)
//
// so the work of an impulse is p · v̄, whatever else acts in the same sub-step. What the impulses are:
//
//   gravity     h m g
//   elastic     as the scheme has it (integrators/, `impulses`): h f(x₁) of backward Euler, h f(x₀) − h² K v₁ of its
//               linearized form, h ((1−γ) f(x₀) + γ f(x₁)) of Newmark, h f(x₀) of symplectic Euler
//   damping     −h D v₁ (Newmark: at both ends; symplectic Euler: −h D v₀)
//   impact      normal part of Jᵀλ of contacts, whatever response found λ, springs of penalty included
//   friction    its tangential part
//   attachment  Jᵀλ of attachments and slides
//   script      pulls, pushes, external forces; and at held nodes, whose velocity is given and not solved for, the
//               reaction that takes part there: M (v₁ − v₀) less the impulses above
//   solver      what the answer is short of: A v₁ − b − Jᵀλ of a deformable body, with the A and b that were solved with;
//               M Δv − Jᵀλ of a rigid one. Its size is that of the tolerances (simulation.linear_solver, response)
//   integrator  of Newmark's scheme, h (1−γ) (M a₀ − f(x₀) − f_ext + D v₀): the acceleration that it remembers is not
//               that of the forces where contact acted
//
// A row against what moves by a script does p · v̄ on the body: of this p · v_script is the script's, and p · (v̄ − v_script)
// that of impact, friction or attachment. The script's share of a held node is found in the same way. What doesn't move
// gives no energy; the momentum that it takes is in the rows' entries, so those of two free bodies cancel in the world's
// sum and those against the ground don't.
//
// Then the body moves at v₁. A rigid one turns, which leaves L and changes ω; potentials change:
//
//   integrator  stored: ΔU of the motion at v₁ and the work of gravity and elastic forces above, which a scheme without an
//               error would take from U to the last bit. Symplectic Euler in free fall: −½ m g² h² a sub-step (v̄ lags behind
//               v₁ by h g/2). motion: ½ Lᵀ (R₁ I⁻¹ R₁ᵀ − R₀ I⁻¹ R₀ᵀ) L, rounding for the exact rotation
//   push_out    ΔU of the recovery, and ½ Lᵀ I⁻¹ L after less before
//   held_back   the same where a body goes back to where it stood
//   sleep       −T where a body falls asleep; script: −T − U where it is deleted, ΔU where it is moved, and all that parameters
//               which change between frames, gravity or a stiffness, do to a body that is where it was
//
// Pieces and motions that are undone leave no entry. Angular momentum is about the origin: an impulse at x gives x × p,
// a move by d of what has the momentum p gives d × p.
//
// The split is exact for every scheme and response here. What it can't tell apart: a row's normal impulse has in it what
// restitution, recovery from drift and the spring of penalty ask for. Entries of `solver` are found with the response's
// own J, not with the entries of rows, so an error in these shows as a closing error.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "engine/bodies/bodies.hpp"
#include "engine/bodies/time_integration.hpp"
#include "engine/ledger/frame_ledger.hpp"
#include "engine/step/sub_step.hpp"

namespace impinge {

struct Act;

/// To be told of everything that moves bodies, in the order of a frame. It changes nothing.
class Ledger {
 public:
  /// Does what somebody does between frames: it is in the books of the next frame.
  void act(Bodies& bodies, const Act& act, const Vec3& gravity, const std::function<void()>& doing);
  /// What was done since the last frame is undone.
  void forget_acts() { acts_ = {}; }

  /// `before`: by body, what was measured when the last frame ended; what acts don't explain of the change since then parameters
  /// did.
  void open_frame(Bodies& bodies, const Vec3& gravity, std::span<const Balance> before);
  /// A motion begins; whatever was told of one since the last kept() is undone.
  void open_motion(Bodies& bodies);
  /// Bodies have their free velocities.
  void freed(const Bodies& bodies, const TimeIntegration& how);
  /// And now those that the response left, which kept its rows (Solving::keeps_rows); they stand where they stood.
  void solved(Bodies& bodies, const SubStep& step, const TimeIntegration& how);
  void advanced(Bodies& bodies);
  void pushed_out(Bodies& bodies);
  /// The motion stands, but for those that were held back.
  void kept(Bodies& bodies);
  /// After kept(): some have fallen asleep.
  void rested(const Bodies& bodies);
  void close_substep(int substep);
  /// The books as they would be if the frame ended here: those of its end, after the last sub-step.
  std::shared_ptr<const FrameLedger> so_far(Bodies& bodies) const;

 private:
  using Entries = std::array<LedgerEntry, kLedgerSources>;

  /// A body as the books know it: where it is, and how it moved when the motion began.
  struct Known {
    Pose pose;
    Vec3 spin = Vec3::Zero();  ///< angular momentum of a rigid body
    VecX nodes;                ///< positions of a deformable one
    double elastic = 0.0;      ///< J
    Twist twist;
    Twist mean;      ///< v̄
    VecX node_mean;  ///< the same of a deformable one, over all nodes
  };
  struct BeforeRest {
    bool asleep = false;
    Balance balance;  ///< of one that is awake
  };

  Balance measured(Body& body) const;
  void know(Body& body, Known& known) const;
  void take_parameters(const Balance& before, const Balance& now, BodyLedger& books) const;
  void take_rigid(Body& body, BodyIndex index, const TimeIntegration& how);
  void take_deformable(Body& body, BodyIndex index, const TimeIntegration& how, const GroupResult* result,
                       const VecX* row_impulse);
  void take_rows(const Bodies& bodies, const SubStep& step);
  void take_move(Body& body, Known& known, LedgerEntry& entry) const;
  void take_moves(Bodies& bodies, LedgerSource source);
  LedgerEntry rigid_entry(BodyIndex index, const Vec3& impulse, const Vec3& torque) const;
  LedgerEntry node_entry(BodyIndex index, const VecX& impulse) const;
  LedgerEntry side_entry(BodyIndex index, const Body& body, const ContactSide& side, const Vec3& way,
                         const Vec3& impulse);
  LedgerEntry pushed(Body& body, const Act& act, const std::function<void()>& doing) const;

  Vec3 gravity_ = Vec3::Zero();
  std::vector<BodyLedger> acts_;  // since the last frame; empty: none
  FrameLedger frame_;
  std::vector<Balance> begin_;               // by body, when the frame began
  std::vector<double> elastic_;              // by body, where the last kept motion left it
  std::vector<Known> known_;                 // by body, of the open motion
  std::vector<Vec3> pull_;                   // by body: on a rigid one in the open motion, N·s
  std::vector<std::optional<Vec3>> flight_;  // by body that met in flight: what its impact did on the way
  std::vector<Entries> motion_;              // by body, of the open motion
  std::vector<Entries> substep_;             // of its kept motions
  std::vector<std::array<double, kLedgerSources>> largest_;  // by body, of a sub-step of the frame, J
  std::vector<BeforeRest> before_rest_;
};

}  // namespace impinge
