#include "fit/measurement_design.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "brdf/evaluator.h"
#include "fit/fit.h"
#include "fit/identifiability_analysis.h"
#include "fit/lobe_significance.h"
#include "fit/material_point.h"
#include "geometry/angles.h"
#include "scan/arrangement.h"
#include "support/error.h"

namespace goniofit {

namespace {

constexpr double weak = 0.1;
constexpr double worthwhile = 1.5;
constexpr double second_worthwhile = 1.3;
constexpr std::size_t fewest_readings = 10;
constexpr double sweep_deg = 85.0;
constexpr double wide_deg = 75.0;

// Rows of the scan's incidence angle that is nearest to `theta_i_deg`, of one azimuth.
Rows nearest_incidence(const Scan& scan, double theta_i_deg) {
  std::size_t nearest = 0;
  for (std::size_t row = 1; row < scan.size(); ++row) {
    const auto off = [&](std::size_t r) { return std::fabs(scan.theta_i_deg[r] - theta_i_deg); };
    if (off(row) < off(nearest)) nearest = row;
  }
  Rows rows;
  for (std::size_t row = 0; row < scan.size(); ++row) {
    const bool same = centidegrees(scan.theta_i_deg[row]) == centidegrees(scan.theta_i_deg[nearest]) &&
                      centidegrees(scan.phi_i_deg[row]) == centidegrees(scan.phi_i_deg[nearest]);
    if (same) rows.push_back(row);
  }
  return rows;
}

bool is_mirror(const AnglePair& a) { return from_mirror_deg(make_pair(a)) < 0.1; }

bool reads_mirrors(const Scan& scan) {
  for (std::size_t row = 0; row < scan.size(); ++row) {
    if (is_mirror(scan.angles(row))) return true;
  }
  return false;
}

// Readings of several incidence angles as the material gives them, each with its expected noise as the uncertainty.
struct Candidates {
  Scan scan;
  std::vector<std::size_t> first;  // row of each angle, and the end
};

Candidates candidates_for(const Scan& scan, const Material& material, const ReadingNoise& noise) {
  Candidates out;
  out.scan.source = scan.source;
  out.scan.solid_angle_sr = scan.solid_angle_sr;
  for (const double theta : candidate_angles()) {
    out.first.push_back(out.scan.size());
    for (const AnglePair& a : candidate_directions(scan, theta)) {
      out.scan.theta_i_deg.push_back(a.theta_i_deg);
      out.scan.phi_i_deg.push_back(a.phi_i_deg);
      out.scan.theta_r_deg.push_back(a.theta_r_deg);
      out.scan.phi_r_deg.push_back(a.phi_r_deg);
    }
  }
  out.first.push_back(out.scan.size());
  const Evaluator evaluator(material);
  for (std::size_t c = 0; c < scan.channels.size(); ++c) {
    ScanChannel channel = scan.channels[c];
    channel.values.clear();
    channel.u.clear();
    for (std::size_t row = 0; row < out.scan.size(); ++row) {
      channel.values.push_back(evaluator.value(make_pair(out.scan.angles(row)), c));
      channel.u.push_back(noise.model[c].sd(channel.values.back()));
    }
    out.scan.channels.push_back(std::move(channel));
  }
  return out;
}

// Jᵀ J and Jᵀ s² J of some readings, columns in the parameters' sizes.
struct Information {
  Eigen::MatrixXd bread, meat;

  explicit Information(Eigen::Index size)
      : bread(Eigen::MatrixXd::Zero(size, size)), meat(Eigen::MatrixXd::Zero(size, size)) {}
  Information& operator+=(const Information& other) {
    bread += other.bread;
    meat += other.meat;
    return *this;
  }
  friend Information operator+(Information a, const Information& b) { return a += b; }

  /// Standard uncertainties, in sizes.
  [[nodiscard]] Eigen::VectorXd uncertainties() const {
    // What no reading reads is open by far; a ridge of round-off's size says so in numbers.
    const Eigen::VectorXd scale = bread.diagonal().cwiseSqrt().cwiseMax(1e-150).cwiseInverse();
    Eigen::MatrixXd equilibrated = scale.asDiagonal() * bread * scale.asDiagonal();
    equilibrated.diagonal().array() += 1e-13;
    const Eigen::MatrixXd inverse =
        equilibrated.ldlt().solve(Eigen::MatrixXd(scale.asDiagonal() * meat * scale.asDiagonal()));
    const Eigen::MatrixXd covariance = equilibrated.ldlt().solve(inverse.transpose());
    return scale.cwiseProduct(covariance.diagonal().cwiseMax(0.0).cwiseSqrt());
  }
};

class Design {
 public:
  Design(const FitResult& result, const Scan& scan, const FitSettings& settings);
  [[nodiscard]] std::optional<MeasurementDesign> best() const;

