// What a factorization costs, known before it is made.
#pragma once

namespace impinge {

/// Of linear solvers whose analysis tells.
class FactorWork {
 public:
  virtual ~FactorWork() = default;
  /// Floating-point operations of one factorization; valid after analyze.
  virtual double factor_work() const = 0;
};

}  // namespace impinge
