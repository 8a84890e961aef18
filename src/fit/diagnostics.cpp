#include "fit/diagnostics.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "brdf/evaluator.h"
#include "brdf/surface_shape.h"
#include "fit/fit_spread.h"
#include "fit/loss.h"
#include "fit/noise_model.h"
#include "fit/order_statistics.h"
#include "fit/verdict.h"
#include "geometry/angles.h"
#include "scan/arrangement.h"

namespace goniofit {

namespace {

constexpr double near_deg = 10.0;  // of the mirror and the retro direction
constexpr double grazing_deg = 70.0;
constexpr double outlier_sds = 6.0;
constexpr std::size_t most_outliers = 10;
constexpr double floor_sds = 3.0;
constexpr double open_sds = 3.0;

// Sums that a misfit is made of.
struct Sums {
  double r2 = 0.0, f2 = 0.0, r = 0.0, f = 0.0, signed_r2 = 0.0;

  void add(double weight, double value, double residual) {
    r2 += weight * residual * residual;
    signed_r2 += weight * residual * std::fabs(residual);
    f2 += weight * value * value;
    r += weight * std::fabs(residual);
    f += weight * std::fabs(value);
  }
  void add(const Sums& other) {
    r2 += other.r2, f2 += other.f2, r += other.r, f += other.f, signed_r2 += other.signed_r2;
  }
  /// `parts`: |r| / max(|f|, |model|) above the noise.
  [[nodiscard]] Misfit misfit(std::vector<double>& parts) const {
    return {f2 > 0.0 ? std::sqrt(r2 / f2) : 0.0, f > 0.0 ? r / f : 0.0, typical(parts)};
  }
  [[nodiscard]] static std::optional<double> typical(std::vector<double>& parts) {
    return parts.empty() ? std::nullopt : std::optional(median_of(parts));
  }
};

double quotient(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

// Whether directions are as near as near_deg, by their squared chord: the angle itself takes an arcsine, and is asked
// for on the edge alone.
bool is_near(double chord2, double (*angle_deg)(const Pair&), const Pair& pair) {
  static const double edge = std::pow(2.0 * sin_deg(0.5 * near_deg), 2);
  if (std::fabs(chord2 - edge) > 1e-9 * edge) return chord2 < edge;
  return angle_deg(pair) <= near_deg;
}

Region region_of(const Scan& scan, std::size_t row, const Pair& pair) {
  if (is_near(pair.mirror_distance2, from_mirror_deg, pair)) return Region::mirror;
  if (is_near(4.0 * pair.one_minus_cos_h * (1.0 + pair.cos_h), from_retro_deg, pair)) return Region::retro;
  return scan.theta_r_deg[row] > grazing_deg && pair.forward ? Region::forward_grazing : Region::elsewhere;
}

std::vector<AnglePair> angles_of(const Scan& scan, std::span<const std::size_t> rows) {
  std::vector<AnglePair> out;
  out.reserve(rows.size());
  for (const std::size_t row : rows) out.push_back(scan.angles(row));
  return out;
}

class Diagnosis {
 public:
  Diagnosis(const Scan& scan, const Material& material, DiagnosticsOptions options)
      : scan_(scan), material_(material), options_(std::move(options)) {
    choose_rows();
    if (!options_.values) evaluate();
    for (std::vector<double>& channel : options_.values->open) {
      for (double& u : channel) u *= open_sds;
    }
    place_readings();
  }
  [[nodiscard]] FitDiagnostics result();

 private:
  void choose_rows();
  void evaluate();
  void place_readings();
  void place(std::size_t reading, const Pair& pair);
  void add_channel(std::size_t c);
  void add_misfit(std::size_t c);
  void add_runs();
  [[nodiscard]] std::vector<std::int8_t> residual_signs() const;
  void add_noise(std::size_t c);
  void keep_worst();
  void add_counts(std::size_t c);
  void add_regions();
  void add_brightness();
  void add_chi_square();
  [[nodiscard]] double noise_floor(std::size_t c);
  void add_reciprocity();
  // By row of the scan.
  [[nodiscard]] double signed_theta_r(std::size_t row) const {
    return delta_phi_deg(scan_, row) > 0.0 ? scan_.theta_r_deg[row] : -scan_.theta_r_deg[row];
  }
  [[nodiscard]] double value(std::size_t i, std::size_t c) const { return scan_.channels[c].values[rows_[i]]; }
  [[nodiscard]] bool counts(std::size_t i, std::size_t c) const {
    return !options_.used || options_.used->left_out.empty() || options_.used->left_out[c].empty() ||
           !options_.used->left_out[c][i];
  }
  [[nodiscard]] double fitted(std::size_t i, std::size_t c) const { return options_.values->fitted[c][i]; }
  [[nodiscard]] double open(std::size_t i, std::size_t c) const { return options_.values->open[c][i]; }
  [[nodiscard]] double floor(std::size_t i, std::size_t c) const {
    const ScanChannel& channel = scan_.channels[c];
    return channel.u.empty() ? out_.channels[c].noise_floor : floor_sds * channel.u[rows_[i]];
  }

  const Scan& scan_;
  const Material& material_;
  DiagnosticsOptions options_;
  Rows rows_;            // of the readings used
  PairBatch own_pairs_;  // where the options have none
  std::vector<double> weight_;
  std::vector<Region> region_;
  std::vector<bool> mirror_cone_;
  RowGroups lines_;
  std::array<Sums, region_count> by_region_;
  std::array<std::vector<double>, region_count> parts_;  // of every channel: see Sums::misfit
  // What a step of a channel gathers. Of millions of readings fresh memory takes longer than what is done with it.
  std::vector<double> gathered_, gathered_residuals_;
  FitDiagnostics out_;
};

void Diagnosis::choose_rows() {
  Rows rows;
  for (std::size_t row = 0; row < scan_.size() && !options_.used; ++row) {
    if (std::max(scan_.theta_i_deg[row], scan_.theta_r_deg[row]) < 90.0) rows.push_back(row);
  }
  rows_ = options_.used ? std::move(options_.used->rows) : std::move(rows);
  if (!options_.values) own_pairs_ = PairBatch(angles_of(scan_, rows_));
}

void Diagnosis::evaluate() {
  const std::size_t channels = scan_.channels.size();
  const auto by_channel = [&](const std::vector<double>& values) {
    std::vector<std::vector<double>> out(channels);
    for (std::size_t i = 0; i < values.size(); ++i) out[i % channels].push_back(values[i]);
    return out;
  };
  const std::vector<double> fitted = Evaluator(material_).values(own_pairs_);
  const std::vector<double> open = value_uncertainties(material_, own_pairs_, fitted);
  options_.values = FittedValues{&own_pairs_, by_channel(fitted), by_channel(open)};
}

void Diagnosis::place(std::size_t reading, const Pair& pair) {
  weight_.push_back(has_cosine(options_.weight) ? pair.cos_i : 1.0);
  region_.push_back(region_of(scan_, rows_[reading], pair));
  mirror_cone_.push_back(pair.mirror_distance2 <= material_.solid_angle_sr / pi);
}

void Diagnosis::place_readings() {
  weight_.reserve(rows_.size());
  region_.reserve(rows_.size());
  mirror_cone_.reserve(rows_.size());
  const PairBatch* const pairs = options_.values->pairs;
  for (std::size_t i = 0; pairs != nullptr && i < rows_.size(); ++i) place(i, (*pairs)[i]);
  constexpr std::size_t at_once = 1024;
  for (std::size_t first = 0; pairs == nullptr && first < rows_.size(); first += at_once) {
    const std::span<const std::size_t> some = std::span(rows_).subspan(first, std::min(at_once, rows_.size() - first));
    const PairBatch run(angles_of(scan_, some));
    for (std::size_t i = 0; i < run.size(); ++i) place(first + i, run[i]);
  }
}

// The additive noise of the scan itself: what readings between two others of a line differ from the straight line
// through these, where the scan is darkest and a lobe's curvature and relative noise are least.
double Diagnosis::noise_floor(std::size_t c) {
  constexpr std::size_t fewest = 10;
  std::vector<double>& sizes = gathered_;
  sizes.clear();
  sizes.reserve(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) sizes.push_back(std::fabs(value(i, c)));
  if (sizes.empty()) return 0.0;
  const double dark = value_at_rank(sizes, sizes.size() / 4);
  const std::vector<double>& values = scan_.channels[c].values;
  std::vector<double> differences;
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    const std::span<const std::size_t> line = lines_[l];
    for (std::size_t j = 1; j + 1 < line.size(); ++j) {
      const auto at = [&](std::size_t k) { return signed_theta_r(line[k]); };
      if (std::fabs(values[line[j]]) > dark || !(at(j + 1) > at(j - 1))) continue;
      const double t = (at(j) - at(j - 1)) / (at(j + 1) - at(j - 1));
      const double off = values[line[j]] - (1.0 - t) * values[line[j - 1]] - t * values[line[j + 1]];
      differences.push_back(std::fabs(off) / std::sqrt(1.0 + t * t + (1.0 - t) * (1.0 - t)));
    }
  }
  if (differences.size() < fewest) return 0.0;
  // Never above the darkest quarter: a scan that is all noise is for the runs test to tell.
  return std::min(floor_sds * 1.4826 * median_of(differences), dark);
}

void Diagnosis::add_reciprocity() {
  const SwappedRows pairs = swapped_rows(scan_);
  for (std::size_t c = 0; c < scan_.channels.size(); ++c) {
    std::vector<double> ratios = swapped_ratios(scan_.channels[c].values, pairs);
    if (ratios.empty()) continue;
    for (double& ratio : ratios) ratio = std::fabs(std::log(ratio));
    out_.channels[c].reciprocity = median_of(ratios);
  }
}

void Diagnosis::add_misfit(std::size_t c) {
  std::array<Sums, region_count> regions;
  std::array<std::ptrdiff_t, region_count> before{};
  for (std::size_t k = 0; k < region_count; ++k) before[k] = std::ssize(parts_[k]);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (!counts(i, c)) continue;
    const auto region = static_cast<std::size_t>(region_[i]);
    const double residual = value(i, c) - fitted(i, c);
    regions[region].add(weight_[i], value(i, c), residual);
    const double larger = std::max(std::fabs(value(i, c)), std::fabs(fitted(i, c)));
    if (larger > floor(i, c)) parts_[region].push_back(std::max(0.0, std::fabs(residual) - open(i, c)) / larger);
  }
  Sums channel;
  std::vector<double>& parts = gathered_;
  parts.clear();
  for (std::size_t k = 0; k < region_count; ++k) {
    channel.add(regions[k]);
    by_region_[k].add(regions[k]);
    parts.insert(parts.end(), parts_[k].begin() + before[k], parts_[k].end());
  }
  out_.channels[c].misfit = channel.misfit(parts);
}

// Of every row of the scan and channel; 0 where the runs test leaves it out.
std::vector<std::int8_t> Diagnosis::residual_signs() const {
  const std::size_t channels = out_.channels.size();
  std::vector<std::int8_t> signs(scan_.size() * channels, 0);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (mirror_cone_[i]) continue;
    for (std::size_t c = 0; c < channels; ++c) {
      const double residual = value(i, c) - fitted(i, c);
      const bool open_to_it = !counts(i, c) || !(std::fabs(residual) > open(i, c));
      signs[rows_[i] * channels + c] = open_to_it ? std::int8_t{0} : residual > 0.0 ? std::int8_t{1} : std::int8_t{-1};
    }
  }
  return signs;
}