 private:
  [[nodiscard]] bool is_open(const DesignColumn& column) const;
  [[nodiscard]] const FittedParameter& row_of(const DesignColumn& column) const;
  [[nodiscard]] Information information(const Linearisation& l, const ReadingNoise& noise, std::size_t from,
                                        std::size_t count) const;
  [[nodiscard]] DesignOption option(const std::vector<double>& angles, const Information& added,
                                    Eigen::Index worst) const;

  const FitResult& result_;
  Problem problem_;
  FitPoint point_;
  std::vector<DesignColumn> columns_;
  Information present_{0};
  std::vector<Information> added_;  // of each candidate angle
};

const FittedParameter& Design::row_of(const DesignColumn& column) const {
  return *std::find_if(result_.parameters.begin(), result_.parameters.end(),
                       [&](const FittedParameter& p) { return p.name == column.name && p.channel == column.channel; });
}

// Whether more readings could say more of it: not of what stands on its bound for good, nor of what there is no model
// of without a lobe.
bool Design::is_open(const DesignColumn& column) const {
  const FittedParameter& p = row_of(column);
  if (p.has(ParameterFlag::insignificant) || p.has(ParameterFlag::opaque)) return false;
  if (column.channel.empty() && !p.value) return false;
  return !column.on_bound || !p.identifiable;
}

FitSettings settings_as_fitted(FitSettings settings, const Material& material) {
  if (material.model == surface_model) settings.components = material.components;
  settings.terms = material.terms;
  if (material.terms.distribution != DistributionTier::student_t) settings.parameters.erase("tail");
  return settings;
}

Design::Design(const FitResult& result, const Scan& scan, const FitSettings& settings)
    : result_(result), problem_(scan, settings), point_(point_of(problem_, result.material)) {
  for (const DesignColumn& c : design_columns(problem_, point_)) {
    if (is_open(c)) columns_.push_back(c);
  }
  if (columns_.empty()) return;
  const Linearisation l = linearise(problem_, point_);
  const ReadingNoise noise = reading_noise(problem_, l);
  present_ = information(l, noise, 0, problem_.samples());
  const Candidates candidates = candidates_for(scan, result.material, noise);
  const Problem more(candidates.scan, settings);
  const Linearisation l_more = linearise(more, point_);
  const ReadingNoise noise_more = reading_noise(more, l_more);
  for (std::size_t a = 0; a + 1 < candidates.first.size(); ++a) {
    const auto at = [&](std::size_t row) { return std::lower_bound(more.rows.begin(), more.rows.end(), row); };
    const auto from = at(candidates.first[a]);
    const auto to = at(candidates.first[a + 1]);
    added_.push_back(information(l_more, noise_more, static_cast<std::size_t>(from - more.rows.begin()),
                                 static_cast<std::size_t>(to - from)));
  }
}

Information Design::information(const Linearisation& l, const ReadingNoise& noise, std::size_t from,
                                std::size_t count) const {
  Information out(static_cast<Eigen::Index>(columns_.size()));
  const auto first = static_cast<Eigen::Index>(from);
  const auto rows = static_cast<Eigen::Index>(count);
  for (std::size_t c = 0; c < problem_.channels.size(); ++c) {
    const Eigen::MatrixXd whitened = whitened_columns(l, noise, c).middleRows(first, rows);
    const Eigen::VectorXd sd = noise.whitener[c].segment(first, rows).cwiseInverse();
    std::vector<Eigen::Index> own;
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      const std::ptrdiff_t of = columns_[j].channel_index;
      if (of < 0 || of == static_cast<std::ptrdiff_t>(c)) own.push_back(static_cast<Eigen::Index>(j));
    }
    Eigen::MatrixXd jacobian(rows, static_cast<Eigen::Index>(own.size()));
    for (std::size_t j = 0; j < own.size(); ++j) {
      const DesignColumn& from_column = columns_[static_cast<std::size_t>(own[j])];
      jacobian.col(static_cast<Eigen::Index>(j)) = from_column.size * sd.cwiseProduct(whitened.col(from_column.column));
    }
    const Eigen::MatrixXd noisy = sd.asDiagonal() * jacobian;
    out.bread(own, own) += jacobian.transpose() * jacobian;
    out.meat(own, own) += noisy.transpose() * noisy;
  }
  return out;
}

DesignOption Design::option(const std::vector<double>& angles, const Information& added, Eigen::Index worst) const {
  const Eigen::VectorXd u = (present_ + added).uncertainties();
  return {angles, columns_[static_cast<std::size_t>(worst)].size * u[worst]};
}

std::optional<MeasurementDesign> Design::best() const {
  if (columns_.empty()) return std::nullopt;
  const Eigen::VectorXd now = present_.uncertainties();
  Eigen::Index worst = 0;
  now.maxCoeff(&worst);
  const DesignColumn& column = columns_[static_cast<std::size_t>(worst)];
  const FittedParameter& row = row_of(column);
  MeasurementDesign out{.name = column.name, .channel = column.channel, .value = row.value, .u = 0.0};
  // The row has the parameter itself, the column of a shape parameter its logarithm.
  const double unit = column.logarithm ? row.value.value_or(1.0) : 1.0;
  out.u = unit * column.size * now[worst];
  const std::vector<double> angles = candidate_angles();
  std::size_t first = 0;
  for (std::size_t a = 0; a < angles.size(); ++a) {
    out.singles.push_back(option({angles[a]}, added_[a], worst));
    out.singles.back().u *= unit;
    if (out.singles[a].u < out.singles[first].u) first = a;
  }
  DesignOption pair;
  for (std::size_t a = 0; a < angles.size(); ++a) {
    DesignOption trial = option({angles[first], angles[a]}, added_[first] + added_[a], worst);
    trial.u *= unit;
    if (a != first && (pair.theta_i_deg.empty() || trial.u < pair.u)) pair = std::move(trial);
  }
  out.options = {out.singles[first], pair};
  const bool is_weak = !row.identifiable || now[worst] > weak;
  const bool comes_to_something = out.options.front().u < unit * column.size;
  out.worth_saying = is_weak && comes_to_something && out.u > worthwhile * out.options.front().u;
  return out;
}

}  // namespace

