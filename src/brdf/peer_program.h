#pragma once
// A peer model of a Lambert part and one lobe as a program.

#include <vector>

#include "batch_program.h"
#include "batch_source.h"

namespace goniofit::batch {

template <class Real>
class PeerProgram final : public Program<Real> {
 public:
  /// Precondition: block::peer_fields knows the model. Throws Error (bad_input) when the material is not valid.
  PeerProgram(const Material& material, const CompileSettings& settings);

  [[nodiscard]] std::size_t channels() const noexcept override { return plans_.size(); }
  void run(const BasicPairBatch<Real>& pairs, std::span<Real> result) const override {
    run_blocks(PairSource<Real, Real>(pairs, fields_, set_), result);
  }
  void run(const BasicDirectionBatch<Real>& directions, std::span<Real> result) const override {
    run_blocks(DirectionSource<Real, Real>(directions, fields_, set_), result);
  }

 private:
  struct Plan {
    Real mirror_0{}, mirror_1{}, diffuse{}, index{}, kappa{};
    block::Loop<block::CombineArguments<Real, Real>> combine = nullptr;
  };
  void plan_channels(const Material& material);
  template <class Source>
  void run_blocks(const Source& source, std::span<Real> result) const;

  InstructionSet set_;
  block::Fields fields_;
  block::Use mirror_ = block::Use::constant;
  Real z_{};
  block::Loop<block::PeerArguments<Real>> lobe_ = nullptr;  ///< null for Lambert
  block::Loop<block::FresnelArguments<Real>> fresnel_ = nullptr;
  std::vector<Plan> plans_;
};

}  // namespace goniofit::batch