// Lines are a way through the scan that is no way through memory: along it go the signs alone, a byte each, and all
// channels at once.
void Diagnosis::add_runs() {
  const std::vector<std::int8_t> signs = residual_signs();
  const std::size_t channels = out_.channels.size();
  std::vector<double> line;
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    const std::span<const std::size_t> rows = lines_[l];
    for (std::size_t c = 0; c < channels; ++c) {
      line.clear();
      for (const std::size_t row : rows) line.push_back(signs[row * channels + c]);
      out_.channels[c].runs.add_line(line);
    }
  }
}

void Diagnosis::add_noise(std::size_t c) {
  // Of very many readings some thousands of each size tell as much.
  constexpr std::size_t most = 100000;
  const std::size_t step = (rows_.size() + most - 1) / most;
  std::vector<double>& model = gathered_;
  std::vector<double>& residuals = gathered_residuals_;
  model.clear();
  residuals.clear();
  for (std::size_t i = 0; i < rows_.size(); i += step) {
    if (!counts(i, c)) continue;
    model.push_back(fitted(i, c));
    residuals.push_back(value(i, c) - fitted(i, c));
  }
  const auto n = static_cast<Eigen::Index>(model.size());
  const Noise noise = estimate_noise(Eigen::Map<const Eigen::VectorXd>(model.data(), n),
                                     Eigen::Map<const Eigen::VectorXd>(residuals.data(), n));
  out_.channels[c].residuals = noise;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (!counts(i, c)) continue;
    const double size = std::fabs(value(i, c) - fitted(i, c));
    const double larger = std::max(std::fabs(value(i, c)), fitted(i, c));
    const double relative = noise.relative * fitted(i, c);
    const double variance = relative * relative + noise.additive * noise.additive;
    if (size * size <= outlier_sds * outlier_sds * variance || size <= negligible_misfit * larger) continue;
    const double sds = quotient(size, noise.sd(fitted(i, c)));
    ++out_.outlier_count;
    out_.outliers.push_back({rows_[i], c, value(i, c), fitted(i, c), sds});
    if (out_.outliers.size() == 100 * most_outliers) keep_worst();
  }
}