std::vector<double> candidate_angles() {
  std::vector<double> angles;
  for (int theta = 5; theta <= 85; theta += 5) angles.push_back(theta);
  return angles;
}

std::vector<AnglePair> candidate_directions(const Scan& scan, double theta_i_deg) {
  std::vector<AnglePair> out;
  const Rows rows = nearest_incidence(scan, theta_i_deg);
  const bool out_of_plane =
      std::any_of(rows.begin(), rows.end(), [&](std::size_t r) { return scan.plane_side(r) == 0; });
  const bool wide =
      std::any_of(rows.begin(), rows.end(), [&](std::size_t r) { return scan.theta_r_deg[r] > wide_deg; });
  const bool hemisphere = out_of_plane && wide;
  if (hemisphere) {
    for (const std::size_t row : rows) {
      const AnglePair own = scan.angles(row);
      if (!is_mirror(own)) out.push_back({theta_i_deg, own.phi_i_deg, own.theta_r_deg, own.phi_r_deg});
    }
  } else {
    const std::size_t count = std::max(rows.size(), fewest_readings);
    for (std::size_t i = 0; i < count; ++i) {
      const double t = static_cast<double>(i) / static_cast<double>(count - 1);
      out.push_back(in_plane(theta_i_deg, sweep_deg * (2.0 * t - 1.0)));
    }
  }
  if (reads_mirrors(scan)) {
    const double phi = hemisphere ? scan.phi_i_deg[rows.front()] : 0.0;
    out.push_back({theta_i_deg, phi, theta_i_deg, phi + 180.0});
  }
  return out;
}

void add_measurement_design(FitResult& result, const Scan& scan, const FitSettings& settings) {
  // A peer of which a parameter is open has no model to expect anything from.
  for (const auto& [name, value] : result.material.parameters) {
    if (!value) return;
  }
  try {
    result.design = Design(result, scan, settings_as_fitted(settings, result.material)).best();
  } catch (const Error&) {
    // Settings of a parameter that the material no longer has: there is nothing to plan for.
  }
}

std::string design_sentence(const MeasurementDesign& d) {
  const bool relative = d.value && std::fabs(*d.value) > 0.5 * d.options.front().u;
  const auto size = [&](double u) {
    if (!relative) return fmt::format("±{:.2g}", u);
    const double percent = 100.0 * u / std::fabs(*d.value);
    return percent > 1000.0 ? std::string("unknown") : fmt::format("±{:.2g} %", percent);
  };
  const DesignOption& one = d.options.front();
  std::string text =
      fmt::format("measuring at theta_i = {:g}° too would bring {}{} from {} to about {}", one.theta_i_deg.front(),
                  d.name, d.channel.empty() ? "" : " of " + d.channel, d.u > 1e3 ? "unknown" : size(d.u), size(one.u));
  const DesignOption& two = d.options.back();
  if (two.theta_i_deg.size() == 2 && one.u > second_worthwhile * two.u) {
    text += fmt::format("; at {:g}° as well, to about {}", two.theta_i_deg.back(), size(two.u));
  }
  return text;
}

}  // namespace goniofit
