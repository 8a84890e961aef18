#pragma once
// A scan and settings made ready for fitting: which readings, which weights, which parameters are free within which
// bounds.

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../basis/basis.h"
#include "../basis/optics.h"
#include "../scan/scan.h"
#include "bounded_least_squares.h"
#include "settings.h"

namespace goniofit {

/// Readings left out, and why.
struct Exclusions {
  std::size_t at_90 = 0;  ///< theta of exactly 90 degrees
  std::size_t beyond_max_theta = 0;
  std::size_t negative_values = 0;  ///< kept; counted over the readings used
};

/// What is left free of the shape parameters: z_all = offset + map * z, z_all as in ShapeParameter.
struct ShapeMap {
  Eigen::VectorXd offset;
  Eigen::MatrixXd map;                           ///< shape parameters x free ones
  int free = 0;                                  ///< length of z
  std::vector<int> row;                          ///< the shape parameter that each z is
  std::vector<double> lower, upper;              ///< bounds of z
  std::vector<double> lower_value, upper_value;  ///< the same of the parameters themselves, as they were given

  [[nodiscard]] Eigen::VectorXd at(const double* z) const;
};

struct ProblemChannel {
  std::string name;
  std::optional<double> wavelength_um;
  ChannelOptics optics{};          ///< where fixed; the start where free
  std::optional<double> n, kappa;  ///< as given; empty where f0 was
  Eigen::VectorXd target;          ///< weight * value, one a reading used
  Eigen::VectorXd u;               ///< standard uncertainty of the values, 1/sr; empty where the scan states none
  /// A factor of each residual beside the weight that all channels share; empty for 1. A polish reads it, a search does
  /// not.
  Eigen::VectorXd emphasis;
  SmallVector lower, upper;                       ///< bounds of the coefficients; equal where fixed
  double optics_lower = 0.0, optics_upper = 0.0;  ///< of the free optical parameter
  std::size_t optics_group = 0;                   ///< channels of equal optics share their columns
};

/// Readings of anything, for a basis of the caller's own.
struct Readings {
  PairBatch pairs;                      ///< the abscissas, in whatever members of a pair the basis reads them from
  std::vector<Eigen::VectorXd> values;  ///< one a channel, each as long as `pairs`
  Eigen::VectorXd weight{};             ///< > 0, of each residual's square in the loss; empty for 1
};

class Problem {
 public:
  /// Throws Error (bad_input) where settings and scan contradict each other. The surface model's components have to be
  /// chosen: "auto" is fit()'s.
  Problem(const Scan& scan, const FitSettings& settings);
  /// For other data than BRDFs: decays, spectra, reference problems. No optics; of the settings, `parameters` counts.
  /// Throws Error (bad_input) where values or weights do not match the pairs.
  Problem(std::unique_ptr<const Basis> own_basis, Readings readings, const FitSettings& settings = {});

  /// Index of a shape parameter by name; nullopt where the model does not read it.
  [[nodiscard]] std::optional<std::size_t> shape_index(const std::string& name) const;
  [[nodiscard]] std::size_t samples() const noexcept { return pairs.size(); }
  [[nodiscard]] double wavelength(std::size_t channel) const noexcept {
    return channels[channel].wavelength_um.value_or(1.0);
  }
  /// Gives every channel its emphasis, and the problem the total that goes with it.
  void emphasise(std::vector<Eigen::VectorXd> emphasis);
  /// Optics with the free parameter at `value`; T is double or a dual number.
  template <class T>
  [[nodiscard]] BasicOptics<T> optics_at(std::size_t channel, const T& value) const {
    if (free_optics == FreeOptics::f0) return BasicOptics<T>::of_reflectance(value);
    return BasicOptics<T>::of_index(value, T(channels[channel].optics.kappa));
  }

  std::string model;
  EffectSet components;
  Terms terms;
  Forms forms;
  bool anisotropic;
  double solid_angle_sr;
  FreeOptics free_optics;
  Weight weighting;
  std::unique_ptr<const Basis> basis;  ///< the model, of which a fit knows no more than its columns
  ShapeMap shape;
  std::optional<double> known_sigma_um, known_tau_um;  ///< fixed by the user

  PairBatch pairs;
  std::vector<std::size_t> rows;  ///< of the scan, one a pair
  Eigen::VectorXd weight;         ///< square root of each reading's weight in the loss
  std::vector<ProblemChannel> channels;
  std::size_t optics_groups = 0;
  double total = 0.0;  ///< loss of a model that is zero

  UncertaintySource uncertainty = UncertaintySource::residuals;  ///< as asked for, or as the readings allow
  double scale_u = 0.0;  ///< relative standard uncertainty of the instrument's scale

  Exclusions exclusions;
  std::vector<std::string> notes, warnings;

 private:
  void choose_rows(const Scan& scan, const FitSettings& settings);
  void choose_optics(const Scan& scan, const FitSettings& settings);
  void choose_components(const FitSettings& settings);
  void choose_basis();
  void choose_shape(const FitSettings& settings);
  void choose_slope(const FitSettings& settings);
  void choose_sigma(const FitSettings& settings);
  void free_or_fix(const FitSettings& settings, std::size_t parameter);
  void add_free(std::size_t parameter, double low, double high);
  void fix(std::size_t parameter, double value);
  void choose_coefficients(const FitSettings& settings);
  void fill_targets(const Scan& scan);
  void choose_uncertainty(const Scan& scan, const FitSettings& settings);
  void add_target(ProblemChannel& channel, Eigen::VectorXd values);
};

}  // namespace goniofit
