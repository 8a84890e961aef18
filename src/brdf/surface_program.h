#pragma once
// The surface family as a program: the loops of block_loops.h that its effects and tiers need.

#include <cmath>
#include <vector>

#include "../support/instruction_set.h"
#include "batch_program.h"
#include "batch_source.h"
#include "evaluator.h"
#include "material_curves.h"

namespace goniofit::batch {

/// What one channel adds to what all share.
template <class Real>
struct ChannelPlan {
  block::Use mirror = block::Use::absent, below = block::Use::absent;
  bool fs = false, rough = false, coherent = false;
  Real mirror_0{}, mirror_1{}, below_0{}, below_1{}, diffuse{}, rho{};
  Real index{}, kappa{};
  double wavelength_um = 1.0;
  std::optional<block::Polynomial<Real>> fresnel_curve{}, transmission_curve{};
  block::Loop<block::FresnelCurveArguments<Real>> fresnel_curve_loop = nullptr, transmission_curve_loop = nullptr;
  bool new_optics = true, new_wavelength = true;  ///< other than the channel's before
};

/// Out is what the caller gets, Real what is computed with.
template <class Out, class Real>
class SurfaceProgram final : public Program<Out> {
 public:
  SurfaceProgram(const Material& material, const CompileSettings& settings);

  [[nodiscard]] std::size_t channels() const noexcept override { return plans_.size(); }
  void run(const BasicPairBatch<Out>& pairs, std::span<Out> result) const override {
    run_blocks(PairSource<Real, Out>(pairs, fields_, set_), result);
  }
  void run(const BasicDirectionBatch<Out>& directions, std::span<Out> result) const override {
    run_blocks(DirectionSource<Real, Out>(directions, fields_, set_), result);
  }

 private:
  struct Workspace {
    FieldArrays<Real> fields;
    block::Terms<Real> terms;
    block::Geometry<Real> geometry;
    block::Array<Out> out;
  };

  void plan_channels();
  void plan_shared(const CompileSettings& settings);
  void plan_curves(double tolerance);
  void plan_loops();
  void add_fields();
  template <class Source>
  void run_blocks(const Source& source, std::span<Out> result) const;
  template <class Source>
  void run_shared(const Source& source, std::size_t first, std::size_t n, Workspace& w) const;
  template <class Source>
  void run_rough(const Source& source, std::size_t first, std::size_t n, Workspace& w) const;
  template <class Source>
  void run_shapes_by_pair(const Source& source, std::size_t first, std::size_t n, double wavelength_um,
                          Workspace& w) const;
  template <class Source>
  void run_visibility(const Source& source, std::size_t first, std::size_t n, Workspace& w) const;
  void run_optics(const ChannelPlan<Real>& plan, std::size_t n, Workspace& w) const;
  void run_wave(const ChannelPlan<Real>& plan, std::size_t n, Workspace& w) const;
  template <class Source>
  void run_channel(const Source& source, std::size_t channel, std::size_t first, std::size_t n, Workspace& w,
                   Out* out) const;
  template <class Source>
  void add_coherent(const Source& source, std::size_t channel, std::size_t first, std::size_t n, const Workspace& w,
                    Out* out) const;

  Evaluator scalar_;
  InstructionSet set_;
  ShapeSettings shape_;
  block::Fields fields_;
  std::vector<ChannelPlan<Real>> plans_;
  bool dd_ = false, fs_ = false, rough_ = false, coherent_ = false, wave_ = false, grows_ = false, by_pair_ = false;
  Real slope_{}, log_slope_{}, unit_shadowing_from_{}, tail_{};
  double log_sigma_ = 0.0;

  /// The shadowing and roughness terms as polynomials, where they are.
  struct SharedCurves {
    block::Polynomial<Real> lit, seen, growth;
    Real lit_reach, seen_reach;
    block::Loop<block::CurveArguments<Real>> loop;
  };
  std::optional<SharedCurves> curves_;
  block::Loop<block::VisibilityArguments<Real>> visibility_ = nullptr;
  block::Loop<block::LobeArguments<Real>> dd_loop_ = nullptr, fs_loop_ = nullptr;
  block::Loop<block::RoughArguments<Real>> rough_loop_ = nullptr;
  block::Loop<block::AddRoughArguments<Real, Out>> add_rough_ = nullptr;
  block::Loop<block::WaveLoopArguments<Real>> wave_arguments_ = nullptr, wave_lobe_ = nullptr;
  block::Loop<block::FresnelArguments<Real>> fresnel_ = nullptr, transmission_ = nullptr;
  std::vector<block::Loop<block::CombineArguments<Real, Out>>> combine_;  ///< one a channel
};

}  // namespace goniofit::batch
