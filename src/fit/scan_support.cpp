#include "fit/scan_support.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/angles.h"

namespace goniofit {

namespace {

constexpr double opaque_kappa = 0.1;
constexpr double enough_for_fs_deg = 69.0;
constexpr double enough_for_uds_deg = 69.0;
constexpr double sds_to_show = 2.0;

double theta_deg(double cosine) { return degrees(std::acos(std::clamp(cosine, -1.0, 1.0))); }

// The largest angle of the readings' cosines.
template <class Cosine>
double reach_deg(const Problem& problem, const Cosine& cosine) {
  double least = 1.0;
  std::size_t reading = 0;
  problem.for_each_pairs([&](const PairBatch& run) {
    for (std::size_t i = 0; i < run.size() && reading < problem.readings(); ++i, ++reading)
      least = std::min(least, cosine(run, i));
  });
  return theta_deg(least);
}

// What k_fs = 1 adds to a reading, and what the diffuse effects give there, 1/sr.
struct Shown {
  double fs = 0.0, diffuse = 0.0;
};
Shown shown_at(const Problem& problem, const FitPoint& point, std::size_t channel, const Pair& pair) {
  const std::vector<BasisColumn>& columns = problem.basis->columns();
  const Eigen::VectorXd z = problem.shape.at(point.z.data());
  std::vector<double> values(columns.size());
  problem.basis->shape_factors(pair, std::span(z.data(), static_cast<std::size_t>(z.size())),
                               problem.wavelength(channel), values);
  Shown out;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const std::string& name = problem.basis->coefficients()[columns[j].coefficient].name;
    const double unit =
        values[j] * optics_factor(columns[j].optics, problem.terms.fresnel, problem.channels[channel].optics, pair);
    if (name == name_of(Coefficient::k_fs)) out.fs = unit;
    if (!columns[j].reads_shape)
      out.diffuse += unit * point.coefficients[channel][static_cast<Eigen::Index>(columns[j].coefficient)];
  }
  return out;
}

// The least theta, of both directions, at which a single reading shows k_fs = 1 in some channel.
std::optional<double> fs_onset_deg(const Problem& problem, const FitPoint& point, const NoiseModel& noise) {
  for (double theta = 5.0; theta < 90.0; theta += 5.0) {
    const Pair pair = make_pair(in_plane(theta, theta));
    for (std::size_t c = 0; c < problem.channels.size(); ++c) {
      const Shown at = shown_at(problem, point, c, pair);
      if (at.fs > sds_to_show * noise.model[c].sd(at.fs + at.diffuse)) return theta;
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::size_t> subsurface_coefficients(const Problem& problem) {
  std::vector<std::size_t> out;
  if (problem.model != surface_model) return out;
  for (std::size_t j = 0; j < problem.basis->coefficients().size(); ++j) {
    const std::string& name = problem.basis->coefficients()[j].name;
    if (name == name_of(Coefficient::k_uds) || name == name_of(Coefficient::k_fs)) out.push_back(j);
  }
  return out;
}

std::vector<std::size_t> opaque_channels(const Problem& problem) {
  std::vector<std::size_t> out;
  if (problem.terms.fresnel == FresnelTier::none || subsurface_coefficients(problem).empty()) return out;
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    if (problem.channels[c].optics.kappa >= opaque_kappa) out.push_back(c);
  }
  return out;
}

std::string missing_for_fs(const Problem& problem, const FitPoint& point, const NoiseModel& noise) {
  const double reach = reach_deg(problem, [](const PairBatch& pairs, std::size_t i) {
    return pairs.forward[i] > 0.0 ? std::max(pairs.cos_i[i], pairs.cos_r[i]) : 1.0;
  });
  if (reach >= enough_for_fs_deg) return {};
  std::string text = fmt::format("no forward reading has theta_i and theta_r both above {:.3g}°", reach);
  const std::optional<double> onset = fs_onset_deg(problem, point, noise);
  if (!onset) return text + ", and even at grazing the noise hides k_fs = 1";
  if (*onset <= reach) return text;
  return text + fmt::format(", and a single one shows k_fs = 1 above the noise only from about {:g}° on", *onset);
}

std::string missing_for_uds(const Problem& problem) {
  const double reach = reach_deg(
      problem, [](const PairBatch& pairs, std::size_t i) { return std::min(pairs.cos_i[i], pairs.cos_r[i]); });
  if (reach >= enough_for_uds_deg) return {};
  return fmt::format("no theta beyond {:.3g}° was measured, where alone they differ", reach);
}

}  // namespace goniofit
