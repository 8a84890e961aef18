#include "cost/fitted_models.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cost/error_samples.h"
#include "cost/reference.h"
#include "fit/fit.h"
#include "geometry/angles.h"
#include "fit/loss.h"

namespace goniofit {

namespace {

constexpr ErrorSettings fitted_directions{.incidences = 9, .directions = 192};

// Sum of |f - measured| over that of measured: the readings are the directions that errors are measured in.
double l1_of(const Material& m, const Scan& scan) {
  DirectionBatch directions;
  for (std::size_t row = 0; row < scan.size(); ++row) {
    const AnglePair a = scan.angles(row);
    directions.push_back(direction_of(a.theta_i_deg, a.phi_i_deg), direction_of(a.theta_r_deg, a.phi_r_deg));
  }
  const BatchEvaluator<double> kernel(m);
  std::vector<double> f(kernel.channels() * scan.size());
  kernel.values(directions, std::span<double>(f));
  double difference = 0.0;
  double sum = 0.0;
  for (std::size_t c = 0; c < scan.channels.size(); ++c) {
    for (std::size_t row = 0; row < scan.size(); ++row) {
      const double measured = scan.channels[c].values[row];
      const double weight = std::cos(radians(scan.theta_r_deg[row]));
      difference += weight * std::fabs(f[c * scan.size() + row] - measured);
      sum += weight * measured;
    }
  }
  return difference / sum;
}

}  // namespace

Scan reference_scan(const Material& reference, std::uint64_t seed) {
  ErrorSettings settings = fitted_directions;
  settings.seed = seed;
  const ErrorSamples samples = error_samples(reference, {}, settings);
  const Candidate exact{.name = "reference", .material = reference};
  const ModelValues values = model_values(exact, samples);
  Scan scan;
  scan.name = reference.name;
  scan.source = "values of " + reference.name;
  const DirectionBatch& d = samples.directions;
  for (std::size_t i = 0; i < d.size(); ++i) {
    const AnglePair a = angles_of({d.l_x[i], d.l_y[i], d.l_z[i]}, {d.v_x[i], d.v_y[i], d.v_z[i]});
    scan.theta_i_deg.push_back(a.theta_i_deg);
    scan.phi_i_deg.push_back(a.phi_i_deg);
    scan.theta_r_deg.push_back(a.theta_r_deg);
    scan.phi_r_deg.push_back(a.phi_r_deg);
  }
  for (std::size_t c = 0; c < values.channels; ++c) {
    const MaterialChannel& from = reference.channels[c];
    const auto first = values.f.begin() + static_cast<std::ptrdiff_t>(c * d.size());
    scan.channels.push_back({from.name, from.wavelength_um, from.n, from.kappa,
                             std::vector<double>(first, first + static_cast<std::ptrdiff_t>(d.size())), {}});
  }
  return scan;
}

Candidate fitted_peer(const std::string& model, const Scan& scan, const Material& reference,
                      FresnelTier fresnel) {
  FitSettings settings;
  settings.model = model;
  settings.terms.fresnel = reference.terms.fresnel == FresnelTier::exact ? fresnel : FresnelTier::schlick;
  const bool by_reflectance = std::any_of(reference.channels.begin(), reference.channels.end(),
                                          [](const MaterialChannel& c) { return c.f0.has_value(); });
  if (by_reflectance) {
    for (const MaterialChannel& c : reference.channels) settings.f0.push_back(c.normal_reflectance());
  }
  Candidate best{.name = model, .material = {}};
  double least = std::numeric_limits<double>::infinity();
  for (const Loss loss : {Loss::cosine_l2, Loss::cube_root}) {
    settings.loss = loss;
    Material fitted = fit(scan, settings).material;
    fitted.fit.reset();
    const double l1 = l1_of(fitted, scan);
    if (!(l1 < least)) continue;
    least = l1;
    best.material = std::move(fitted);
    best.note = "fitted, loss " + std::string(name_of(loss));
  }
  return best;
}

}  // namespace goniofit