// Of equal ones the first.
void Diagnosis::keep_worst() {
  std::stable_sort(out_.outliers.begin(), out_.outliers.end(),
                   [](const Outlier& a, const Outlier& b) { return a.sds > b.sds; });
  out_.outliers.resize(std::min(out_.outliers.size(), most_outliers));
}

// Values that a detector or a program has cut off are alike to the last digit, which measured ones seldom are. Where
// most of the readings are alike the surface is.
void Diagnosis::add_counts(std::size_t c) {
  std::vector<double>& values = gathered_;
  values.clear();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (counts(i, c)) values.push_back(value(i, c));
  }
  out_.channels[c].clipping = clipping_of(values);
}

void Diagnosis::add_channel(std::size_t c) {
  ChannelDiagnostics& channel = out_.channels[c];
  channel.noise_floor = noise_floor(c);
  add_misfit(c);
  add_noise(c);
  add_counts(c);
}

void Diagnosis::add_regions() {
  Sums all;
  for (const Sums& sums : by_region_) all.add(sums);
  std::size_t count = 0;
  for (const std::vector<double>& parts : parts_) count += parts.size();
  std::vector<double> all_parts;
  all_parts.reserve(count);
  for (std::size_t k = 0; k < region_count; ++k) {
    const Sums& sums = by_region_[k];
    RegionMisfit& to = out_.regions[k];
    to.of_misfit = quotient(sums.r2, all.r2);
    to.of_signal = quotient(sums.f2, all.f2);
    to.excess = quotient(sums.signed_r2, sums.r2);
    to.typical = Sums::typical(parts_[k]);
    all_parts.insert(all_parts.end(), parts_[k].begin(), parts_[k].end());
    parts_[k] = {};
  }
  out_.misfit = all.misfit(all_parts);
}

