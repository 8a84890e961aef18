#include "brdf/batch_evaluator.h"

#include <type_traits>

#include "brdf/batch_program.h"
#include "brdf/batch_source.h"

namespace goniofit {

template <class Real>
BatchEvaluator<Real>::BatchEvaluator(const Material& material, const CompileSettings& settings)
    : program_(batch::compile<Real>(material, settings)) {}
template <class Real>
BatchEvaluator<Real>::~BatchEvaluator() = default;
template <class Real>
BatchEvaluator<Real>::BatchEvaluator(BatchEvaluator&&) noexcept = default;
template <class Real>
BatchEvaluator<Real>& BatchEvaluator<Real>::operator=(BatchEvaluator&&) noexcept = default;

template <class Real>
std::size_t BatchEvaluator<Real>::channels() const noexcept {
  return program_->channels();
}

template <class Real>
void BatchEvaluator<Real>::values(const BasicPairBatch<Real>& pairs, std::span<Real> result) const {
  program_->run(pairs, result);
}

template <class Real>
void BatchEvaluator<Real>::values(const BasicDirectionBatch<Real>& directions, std::span<Real> result) const {
  program_->run(directions, result);
}

template class BatchEvaluator<double>;
template class BatchEvaluator<float>;

}  // namespace goniofit
