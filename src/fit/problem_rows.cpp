// Which residuals a problem has, what they are of and what they weigh.

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "fit/hemisphere_nodes.h"
#include "fit/parameter_settings.h"
#include "fit/problem.h"
#include "geometry/angles.h"
#include "geometry/direction.h"
#include "geometry/lane_angles.h"
#include "geometry/solid_angles.h"
#include "scan/clipping.h"
#include "support/error.h"

namespace goniofit {

namespace {

double angle_between_deg(const AnglePair& a) noexcept {
  const Direction l = direction_of(a.theta_i_deg, a.phi_i_deg);
  const Direction v = direction_of(a.theta_r_deg, a.phi_r_deg);
  const double chord = std::hypot(l.x - v.x, l.y - v.y, l.z - v.z);
  return degrees(2.0 * std::asin(std::min(1.0, 0.5 * chord)));
}

// Directions of incidence, to a tenth of a degree.
using Incidence = std::pair<long, long>;
Incidence incidence_of(const AnglePair& a) noexcept {
  return {std::lround(10.0 * a.theta_i_deg), a.theta_i_deg > 0.0 ? std::lround(10.0 * wrap_deg(a.phi_i_deg)) : 0};
}

// Within one incidence: of readings along an arc the arc's parts, else solid angles.
std::vector<double> parts_of(const Scan& scan, const std::vector<std::size_t>& rows) {
  const bool in_plane =
      std::all_of(rows.begin(), rows.end(), [&](std::size_t row) { return scan.plane_side(row) != 0; });
  std::vector<double> angles;
  std::vector<Direction> directions;
  for (const std::size_t row : rows) {
    const AnglePair a = scan.angles(row);
    if (in_plane) angles.push_back(scan.signed_theta_r_deg(row));
    if (!in_plane) directions.push_back(direction_of(a.theta_r_deg, a.phi_r_deg));
  }
  return in_plane ? arc_lengths(angles) : solid_angles(directions);
}

// Of mean 1; every direction of incidence has the same share.
Eigen::VectorXd evening_weights(const Scan& scan, const std::vector<std::size_t>& rows) {
  std::map<Incidence, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < rows.size(); ++i) groups[incidence_of(scan.angles(rows[i]))].push_back(i);
  Eigen::VectorXd weights(static_cast<Eigen::Index>(rows.size()));
  const double share = static_cast<double>(rows.size()) / static_cast<double>(groups.size());
  for (const auto& [incidence, members] : groups) {
    std::vector<std::size_t> own;
    for (const std::size_t i : members) own.push_back(rows[i]);
    const std::vector<double> parts = parts_of(scan, own);
    double sum = 0.0;
    for (const double part : parts) sum += part;
    for (std::size_t i = 0; i < members.size(); ++i) {
      weights[static_cast<Eigen::Index>(members[i])] = share * parts[i] / sum;
    }
  }
  return weights;
}

Eigen::VectorXd joined(const std::vector<double>& a, const std::vector<double>& b) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(a.size() + b.size()));
  std::copy(a.begin(), a.end(), out.data());
  std::copy(b.begin(), b.end(), out.data() + a.size());
  return out;
}

bool same_name(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

const ReflectanceChannel* channel_of(const FitSettings& settings, const std::string& name) {
  if (!settings.reflectances) return nullptr;
  for (const ReflectanceChannel& c : settings.reflectances->channels) {
    if (same_name(c.name, name)) return &c;
  }
  return nullptr;
}

}  // namespace

void RowSums::apply(Eigen::MatrixXd& m) const {
  if (ends_.empty()) return;
  std::size_t begin = single_;
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(begin);
    const auto points = static_cast<Eigen::Index>(ends_[i] - begin);
    // A row is written no later than it is read.
    m.row(static_cast<Eigen::Index>(single_ + i)) = m.middleRows(at, points).colwise().sum().eval();
    begin = ends_[i];
  }
  m.conservativeResize(static_cast<Eigen::Index>(rows()), Eigen::NoChange);
}

void RowSums::apply(Eigen::VectorXd& v) const {
  Eigen::MatrixXd m = v;
  apply(m);
  v = m;
}

std::size_t Problem::values_used() const noexcept {
  std::size_t count = 0;
  for (const ProblemChannel& c : channels) {
    count += c.used.size() == 0 ? samples() : static_cast<std::size_t>((c.used.array() > 0.0).count());
  }
  return count;
}

void Problem::emphasise(std::vector<Eigen::VectorXd> emphasis) {
  loss = Loss::cosine_l2;
  robust.reset();
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].used.size() > 0) emphasis[c] = emphasis[c].cwiseProduct(channels[c].used);
    channels[c].emphasis = std::move(emphasis[c]);
  }
  fill_targets();
}

