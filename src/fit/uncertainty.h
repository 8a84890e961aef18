#pragma once
// Standard uncertainties of a fit's parameters and what their intervals need. What is stated comes from the readings'
// own uncertainties, from the residuals or from the incidence angles (spread.h says how), as the settings ask;
// automatically from the readings where all channels state theirs, else from the residuals.
//
// Beside it stand the two classical forms, for comparison with other fitters and for weights that are known:
//
//   s² (JᵀJ)⁻¹,  s² = Σ r_i² / (N - P)   right where all residuals have one variance, whatever it is;
//   (JᵀJ)⁻¹                              right where it is known to be 1: weights 1/u² of stated uncertainties u.
//
// Fitters differ in which of the two they print, and the factor s between them is easily overlooked. In the same way
// what the readings' uncertainties u_i give is stated unscaled, and scaled by the root of the reduced chi-square
// Σ (r_i / sd_i)² / (N - P), which says how far they explain the residuals.
//
// An error of the instrument's scale, of relative standard uncertainty u_s and common to all readings, moves the
// parameters together by g u_s, g = -(JᵀJ)⁻¹ Jᵀ dr/dln y: all covariances stated have g gᵀ u_s² added.
//
// Of a problem by parts all of these are sums over every reading. What the residuals' noise is, and how far intervals
// reach, is told from the readings drawn to stand for all (thinning.h).
//
// Parameters that are fixed or on a bound are left out; what is stated for the others holds with those where they are.
// For one on a bound there is instead what the linearised problem gives with all of them released: the unconstrained
// estimate, beyond the bound, and its standard uncertainty, from which follows a one-sided interval.

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "linear_parts.h"
#include "model.h"
#include "problem.h"
#include "spread.h"

namespace goniofit {

enum class ParameterState : std::uint8_t {
  free,  ///< has an uncertainty, unless the readings are too few for any
  fixed,
  at_lower,
  at_upper,
  undetermined  ///< the residuals do not depend on it, or only together with another
};

inline constexpr double no_uncertainty = std::numeric_limits<double>::quiet_NaN();

/// A parameter on a bound, released.
struct Released {
  double step = 0.0;  ///< to the unconstrained estimate
  double u = 0.0;
  CoverageFactors k{};
};

/// The standard uncertainties are NaN where there is none to state.
struct ParameterUncertainty {
  ParameterState state = ParameterState::free;
  double u = 0.0;                             ///< standard uncertainty
  std::ptrdiff_t index = -1;                  ///< row of the covariances
  double u_classical = no_uncertainty;        ///< from s² (JᵀJ)⁻¹
  double u_unscaled = no_uncertainty;         ///< from (JᵀJ)⁻¹
  double u_readings = no_uncertainty;         ///< from the readings' own, unscaled
  double u_readings_scaled = no_uncertainty;  ///< the same by the root of the reduced chi-square
  double u_scale = no_uncertainty;            ///< the part of u that is the instrument's scale; 0 for none
  CoverageFactors k{};                        ///< of intervals in units of u
  std::optional<Released> released{};         ///< of one on a bound
};

struct Uncertainties {
  std::vector<ParameterUncertainty> shape;                      ///< of z, a logarithm
  std::vector<std::vector<ParameterUncertainty>> coefficients;  ///< [channel][column]
  std::vector<ParameterUncertainty> optics;                     ///< [channel]; empty where fixed
  UncertaintySource source = UncertaintySource::residuals;
  // Of the free parameters, by index; empty where there is none to state.
  Eigen::MatrixXd covariance;                 ///< as stated
  Eigen::MatrixXd covariance_classical;       ///< s² (JᵀJ)⁻¹
  Eigen::MatrixXd covariance_unscaled;        ///< (JᵀJ)⁻¹; there too where the readings are too few for the others
  Eigen::MatrixXd covariance_readings;        ///< from the readings' own; empty where they state none
  Eigen::VectorXd by_scale;                   ///< g
  double residual_variance = no_uncertainty;  ///< s²
  double reduced_chi_square = no_uncertainty;  ///< of the readings by their own uncertainties
};

/// Sets what the readings' uncertainties give of a parameter, `u` without the scale's part, which has to be there.
void set_by_readings(ParameterUncertainty& p, double u, double reduced_chi_square);

[[nodiscard]] Uncertainties uncertainties(const LinearParts& parts, const LinearSums& sums);
/// Of a problem in one piece.
[[nodiscard]] Uncertainties uncertainties(const Problem& problem, const FitPoint& point, const Linearisation& l);

}  // namespace goniofit
