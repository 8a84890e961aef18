#pragma once
// Standard uncertainties from the residuals, in the heteroscedasticity-consistent sandwich form HC3:
//
//   V = (JᵀJ)⁻¹ [Σ_i J_iᵀ J_i r_i² / (1 - h_i)²] (JᵀJ)⁻¹,   h_i = J_i (JᵀJ)⁻¹ J_iᵀ.
//
// Measured BRDFs have relative noise, so the plain (JᵀJ)⁻¹ s² understates what a bright lobe leaves open several times.
// Readings are taken as independent. Parameters that are fixed or on a bound are left out; what is stated for the
// others holds with those where they are.

#include <Eigen/Core>
#include <cstddef>
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

struct ParameterUncertainty {
  ParameterState state = ParameterState::free;
  double u = 0.0;             ///< standard uncertainty; NaN where there is none to state
  std::ptrdiff_t index = -1;  ///< row of `covariance`
};

struct Uncertainties {
  std::vector<ParameterUncertainty> shape;                      ///< of z, a logarithm
  std::vector<std::vector<ParameterUncertainty>> coefficients;  ///< [channel][column]
  std::vector<ParameterUncertainty> optics;                     ///< [channel]; empty where fixed
  Eigen::MatrixXd covariance;                                   ///< of the free ones, by index
};

[[nodiscard]] Uncertainties uncertainties(const Problem& problem, const FitPoint& point, const Linearisation& l);

}  // namespace goniofit