void Problem::choose_rows(const Scan& scan, const FitSettings& settings, bool may_part) {
  check_range(settings.max_theta_deg, 0.0, 90.0, "max-theta");
  const double cone = settings.exclusions.retro_cone_deg;
  check_range(cone, 0.0, 180.0, "exclude-retro");
  std::vector<AnglePair> angles;
  theta_i_deg.reserve(scan.size());
  rows.reserve(scan.size());
  angles.reserve(scan.size());
  for (std::size_t row = 0; row < scan.size(); ++row) {
    const AnglePair a = scan.angles(row);
    const double theta = std::max(a.theta_i_deg, a.theta_r_deg);
    if (theta >= 90.0) {
      ++exclusions.at_90;
    } else if (theta > settings.max_theta_deg) {
      ++exclusions.beyond_max_theta;
    } else if (cone > 0.0 && angle_between_deg(a) <= cone) {
      ++exclusions.retro_cone;
    } else {
      rows.push_back(row);
      theta_i_deg.push_back(a.theta_i_deg);
      angles.push_back(a);
    }
  }
  if (may_part && rows.size() > most_held) {
    angles_ = std::move(angles);
    theta_i_deg = {};
  } else {
    pairs = PairBatch(angles);
  }
  sums = RowSums(rows.size());
  if (!rows.empty()) return;
  throw usage_error(scan.source + ": no reading is left to fit: " + std::to_string(exclusions.at_90) +
                    " at 90 degrees, " + std::to_string(exclusions.beyond_max_theta) +
                    " beyond the largest theta asked for, " + std::to_string(exclusions.retro_cone) +
                    " about the retro direction");
}

// The reflectances' nodes, as points of evaluation.
void Problem::add_reflectances(const FitSettings& settings) {
  if (by_parts()) return;
  point_weight = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(rows.size()));
  if (!settings.reflectances) return;
  const ReflectanceReadings& readings = *settings.reflectances;
  const bool known = std::any_of(channels.begin(), channels.end(),
                                 [&](const ProblemChannel& c) { return channel_of(settings, c.name) != nullptr; });
  if (!known) {
    throw usage_error(readings.source + ": none of its channels is one of the scan's, expected " +
                      channels.front().name + (channels.size() > 1 ? " ..." : ""));
  }
  const double cone = components.has(Effect::coh) ? solid_angle_sr : 0.0;
  for (const double theta_deg : readings.theta_i_deg) {
    check_range(theta_deg, 0.0, std::nextafter(90.0, 0.0), readings.source + ": theta_i");
    const HemisphereNodes nodes = hemisphere_nodes(theta_deg, cone, anisotropic);
    for (std::size_t i = 0; i < nodes.pairs.size(); ++i) pairs.push_back(nodes.pairs[i]);
    sums.add(nodes.pairs.size());
    theta_i_deg.push_back(theta_deg);
    const Eigen::Index before = point_weight.size();
    point_weight.conservativeResize(before + static_cast<Eigen::Index>(nodes.weight.size()));
    for (std::size_t i = 0; i < nodes.weight.size(); ++i) {
      point_weight[before + static_cast<Eigen::Index>(i)] = nodes.weight[i] / pi;
    }
  }
}

void Problem::choose_weights(const Scan& scan) {
  weight.resize(static_cast<Eigen::Index>(samples()));
  const auto row = static_cast<Eigen::Index>(readings());
  weight.head(row).setOnes();
  for (std::size_t i = 0; has_cosine(weighting) && i < readings(); ++i) {
    const double theta = by_parts() ? angles_[i].theta_i_deg : theta_i_deg[i];
    weight[static_cast<Eigen::Index>(i)] = std::sqrt(sine_cosine_deg(Lane<double>{theta}).cosine.v);
  }
  if (has_solid_angle(weighting)) {
    const Eigen::VectorXd even = evening_weights(scan, rows).cwiseSqrt();
    weight.head(row) = weight.head(row).cwiseProduct(even);
  }
  if (by_parts()) return;
  point_weight.head(row) = weight.head(row);
  if (samples() > readings()) weigh_reflectances(scan);
}

// A reflectance counts as much as the readings of one direction of incidence do together, but by inverse variance,
// where each counts by its own.
void Problem::weigh_reflectances(const Scan& scan) {
  std::set<Incidence> incidences;
  for (const std::size_t row : rows) incidences.insert(incidence_of(scan.angles(row)));
  const double together = loss == Loss::inverse_variance
                              ? 1.0
                              : std::sqrt(static_cast<double>(rows.size()) / static_cast<double>(incidences.size()));
  Eigen::Index point = static_cast<Eigen::Index>(readings());
  for (std::size_t i = readings(); i < samples(); ++i) {
    const double w = together * (has_cosine(weighting) ? std::sqrt(cos_deg(theta_i_deg[i])) : 1.0);
    const Eigen::Index points = static_cast<Eigen::Index>(sums.points(i));
    point_weight.segment(point, points) *= w;
    point += points;
    weight[static_cast<Eigen::Index>(i)] = w;
  }
}

