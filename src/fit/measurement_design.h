#pragma once
// Which further incidence angles would determine a fit's weak parameters best: the information that the model itself
// expects, at the fitted point.
//
// A candidate is a sweep of the detector through the plane of incidence to 85 degrees at one more theta_i, of as many
// readings as the scan has at one of its own (of a hemispherical scan its own directions of view, if these go beyond 75
// degrees), and the mirror direction where the scan has mirror directions. Each reading has
// the noise that the scan has at that value: its own u, else what estimate_noise() made of the residuals. With J the
// derivatives of the residuals as they are weighted in the loss, and s² their noise's variance, the fit's covariance
// will then be
//
//   (JᵀJ)⁻¹ [Jᵀ s² J] (JᵀJ)⁻¹,   JᵀJ and Jᵀ s² J the scan's plus the candidate's:
//
// what HC3 comes to where model and noise are right.

#include <optional>
#include <string>
#include <vector>

#include "../geometry/pair.h"
#include "../scan/scan.h"
#include "settings.h"

namespace goniofit {

struct FitResult;

/// One more scan, and what it would do for the weakest parameter (that of the largest uncertainty in its own size).
struct DesignOption {
  std::vector<double> theta_i_deg;  ///< one angle, or two
  double u = 0.0;                   ///< expected standard uncertainty of the parameter
};

struct MeasurementDesign {
  std::string name, channel;            ///< the weakest parameter; channel empty for a shared one
  std::optional<double> value;          ///< fitted; none where it is not determined
  double u = 0.0;                       ///< expected of the scan as it is; may be huge where nothing determines it
  std::vector<DesignOption> options{};  ///< the best single angle, then the best pair with it
  std::vector<DesignOption> singles{};  ///< every candidate angle
  bool worth_saying = false;  ///< the parameter is weak (beyond 10 %, or not identifiable), the gain 1.5 at least
};

/// theta_i from 5 to 85 degrees by 5.
[[nodiscard]] std::vector<double> candidate_angles();
/// The readings that a candidate stands for.
[[nodiscard]] std::vector<AnglePair> candidate_directions(const Scan& scan, double theta_i_deg);

/// Fills result.design: nothing where no parameter is open to improvement. `settings` are those of the fit. Apart from
/// fit(), because it costs about as much.
void add_measurement_design(FitResult& result, const Scan& scan, const FitSettings& settings);

/// "measuring at theta_i = 80° too would bring k_fs of R from ±28 % to about ±9 %".
[[nodiscard]] std::string design_sentence(const MeasurementDesign& design);

}  // namespace goniofit