void Diagnosis::add_brightness() {
  std::vector<double> some;
  some.reserve(rows_.size() * scan_.channels.size());
  const auto gather = [&](const auto& of_reading) {
    some.clear();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      for (std::size_t c = 0; c < scan_.channels.size(); ++c) {
        if (counts(i, c)) of_reading(weight_[i], value(i, c));
      }
    }
  };
  gather([&](double weight, double value) { some.push_back(weight * value * value); });
  out_.readings = some.size();
  out_.brightest = count_of_largest(some, 0.9);
  gather([&](double, double value) {
    if (value > 0.0) some.push_back(value);
  });
  if (some.empty()) return;
  out_.brightness_range = *std::max_element(some.begin(), some.end()) / median_of(some);
}

void Diagnosis::add_chi_square() {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t c = 0; c < scan_.channels.size(); ++c) {
    const std::vector<double>& u = scan_.channels[c].u;
    for (std::size_t i = 0; !u.empty() && i < rows_.size(); ++i) {
      if (!(u[rows_[i]] > 0.0) || !counts(i, c)) continue;
      sum += std::pow((value(i, c) - fitted(i, c)) / u[rows_[i]], 2);
      ++count;
    }
  }
  if (count > options_.free_parameters) out_.chi_square = reduced_chi_square(sum, count - options_.free_parameters);
}

FitDiagnostics Diagnosis::result() {
  out_.channels.resize(scan_.channels.size());
  gathered_.reserve(rows_.size());
  add_reciprocity();
  lines_ = detector_lines(scan_);
  for (const Region region : region_) ++out_.regions[static_cast<std::size_t>(region)].readings;
  for (std::size_t k = 0; k < region_count; ++k) parts_[k].reserve(out_.regions[k].readings * scan_.channels.size());
  for (std::size_t c = 0; c < scan_.channels.size(); ++c) add_channel(c);
  add_runs();
  lines_ = {};
  options_.values->open.clear();
  add_regions();
  add_brightness();
  add_chi_square();
  for (const ChannelDiagnostics& channel : out_.channels) {
    out_.runs_testable = out_.runs_testable || channel.runs.testable();
    const double p = channel.runs.p() * static_cast<double>(out_.channels.size());
    if (channel.runs.testable()) out_.p_runs = std::min(out_.p_runs, p);
  }
  keep_worst();
  judge(scan_, material_, out_);
  return std::move(out_);
}

}  // namespace

std::string_view name_of(FitVerdict verdict) noexcept {
  constexpr std::array<std::string_view, 3> names{"describes", "systematic", "fails"};
  return names[static_cast<std::size_t>(verdict)];
}

std::string_view name_of(Region region) noexcept {
  constexpr std::array<std::string_view, region_count> names{"mirror", "retro", "forward_grazing", "elsewhere"};
  return names[static_cast<std::size_t>(region)];
}

double Misfit::typical_factor() const noexcept { return 1.0 / (1.0 - std::min(typical.value_or(0.0), 1.0)); }

FitDiagnostics diagnose(const Scan& scan, const Material& material, DiagnosticsOptions options) {
  return Diagnosis(scan, material, std::move(options)).result();
}

}  // namespace goniofit