void Problem::fill_values(const Scan& scan, const FitSettings& settings) {
  const std::size_t reflectances = samples() - readings();
  for (std::size_t c = 0; c < channels.size(); ++c) {
    ProblemChannel& to = channels[c];
    const ScanChannel& from = scan.channels[c];
    std::vector<double> values;
    std::vector<double> u;
    values.reserve(rows.size());
    for (const std::size_t row : rows) {
      values.push_back(from.values[row]);
      if (!from.u.empty()) u.push_back(from.u[row]);
    }
    std::vector<double> sums_of(reflectances, 0.0);
    std::vector<double> u_of(from.u.empty() ? 0 : reflectances, 1.0);
    const ReflectanceChannel* const own = channel_of(settings, to.name);
    for (std::size_t i = 0; own != nullptr && i < reflectances; ++i) {
      sums_of[i] = own->values[i] / pi;
      if (!u_of.empty() && !own->u.empty()) u_of[i] = own->u[i] / pi;
    }
    to.value = joined(values, sums_of);
    if (!from.u.empty() && (own == nullptr || !own->u.empty())) to.u = joined(u, u_of);
    if (own == nullptr && reflectances > 0) {
      to.used = Eigen::VectorXd::Ones(to.value.size());
      to.used.tail(static_cast<Eigen::Index>(reflectances)).setZero();
    }
  }
  leave_out_values(settings.exclusions);
  choose_emphasis();
}

void Problem::leave_out_values(const ExclusionSettings& exclude) {
  const auto n = static_cast<Eigen::Index>(readings());
  for (ProblemChannel& c : channels) {
    const Clipping clipping = clipping_of({c.value.data(), readings()});
    const bool at_maximum = exclude.saturated && clipping.at_maximum > 0;
    std::vector<Eigen::Index> out;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double value = c.value[i];
      const bool saturated =
          (exclude.saturated_from && value >= *exclude.saturated_from) || (at_maximum && value == clipping.maximum);
      const bool clamped = exclude.clamped && value == 0.0;
      exclusions.saturated_values += saturated ? 1 : 0;
      exclusions.clamped_values += clamped ? 1 : 0;
      if (saturated || clamped) {
        out.push_back(i);
      } else if (value < 0.0) {
        ++exclusions.negative_values;
      }
    }
    if (out.size() == readings()) throw usage_error("channel " + c.name + ": every value is left out, expected some");
    if (out.empty()) continue;
    if (c.used.size() == 0) c.used = Eigen::VectorXd::Ones(c.value.size());
    for (const Eigen::Index i : out) c.used[i] = 0.0;
  }
}

void Problem::choose_emphasis() {
  for (ProblemChannel& c : channels) {
    if (loss == Loss::inverse_variance) {
      if (c.u.size() == 0) {
        throw usage_error("loss inverse-variance: channel " + c.name +
                          " has no standard uncertainties, expected a column u_" + c.name +
                          " (of the reflectances too, where they are given)");
      }
      c.emphasis = c.u.cwiseInverse();
    } else if (loss == Loss::relative) {
      c.emphasis = c.value.cwiseAbs().cwiseMax(relative_floor).cwiseInverse();
    }
    if (c.used.size() > 0) c.emphasis = c.emphasis.size() > 0 ? c.emphasis.cwiseProduct(c.used).eval() : c.used;
  }
}

void Problem::fill_targets() {
  total = 0.0;
  for (ProblemChannel& c : channels) {
    if (!by_parts()) c.target = weight.cwiseProduct(c.value);
    for (Eigen::Index i = 0; i < c.value.size(); ++i) {
      const double own = c.emphasis.size() > 0 ? c.emphasis[i] : 1.0;
      const double r = weight[i] * own * transformed(loss, c.value[i]).value;
      total += r * r;
    }
  }
}

BentResidual bent_residual(const Problem& problem, const ProblemChannel& channel, Eigen::Index row, double f) {
  const double factor = problem.weight[row] * (channel.emphasis.size() > 0 ? channel.emphasis[row] : 1.0);
  const Transformed there = transformed(problem.loss, f);
  const double r = factor * (there.value - transformed(problem.loss, channel.value[row]).value);
  RobustLoss::Value kernel{r * r, 1.0, 1.0};
  if (problem.robust) kernel = problem.robust->at(r * r);
  const double share = std::sqrt(kernel.slope);
  return {share * r, share * factor * there.slope, kernel.rho, kernel};
}

}  // namespace goniofit
