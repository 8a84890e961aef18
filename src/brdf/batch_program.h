#pragma once
// What BatchEvaluator holds: the loops that a material needs, in order.

#include <memory>
#include <span>

#include "batch_evaluator.h"

namespace goniofit::batch {

template <class Real>
class Program {
 public:
  virtual ~Program() = default;
  [[nodiscard]] virtual std::size_t channels() const noexcept = 0;
  virtual void run(const BasicPairBatch<Real>& pairs, std::span<Real> result) const = 0;
  virtual void run(const BasicDirectionBatch<Real>& directions, std::span<Real> result) const = 0;
};

/// Throws Error (bad_input) when the material is not valid.
template <class Real>
[[nodiscard]] std::unique_ptr<const Program<Real>> compile(const Material& material, const CompileSettings& settings);

}  // namespace goniofit::batch
