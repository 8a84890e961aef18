#pragma once
// A scan and settings made ready for fitting: which readings, which weights, which parameters are free within which
// bounds.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../basis/basis.h"
#include "../basis/optics.h"
#include "../scan/scan.h"
#include "bounded_least_squares.h"
#include "exclusions.h"
#include "loss.h"
#include "settings.h"

namespace goniofit {

/// Residuals that are sums over points of evaluation follow those that are a point each.
class RowSums {
 public:
  explicit RowSums(std::size_t single = 0) : single_(single) {}
  void add(std::size_t points) { ends_.push_back((ends_.empty() ? single_ : ends_.back()) + points); }
  [[nodiscard]] std::size_t rows() const noexcept { return single_ + ends_.size(); }
  [[nodiscard]] bool none() const noexcept { return ends_.empty(); }
  /// Of one row.
  [[nodiscard]] std::size_t points(std::size_t row) const noexcept {
    if (row < single_) return 1;
    return ends_[row - single_] - (row == single_ ? single_ : ends_[row - single_ - 1]);
  }
  /// A row a point becomes a row a residual.
  void apply(Eigen::MatrixXd& m) const;
  void apply(Eigen::VectorXd& v) const;

 private:
  std::size_t single_;
  std::vector<std::size_t> ends_;
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

/// What is said of a channel apart from its readings.
struct ChannelTerms {
  std::string name{};
  std::optional<double> wavelength_um{};
  ChannelOptics optics{};                         ///< where fixed; the start where free
  std::optional<double> n{}, kappa{};             ///< as given; empty where f0 was
  SmallVector lower{}, upper{};                   ///< bounds of the coefficients; equal where fixed
  double optics_lower = 0.0, optics_upper = 0.0;  ///< of the free optical parameter
  std::size_t optics_group = 0;                   ///< channels of equal optics share their columns
};

struct ProblemChannel : ChannelTerms {
  // One a residual: first the readings used, then the reflectances over pi.
  Eigen::VectorXd value;     ///< 1/sr
  Eigen::VectorXd target;    ///< weight * value; of a problem by parts only the parts have it
  Eigen::VectorXd u;         ///< standard uncertainty of the values, 1/sr; empty where not all of them have one
  Eigen::VectorXd used;      ///< 0 where the value is left out, else 1; empty where all are used
  Eigen::VectorXd emphasis;  ///< a factor of each residual beside the weight that all channels share; empty for 1
};

/// Readings of anything, for a basis of the caller's own.
struct Readings {
  PairBatch pairs;                      ///< the abscissas, in whatever members of a pair the basis reads them from
  std::vector<Eigen::VectorXd> values;  ///< one a channel, each as long as `pairs`
  Eigen::VectorXd weight{};             ///< > 0, of each residual's square in the loss; empty for 1
};

/// Some readings that stand for all: see thinning.h.
struct RowSelection {
  std::vector<std::size_t> rows{};  ///< ascending
  std::vector<double> factor{};     ///< of each one's residual: the square root of the readings that it stands for

  [[nodiscard]] bool all() const noexcept { return rows.empty(); }
};

/// What is said of a problem apart from its readings.
struct ProblemTerms {
  std::string model = std::string(surface_model);
  EffectSet components{};
  Terms terms{};
  Forms forms{};
  bool anisotropic = false;
  double solid_angle_sr = default_solid_angle_sr;
  FreeOptics free_optics = FreeOptics::none;
  Weight weighting = Weight::none;
  Loss loss = Loss::cosine_l2;
  std::optional<RobustLoss> robust{};
  ShapeMap shape{};
  std::optional<double> known_sigma_um{}, known_tau_um{};  ///< fixed by the user
  std::size_t optics_groups = 0;
  double total = 0.0;  ///< loss of a model that is zero; of a part, that of the whole
  UncertaintySource uncertainty = UncertaintySource::residuals;  ///< as asked for, or as the readings allow
  double scale_u = 0.0;  ///< relative standard uncertainty of the instrument's scale
};

class Problem : public ProblemTerms {
 public:
  /// Whether scans of very many readings may be fitted part by part: no more of them than their angles, weights and
  /// values is held then, and what reads `pairs` and `target` asks the parts.
  enum class Hold : std::uint8_t { whole, parts };
  /// Throws Error (bad_input) where settings and scan contradict each other. The surface model's components have to be
  /// chosen: "auto" is fit()'s. By parts are scans of more than most_held readings whose residuals are a reading each,
  /// under a quadratic loss, where geometry is cheap to compute again.
  Problem(const Scan& scan, const FitSettings& settings, Hold hold = Hold::whole);
  /// For other data than BRDFs: decays, spectra, reference problems. No optics; of the settings, `parameters` counts.
  /// Throws Error (bad_input) where values or weights do not match the pairs.
  Problem(std::unique_ptr<const Basis> own_basis, Readings readings, const FitSettings& settings = {});

