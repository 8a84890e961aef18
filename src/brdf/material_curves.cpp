#include "brdf/material_curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brdf/block_loops.h"

namespace goniofit::batch {

namespace {

// Cosines start here: the quotients by c are continuous at 0, and no digit of theirs is lost yet.
constexpr double least_c = 1e-8;
constexpr double greatest_depth = 1000.0;

using Function = std::function<double(double)>;

std::optional<FittedPolynomial> fit(const Function& f, double upper, double tolerance, ErrorMeasure measure,
                                    PolynomialArithmetic arithmetic) {
  return fit_polynomial(f, least_c, upper, tolerance, measure, block::most_coefficients, arithmetic);
}

// The cosine from which on erfc a < tolerance: cot theta = 2 m a.
double smith_reach(double slope, double tolerance) {
  double a = 1.0;
  while (std::erfc(a) > 0.5 * tolerance) a += 0.05;
  const double cot = 2.0 * slope * a;
  return cot / std::sqrt(1.0 + cot * cot);
}

// Beyond, (1-c)^power is less than the tolerance.
double power_reach(double power, double tolerance) {
  return std::min(-std::expm1(std::log(0.5 * tolerance) / power), 1.0 - 1e-12);
}

struct Reached {
  FittedPolynomial curve;
  double reach;
};

std::optional<Reached> lit_curve(const ShapeSettings& s, double slope, double tail, double tolerance,
                                 PolynomialArithmetic arithmetic) {
  Function f;
  double reach = 1.0 - 1e-12;
  if (s.shadowing == ShadowingTier::li_torrance) {
    reach = power_reach(1.0 / slope, tolerance);
    f = [slope](double c) { return -std::expm1(std::log1p(-c) / slope) / c; };
  } else if (s.shadowing == ShadowingTier::smith && s.distribution != DistributionTier::student_t) {
    reach = smith_reach(slope, tolerance);
    f = [slope](double c) { return shadowing_smith_over_cosine(slope, c, sine(c, 1.0 - c)); };
  } else if (s.shadowing == ShadowingTier::smith) {
    f = [slope, tail](double c) { return shadowing_student_t_over_cosine(slope, tail, c, sine(c, 1.0 - c)); };
  } else if (s.shadowing == ShadowingTier::schlick) {
    f = [slope](double c) { return shadowing_schlick_over_cosine(slope, c); };
  } else {
    // S1 = 1 at every cosine that there is.
    const double least = std::ldexp(1.0, arithmetic == PolynomialArithmetic::binary32 ? -60 : -200);
    return Reached{{1.0, 0.0, {1.0 / least}, 0.0}, least};
  }
  std::optional<FittedPolynomial> p = fit(f, reach, tolerance, ErrorMeasure::relative, arithmetic);
  if (!p) return std::nullopt;
  return Reached{std::move(*p), reach};
}

std::optional<Reached> seen_curve(EffectiveRoughnessTier tier, double slope, double tolerance,
                                  PolynomialArithmetic arithmetic) {
  if (tier == EffectiveRoughnessTier::li_torrance) {
    // growth is its logarithm times q/5.
    const double power = 1.6 / slope;
    const double enough = std::min(0.1, 2.5 * tolerance * slope);
    const double reach = power_reach(power, enough);
    const Function f = [power](double c) { return -std::expm1(power * std::log1p(-c)) / c; };
    std::optional<FittedPolynomial> p = fit(f, reach, enough, ErrorMeasure::relative, arithmetic);
    if (p) return Reached{std::move(*p), reach};
    return std::nullopt;
  }
  const double reach = smith_reach(slope, tolerance);
  const Function f = [slope](double c) { return c * he_hidden_depth(slope, c, sine(c, 1.0 - c)); };
  std::optional<FittedPolynomial> p = fit(f, reach, tolerance, ErrorMeasure::absolute, arithmetic);
  if (!p) return std::nullopt;
  return Reached{std::move(*p), reach};
}

// ln(1 + W0(K²/8π)) of ln(1 + e K²/8π).
std::optional<FittedPolynomial> growth_curve(double tolerance, PolynomialArithmetic arithmetic) {
  constexpr double e = std::numbers::e;
  const double most = std::log1p(e * greatest_depth * greatest_depth / (8.0 * std::numbers::pi));
  return fit_polynomial([](double t) { return std::log1p(lambert_w0(std::expm1(t) / e)); }, 0.0, most, tolerance,
                        ErrorMeasure::absolute, block::most_coefficients, arithmetic);
}

}  // namespace

std::size_t VisibilityCurves::coefficients() const noexcept {
  return std::max({lit.c.size(), seen.c.size(), growth.c.size()});
}

std::optional<VisibilityCurves> visibility_curves(const ShapeSettings& s, bool shadowed, double slope, double tail,
                                                  double tolerance, PolynomialArithmetic arithmetic) {
  using enum EffectiveRoughnessTier;
  const bool closed = s.shadowing == ShadowingTier::none || s.shadowing == ShadowingTier::schlick;
  if (s.anisotropic || (s.effective_roughness == none && (closed || !shadowed))) return std::nullopt;
  VisibilityCurves curves;
  if (shadowed) {
    std::optional<Reached> lit = lit_curve(s, slope, tail, tolerance, arithmetic);
    if (!lit) return std::nullopt;
    curves.lit = std::move(lit->curve);
    curves.lit_reach = lit->reach;
  }
  if (s.effective_roughness != none) {
    std::optional<Reached> seen = seen_curve(s.effective_roughness, slope, tolerance, arithmetic);
    if (!seen) return std::nullopt;
    curves.seen = std::move(seen->curve);
    curves.seen_reach = seen->reach;
  }
  if (s.effective_roughness == he) {
    std::optional<FittedPolynomial> growth = growth_curve(tolerance, arithmetic);
    if (!growth) return std::nullopt;
    curves.growth = std::move(*growth);
  }
  return curves;
}

std::optional<FittedPolynomial> reflection_curve(double n, double kappa, double tolerance,
                                                 PolynomialArithmetic arithmetic) {
  return fit_polynomial([=](double u) { return fresnel_exact(n, kappa, u, 1.0 - u); }, 0.0, 1.0, tolerance,
                        ErrorMeasure::relative, block::most_coefficients, arithmetic);
}

std::optional<FittedPolynomial> transmission_curve(double n, double kappa, double tolerance,
                                                   PolynomialArithmetic arithmetic) {
  return fit([=](double c) { return transmission_exact(n, kappa, c, 1.0 - c) / c; }, 1.0, tolerance,
             ErrorMeasure::relative, arithmetic);
}

}  // namespace goniofit::batch
