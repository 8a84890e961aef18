#include "brdf/batch_evaluator.h"

#include "brdf/evaluator.h"

namespace goniofit {

template <class Real>
class BatchEvaluator<Real>::Program {
 public:
  explicit Program(const Material& m) : scalar(m) {}
  Evaluator scalar;
};

template <class Real>
BatchEvaluator<Real>::BatchEvaluator(const Material& material, const CompileSettings& /*settings*/)
    : program_(std::make_unique<Program>(material)) {}
template <class Real>
BatchEvaluator<Real>::~BatchEvaluator() = default;
template <class Real>
BatchEvaluator<Real>::BatchEvaluator(BatchEvaluator&&) noexcept = default;
template <class Real>
BatchEvaluator<Real>& BatchEvaluator<Real>::operator=(BatchEvaluator&&) noexcept = default;

template <class Real>
std::size_t BatchEvaluator<Real>::channels() const noexcept {
  return program_->scalar.channels();
}

template <class Real>
void BatchEvaluator<Real>::values(const BasicPairBatch<Real>& pairs, std::span<Real> result) const {
  for (std::size_t c = 0; c < channels(); ++c) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      result[c * pairs.size() + i] = static_cast<Real>(program_->scalar.value(pairs.template as<double>(i), c));
    }
  }
}

template <class Real>
void BatchEvaluator<Real>::values(const BasicDirectionBatch<Real>& d, std::span<Real> result) const {
  for (std::size_t i = 0; i < d.size(); ++i) {
    const Pair pair = make_pair({d.l_x[i], d.l_y[i], d.l_z[i]}, {d.v_x[i], d.v_y[i], d.v_z[i]});
    for (std::size_t c = 0; c < channels(); ++c) {
      result[c * d.size() + i] = static_cast<Real>(program_->scalar.value(pair, c));
    }
  }
}

template class BatchEvaluator<double>;
template class BatchEvaluator<float>;

}  // namespace goniofit
