#pragma once
// Standard uncertainties. What a fit states of itself are those from the residuals, in the
// heteroscedasticity-consistent sandwich form HC3:
//
//   V = (JᵀJ)⁻¹ [Σ_i J_iᵀ J_i r_i² / (1 - h_i)²] (JᵀJ)⁻¹,   h_i = J_i (JᵀJ)⁻¹ J_iᵀ.
//
// Measured BRDFs have relative noise, so the plain s² (JᵀJ)⁻¹ understates what a bright lobe leaves open several times.
// Beside it stand the two classical forms, for comparison with other fitters and for weights that are known:
//
//   s² (JᵀJ)⁻¹,  s² = Σ r_i² / (N - P)   right where all residuals have one variance, whatever it is;
//   (JᵀJ)⁻¹                              right where it is known to be 1: weights 1/u² of stated uncertainties u.
//
// Fitters differ in which of the two they print, and the factor s between them is easily overlooked.
// Readings are taken as independent. Parameters that are fixed or on a bound are left out; what is stated for the
// others holds with those where they are, in all three forms.

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "model.h"
#include "problem.h"

namespace goniofit {

enum class ParameterState : std::uint8_t {
  free,  ///< has an uncertainty, unless the readings are too few for any
  fixed,
  at_lower,
  at_upper,
  undetermined  ///< the residuals do not depend on it, or only together with another
};

/// u, u_classical and u_unscaled are NaN where there is none to state.
struct ParameterUncertainty {
  ParameterState state = ParameterState::free;
  double u = 0.0;                                                 ///< standard uncertainty
  std::ptrdiff_t index = -1;                                      ///< row of the covariances
  double u_classical = std::numeric_limits<double>::quiet_NaN();  ///< from s² (JᵀJ)⁻¹
  double u_unscaled = std::numeric_limits<double>::quiet_NaN();   ///< from (JᵀJ)⁻¹
};

struct Uncertainties {
  std::vector<ParameterUncertainty> shape;                      ///< of z, a logarithm
  std::vector<std::vector<ParameterUncertainty>> coefficients;  ///< [channel][column]
  std::vector<ParameterUncertainty> optics;                     ///< [channel]; empty where fixed
  // Of the free parameters, by index; empty where there is none to state.
  Eigen::MatrixXd covariance;            ///< HC3
  Eigen::MatrixXd covariance_classical;  ///< s² (JᵀJ)⁻¹
  Eigen::MatrixXd covariance_unscaled;   ///< (JᵀJ)⁻¹; there too where the readings are too few for the others
  double residual_variance = std::numeric_limits<double>::quiet_NaN();  ///< s²
};

[[nodiscard]] Uncertainties uncertainties(const Problem& problem, const FitPoint& point, const Linearisation& l);

}  // namespace goniofit