  /// Whether pairs and targets are those of the parts alone.
  [[nodiscard]] bool by_parts() const noexcept { return !angles_.empty(); }
  /// Those readings of a problem by parts as a problem of their own, in one piece.
  [[nodiscard]] Problem part(const std::vector<std::size_t>& of_readings) const;
  /// f(part) for one run of readings after the other; of a problem in one piece f(*this).
  template <class F>
  void for_each_part(const F& f) const {
    if (!by_parts()) return f(*this);
    for (std::size_t first = 0; first < readings(); first += part_size) f(run(first));
  }
  /// f(pairs) of the readings, run after run, without the rest of a part.
  template <class F>
  void for_each_pairs(const F& f) const {
    if (!by_parts()) return f(pairs);
    for (std::size_t first = 0; first < readings(); first += part_size) f(pairs_of_run(first));
  }

  /// Index of a shape parameter by name; nullopt where the model does not read it.
  [[nodiscard]] std::optional<std::size_t> shape_index(const std::string& name) const;
  /// Residuals of a channel.
  [[nodiscard]] std::size_t samples() const noexcept { return sums.rows(); }
  /// Those that are readings of the BRDF; the others are reflectances.
  [[nodiscard]] std::size_t readings() const noexcept { return rows.size(); }
  /// Values that the fit reads, over all channels.
  [[nodiscard]] std::size_t values_used() const noexcept;
  [[nodiscard]] double wavelength(std::size_t channel) const noexcept {
    return channels[channel].wavelength_um.value_or(1.0);
  }
  /// Gives every channel its emphasis in place of what the loss gave it, and the problem the total that goes with it:
  /// squares of weighted differences. Values left out stay so.
  void emphasise(std::vector<Eigen::VectorXd> emphasis);
  /// From now on the loss is that of a robust kernel.
  void make_robust(const RobustLoss& by) { robust = by; }
  /// Whether the coefficients' normal equations alone do not give the least loss.
  [[nodiscard]] bool quadratic() const noexcept { return !is_transformed(loss) && !robust; }
  /// Optics with the free parameter at `value`; T is double or a dual number.
  template <class T>
  [[nodiscard]] BasicOptics<T> optics_at(std::size_t channel, const T& value) const {
    if (free_optics == FreeOptics::f0) return BasicOptics<T>::of_reflectance(value);
    return BasicOptics<T>::of_index(value, T(channels[channel].optics.kappa));
  }

  std::unique_ptr<const Basis> basis;  ///< the model, of which a fit knows no more than its columns

  PairBatch pairs;                ///< points of evaluation: the readings, then the nodes of the reflectances
  std::vector<std::size_t> rows;  ///< of the scan, one a reading
  RowSums sums;
  Eigen::VectorXd weight;           ///< square root of each residual's weight in the loss
  Eigen::VectorXd point_weight;     ///< the same by point; a node's includes its part of the sum, over pi
  std::vector<double> theta_i_deg;  ///< one a residual; of a problem by parts only the parts have them
  std::vector<ProblemChannel> channels;
  RowSelection drawn;  ///< of a problem by parts: readings that stand for all of them

  Exclusions exclusions;
  std::vector<std::string> notes, warnings;

 private:
  /// A multiple of what JointJacobian triangulates at once, and little enough for the second-level cache.
  static constexpr std::size_t part_size = 2048;

  explicit Problem(const ProblemTerms& of) : ProblemTerms(of) {}
  [[nodiscard]] Problem run(std::size_t first) const;
  [[nodiscard]] PairBatch pairs_of_run(std::size_t first) const;
  void make_basis();
  void choose_rows(const Scan& scan, const FitSettings& settings, bool may_part);
  void add_reflectances(const FitSettings& settings);
  void choose_weights(const Scan& scan);
  void weigh_reflectances(const Scan& scan);
  void leave_out_values(const ExclusionSettings& exclude);
  void choose_emphasis();
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
  void fill_values(const Scan& scan, const FitSettings& settings);
  void fill_targets();
  void choose_uncertainty(const Scan& scan, const FitSettings& settings);

  std::vector<AnglePair> angles_;  ///< of a problem by parts
};

/// Readings from which on a fit goes by parts.
inline constexpr std::size_t most_held = 100000;

/// The residual of a row of which the model says f, under a loss that is not quadratic: see Model::residuals.
struct BentResidual {
  double residual;  ///< weight * emphasis * (g(f) - g(value)), times sqrt(rho')
  double slope;     ///< its derivative by f
  double loss;
  RobustLoss::Value kernel;
};
[[nodiscard]] BentResidual bent_residual(const Problem& problem, const ProblemChannel& channel, Eigen::Index row,
                                         double f);

}  // namespace goniofit
