#include "brdf/batch_program.h"

#include "brdf/batch_source.h"
#include "brdf/evaluator.h"
#include "brdf/peer_program.h"
#include "brdf/surface_program.h"

namespace goniofit::batch {

namespace {

/// Pair by pair, for models without loops of their own.
template <class Real>
class PairwiseProgram final : public Program<Real> {
 public:
  explicit PairwiseProgram(const Material& material) : evaluator_(material) {}

  [[nodiscard]] std::size_t channels() const noexcept override { return evaluator_.channels(); }
  void run(const BasicPairBatch<Real>& pairs, std::span<Real> result) const override {
    run_from(PairSource<Real, Real>(pairs, {}, InstructionSet::sse2), result);
  }
  void run(const BasicDirectionBatch<Real>& directions, std::span<Real> result) const override {
    run_from(DirectionSource<Real, Real>(directions, {}, InstructionSet::sse2), result);
  }

 private:
  template <class Source>
  void run_from(const Source& source, std::span<Real> result) const {
    for (std::size_t i = 0; i < source.size(); ++i) {
      const Pair p = source.pair(i);
      for (std::size_t c = 0; c < channels(); ++c) {
        result[c * source.size() + i] = static_cast<Real>(evaluator_.value(p, c));
      }
    }
  }

  Evaluator evaluator_;
};

/// Single precision is good for this.
constexpr double single_precision = 2e-5;

}  // namespace

template <class Real>
std::unique_ptr<const Program<Real>> compile(const Material& material, const CompileSettings& settings) {
  if (material.model != surface_model) {
    if (!block::peer_fields(material.model)) return std::make_unique<PairwiseProgram<Real>>(material);
    return std::make_unique<PeerProgram<Real>>(material, settings);
  }
  if (settings.tolerance >= single_precision) return std::make_unique<SurfaceProgram<Real, float>>(material, settings);
  return std::make_unique<SurfaceProgram<Real, Real>>(material, settings);
}

template std::unique_ptr<const Program<double>> compile(const Material&, const CompileSettings&);
template std::unique_ptr<const Program<float>> compile(const Material&, const CompileSettings&);

}  // namespace goniofit::batch
