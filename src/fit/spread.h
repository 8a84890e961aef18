#pragma once
// Covariances of parameters at a minimum, linearised, and by how many standard uncertainties intervals reach.
//
// With J the residuals' Jacobian and B Bᵀ = (JᵀJ)⁻¹ an estimate is off by -(JᵀJ)⁻¹ Jᵀ ε, ε the noise of the residuals:
//
//   V = (JᵀJ)⁻¹ Jᵀ diag(var ε) J (JᵀJ)⁻¹.
//
// readings   var ε from the readings' own standard uncertainties (GUM, JCGM 100). Intervals are the normal
//            distribution's.
// residuals  var ε from the noise that the residuals show (reading_noise.h), where they are no other than such noise;
//            else hc3. Intervals are Student's.
// hc3        HC3 (MacKinnon & White 1985): r_i² / (1 - h_i)² for var ε_i, h_i the leverage. V is then itself a random
//            sum, which a few bright readings may rule, and which they bias: intervals are those of the estimates over
//            it where the noise is relative and additive in the measure that the residuals show (studentised.h; the
//            idea is Bell & McCaffrey's, 2002).
// angles     Readings at one incidence angle share errors: clusters g, with scores s_g = Bᵀ J_gᵀ r_g and
//            G_g = Bᵀ J_gᵀ J_g B. CR3, the jackknife that leaves out whole clusters (Bell & McCaffrey 2002):
//            V = (n - 1)/n B [Σ_g t_g t_gᵀ] Bᵀ, t_g = (1 - G_g)⁻¹ s_g. Of five to eight clusters it is much too unsure
//            for any table: intervals are those of a wild cluster bootstrap of its studentised deviations with Webb's
//            six weights (Webb 2014; MacKinnon, Nielsen & Webb 2023), every refit one step of the linearised problem,
//            and no narrower than Student's t of n - 1. The same problem gives the same intervals.

#include <Eigen/Core>
#include <vector>

#include "cross_validation.h"
#include "joint_jacobian.h"
#include "unified_interval.h"

namespace goniofit {

/// Half-widths of intervals in standard uncertainties.
struct CoverageFactors {
  double at_68 = 1.0, at_95 = 1.959963984540054;
};

struct Spread {
  Eigen::MatrixXd covariance;
  std::vector<CoverageFactors> k;  ///< one a parameter
  /// Parameters that a single reading, or cluster, decides: nothing tells their uncertainty.
  std::vector<bool> single;
};

/// `meat` is the Meat of the residuals' standard deviations.
[[nodiscard]] Spread spread_by_meat(const JointJacobian& j, const Meat& meat);
[[nodiscard]] Spread spread_by_noise(const JointJacobian& j, const Meat& meat, double freedom);
/// Of readings that each determine a parameter by themselves, the parameters; the others' e = r / (1 - leverage), whose
/// Meat gives HC3's covariance, one vector a channel as `residuals`. `j` and all of these are of some rows.
struct LeftOut {
  std::vector<Eigen::VectorXd> e;
  std::vector<bool> single;
};
[[nodiscard]] LeftOut left_out_residuals(const JointJacobian& j, const std::vector<Eigen::VectorXd>& residuals);
/// At least two groups; j with all rows.
[[nodiscard]] Spread spread_by_angles(const JointJacobian& j, const std::vector<Eigen::VectorXd>& residuals,
                                      const AngleGroups& groups);

}  // namespace goniofit
