#pragma once
// A material compiled into kernels for exactly its effects and tiers: values of whole batches of directions.

#include <cstddef>
#include <memory>
#include <span>

#include "../geometry/direction_batch.h"
#include "../geometry/pair.h"
#include "../support/instruction_set.h"
#include "material.h"

namespace goniofit {

namespace batch {
template <class Real>
class Program;
}

struct CompileSettings {
  /// Largest relative error of a term that may be replaced by a cheaper expression of it, 0 or at least 1e-9. At 0
  /// values are those of Evaluator to 1e-13 (1 + |ln f|) in double and 1e-5 (1 + |ln f|) in float (but for W of tier
  /// he-torrance, which is good to 1e-9 itself). Values below 1e-240 (float: 1e-20) may come back as anything below
  /// that.
  double tolerance = 0.0;
  /// LT (7): S1 = 1 where cos > 1 - 0.005^(sigma/tau). A step of up to 0.5 % in each of the two factors (tier
  /// li-torrance only); never inside a fit.
  bool shadowing_shortcut = false;
  InstructionSet instructions = best_instruction_set();
};

/// Real is double or float.
template <class Real>
class BatchEvaluator {
 public:
  /// Throws Error (bad_input) when the material is not valid.
  explicit BatchEvaluator(const Material& material, const CompileSettings& settings = {});
  ~BatchEvaluator();
  BatchEvaluator(BatchEvaluator&&) noexcept;
  BatchEvaluator& operator=(BatchEvaluator&&) noexcept;

  [[nodiscard]] std::size_t channels() const noexcept;

  /// result[channel * pairs.size() + i] in 1/sr; 0 outside the hemisphere, never negative, never NaN, at most
  /// `saturation` (float: 1e30). result has channels() * size() elements. Safe to call from several threads.
  void values(const BasicPairBatch<Real>& pairs, std::span<Real> result) const;
  /// The same from unit vectors: what geometry the kernels read is computed here, and no more.
  void values(const BasicDirectionBatch<Real>& directions, std::span<Real> result) const;

 private:
  std::unique_ptr<const batch::Program<Real>> program_;
};

}  // namespace goniofit
