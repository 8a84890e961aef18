#pragma once
// The vectorised loops over a block: each returns the function for a tier and an instruction set. Isotropic surfaces
// only; what has no loop here is evaluated pair by pair (batch_evaluator.cpp).

#include <optional>
#include <string_view>
#include <vector>

#include "../basis/optics.h"
#include "../support/instruction_set.h"
#include "block.h"
#include "surface_shape.h"

namespace goniofit::block {

template <class Arguments>
using Loop = void (*)(const Arguments&);

/// A shape factor no longer a number of its type is infinite, and infinity times an F of 0 is none.
template <class Real>
inline constexpr Real most_shape = std::is_same_v<Real, float> ? Real(1e32) : Real(1e302);

/// shadowing, growth and inverse_m_e2, each where the tiers have something to say of it.
template <class Real>
struct VisibilityArguments {
  Geometry<Real> g;
  Terms<Real>* t;
  std::size_t n;
  Real slope;
  Real inverse_slope;
  Real log_slope;
  Real unit_shadowing_from;  ///< cosine from which on S1 counts as 1; above 1 for none
};
/// `shadowed` false: nothing reads S.
template <class Real>
[[nodiscard]] Loop<VisibilityArguments<Real>> visibility(bool shadowed, ShadowingTier, EffectiveRoughnessTier,
                                                         InstructionSet);
[[nodiscard]] Fields fields_of(bool shadowed, ShadowingTier, EffectiveRoughnessTier);

/// d ln S and d growth by ln slope, beside all that the loop above computes. Tiers li-torrance and none only.
struct Rates {
  alignas(64) Array<double> shadowing;
  alignas(64) Array<double> growth;
};
struct VisibilityRateArguments {
  VisibilityArguments<double> values;  ///< unit_shadowing_from is not read
  Rates* rates;
};
[[nodiscard]] Loop<VisibilityRateArguments> visibility_rates(bool shadowed, ShadowingTier, EffectiveRoughnessTier,
                                                             InstructionSet);

/// A polynomial of a cosine, or of what a term is a smooth function of, in t = scale x + offset.
inline constexpr std::size_t most_coefficients = 44;
template <class Real>
struct Polynomial {
  Real scale{}, offset{};
  std::array<Real, most_coefficients> c{};
};

/// The same results for one material from polynomials of the cosines: S1(c)/c, and of tier li-torrance
/// (1 - (1-c)^(1.6 q))/c, of tier he c K(c) and growth as a function of ln(1 + eK²/8π). Beyond `reach` S1 is 1 and
/// sigma_e is sigma.
template <class Real>
struct CurveArguments {
  Geometry<Real> g;
  Terms<Real>* t;
  std::size_t n;
  const Polynomial<Real>* lit;
  const Polynomial<Real>* seen;
  const Polynomial<Real>* growth;
  Real lit_reach, seen_reach;
  Real inverse_slope, log_slope;
};
/// For polynomials of `coefficients` coefficients (the largest number of them), at most most_coefficients.
template <class Real>
[[nodiscard]] Loop<CurveArguments<Real>> curves(bool shadowed, EffectiveRoughnessTier, std::size_t coefficients,
                                                InstructionSet);

/// dd of tiers rough-limit and student-t, and fs, from the above.
template <class Real>
struct LobeArguments {
  Geometry<Real> g;
  Terms<Real>* t;
  std::size_t n;
  Real log_slope;
  Real inverse_m2;  ///< (tau/sigma)²: stands for inverse_m_e2 where the effective roughness is sigma
  Real tail;
};
template <class Real>
[[nodiscard]] Loop<LobeArguments<Real>> directional_diffuse(DistributionTier, bool grows, InstructionSet);
template <class Real>
[[nodiscard]] Loop<LobeArguments<Real>> forward_scattering(FsForm, bool grows, InstructionSet);

/// Their derivatives by ln slope, of tier rough-limit, from their values.
struct LobeRateArguments {
  LobeArguments<double> values;
  const Rates* rates;
  double* rate;  ///< whole vectors are written
};
[[nodiscard]] Loop<LobeRateArguments> directional_diffuse_rate(bool grows, InstructionSet);
[[nodiscard]] Loop<LobeRateArguments> forward_scattering_rate(FsForm, bool grows, InstructionSet);

/// direct and interreflection of rough, the former cut at zero. Null for the integral, which has no loop.
template <class Real>
struct RoughArguments {
  Geometry<Real> g;
  Terms<Real>* t;
  std::size_t n;
  Real facet_slope;  ///< radians
};
template <class Real>
[[nodiscard]] Loop<RoughArguments<Real>> rough(RoughForm, InstructionSet);
[[nodiscard]] Fields rough_fields(RoughForm);
/// Adds rho/pi (direct + rho interreflection) to a channel.
template <class Real, class Out>
struct AddRoughArguments {
  Geometry<Real> g;
  const Terms<Real>* t;
  std::size_t n;
  Real rho, most;
  Out* out;
};
template <class Real, class Out>
[[nodiscard]] Loop<AddRoughArguments<Real, Out>> add_rough(InstructionSet);

/// What W reads of a pair, log_g and x; and dd from log_w.
template <class Real>
struct WaveLoopArguments {
  Geometry<Real> g;
  Terms<Real>* t;
  std::size_t n;
  Real log_slope;
  Real log_phase;  ///< ln(2 pi sigma / lambda)
  Real x_scale;    ///< (pi tau / lambda)²
};
template <class Real>
[[nodiscard]] Loop<WaveLoopArguments<Real>> wave_arguments_loop(bool grows, InstructionSet);
template <class Real>
[[nodiscard]] Loop<WaveLoopArguments<Real>> wave_lobe(bool grows, InstructionSet);

/// Exact Fresnel: F(u), or T(cos_i) T(cos_r).
template <class Real>
struct FresnelArguments {
  Geometry<Real> g;
  Terms<Real>* t;
  std::size_t n;
  Real index, kappa;
};
template <class Real>
[[nodiscard]] Loop<FresnelArguments<Real>> exact_fresnel(InstructionSet);
template <class Real>
[[nodiscard]] Loop<FresnelArguments<Real>> exact_transmission(InstructionSet);
/// The same from polynomials of F(u) and of T(c)/c.
template <class Real>
struct FresnelCurveArguments {
  Geometry<Real> g;
  Terms<Real>* t;
  std::size_t n;
  const Polynomial<Real>* curve;
};
template <class Real>
[[nodiscard]] Loop<FresnelCurveArguments<Real>> fresnel_curve(std::size_t coefficients, InstructionSet);
template <class Real>
[[nodiscard]] Loop<FresnelCurveArguments<Real>> transmission_curve(std::size_t coefficients, InstructionSet);

/// The lobe of a peer model of one lobe and one shape parameter, z as its ShapeParameter says; nullopt for other
/// models.
template <class Real>
struct PeerArguments {
  Geometry<Real> g;
  Terms<Real>* t;  ///< dd is written
  std::size_t n;
  Real z;
};
[[nodiscard]] std::optional<Fields> peer_fields(std::string_view model);
template <class Real>
[[nodiscard]] Loop<PeerArguments<Real>> peer_lobe(std::string_view model, InstructionSet);

/// One channel: (mirror_0 + mirror_1 p) dd + (below_0 + below_1 fs) t + diffuse, where p and t are what the Fresnel
/// tier has at hand: (1-u)⁵ and the product of 1 - (1-c)⁵ for schlick, F(u) and T T for exact, nothing for none.
enum class Use : std::uint8_t { absent, constant, schlick, array };
template <class Real, class Out>
struct CombineArguments {
  Geometry<Real> g;
  const Terms<Real>* t;
  std::size_t n;
  Real mirror_0, mirror_1, below_0, below_1, diffuse, most;
  Out* out;
};
template <class Real, class Out>
[[nodiscard]] Loop<CombineArguments<Real, Out>> combine(Use mirror, Use below, bool fs, InstructionSet);

/// Geometry from unit vectors: the fields asked for, and some that come with them, computed in In and rounded to Real.
/// What belongs to single azimuths is not among them.
template <class Real, class In>
struct PrepareArguments {
  std::array<const In*, 6> direction;  ///< l_x, l_y, l_z, v_x, v_y, v_z
  std::array<Real*, field_count> field;
  std::size_t n;

  [[nodiscard]] [[gnu::always_inline]] Real* operator[](Field f) const noexcept {
    return field[static_cast<std::size_t>(f)];
  }
};
template <class Real, class In>
[[nodiscard]] std::vector<Loop<PrepareArguments<Real, In>>> preparations(Fields, InstructionSet);

}  // namespace goniofit::block
