#include "cost/fitted_models.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cost/error_samples.h"
#include "fit/fit.h"
#include "geometry/angles.h"
#include "peers/peers.h"

namespace goniofit {

namespace {

constexpr ErrorSettings fitted_directions{.incidences = 9, .directions = 128};
// Of the mean residual: from here on a residual counts linearly.
constexpr double linear_from = 0.1;

void add_direction(Scan& scan, const DirectionBatch& d, std::size_t i) {
  const AnglePair a = angles_of({d.l_x[i], d.l_y[i], d.l_z[i]}, {d.v_x[i], d.v_y[i], d.v_z[i]});
  scan.theta_i_deg.push_back(a.theta_i_deg);
  scan.phi_i_deg.push_back(a.phi_i_deg);
  scan.theta_r_deg.push_back(a.theta_r_deg);
  scan.phi_r_deg.push_back(a.phi_r_deg);
}

std::vector<std::size_t> outside_cones(const ErrorSamples& s) {
  std::vector<std::size_t> rows;
  const DirectionBatch& d = s.directions;
  for (std::size_t i = 0; i < d.size(); ++i) {
    const double cos_mirror = d.l_z[i] * d.v_z[i] - d.l_x[i] * d.v_x[i] - d.l_y[i] * d.v_y[i];
    if (2.0 * pi * (1.0 - cos_mirror) > s.solid_angle_sr) rows.push_back(i);
  }
  return rows;
}

}  // namespace

Scan reference_scan(const Material& reference, std::uint64_t seed) {
  ErrorSettings settings = fitted_directions;
  settings.seed = seed;
  const ErrorSamples s = error_samples(reference, {}, settings);
  const EvaluationCandidate exact{.name = "reference", .material = reference};
  const ModelValues values = model_values(exact, s);
  const std::vector<std::size_t> rows = outside_cones(s);
  const std::size_t mirrors = s.mirrors.size();
  Scan scan;
  scan.name = reference.name;
  scan.source = "values of " + reference.name;
  scan.solid_angle_sr = s.solid_angle_sr;
  for (const std::size_t i : rows) add_direction(scan, s.directions, i);
  for (std::size_t i = 0; i < mirrors; ++i) add_direction(scan, s.mirrors, i);
  for (std::size_t c = 0; c < values.channels; ++c) {
    const MaterialChannel& from = reference.channels[c];
    ScanChannel channel{from.name, from.wavelength_um, from.n, from.kappa, {}, {}};
    for (const std::size_t i : rows) {
      channel.values.push_back(values.f[c * s.directions.size() + i]);
      channel.u.push_back(s.drawn / s.weights[i]);
    }
    for (std::size_t i = 0; i < mirrors; ++i) {
      const double part = s.mirrors.l_z[i] * s.solid_angle_sr;  // of the reflectance, by f
      channel.values.push_back(values.mirror[c * mirrors + i] + values.mirror_energy[c * mirrors + i] / part);
      channel.u.push_back(1.0 / part);
    }
    scan.channels.push_back(std::move(channel));
  }
  return scan;
}

Material l1_fit(const Scan& scan, FitSettings settings) {
  double mean = 0.0;
  for (const ScanChannel& c : scan.channels) {
    for (std::size_t i = 0; i < scan.size(); ++i) mean += c.values[i] / c.u[i];
  }
  mean /= static_cast<double>(scan.channels.size() * scan.size());
  settings.loss = Loss::inverse_variance;
  settings.weight = Weight::none;
  settings.robust = RobustKernel::soft_l1;
  settings.robust_scale = linear_from * mean;
  Material fitted = fit(scan, settings).material;
  fitted.fit.reset();
  return fitted;
}

std::vector<std::string> peers_for(const Material& material) {
  std::vector<std::string> names;
  const auto has_widths = [](std::string_view name) {
    return name.ends_with("-anisotropic") || (name.starts_with("schlick-") && !name.ends_with("-isotropic"));
  };
  for (const PeerInfo& peer : peer_catalogue()) {
    if (material.surface.anisotropic() || !has_widths(peer.name)) names.emplace_back(peer.name);
  }
  return names;
}

EvaluationCandidate fitted_peer(const std::string& model, const Scan& scan, const Material& reference) {
  FitSettings settings;
  settings.model = model;
  const bool by_reflectance = std::any_of(reference.channels.begin(), reference.channels.end(),
                                          [](const MaterialChannel& c) { return c.f0.has_value(); });
  if (by_reflectance) {
    for (const MaterialChannel& c : reference.channels) settings.f0.push_back(c.normal_reflectance());
  }
  return {.name = model, .material = l1_fit(scan, std::move(settings)), .note = "peers are fitted to the reference"};
}

}  // namespace goniofit
