#include "synthetic/simulate.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "brdf/evaluator.h"
#include "geometry/samplings.h"
#include "support/error.h"
#include "support/text.h"
#include "synthetic/random.h"

namespace goniofit {
namespace {

std::string how_it_was_made(Sampling sampling, const Noise& noise, std::uint64_t seed) {
  std::string text = "goniofit simulate --sampling ";
  text += sampling == Sampling::hemisphere ? "hemisphere" : "incidence-plane";
  text += " --noise " + shortest(noise.relative);
  if (noise.additive != 0.0) text += "," + shortest(noise.additive);
  return text + " --seed " + std::to_string(seed);
}

void set_directions(Scan& scan, const std::vector<AnglePair>& directions) {
  for (const AnglePair& d : directions) {
    scan.theta_i_deg.push_back(d.theta_i_deg);
    scan.phi_i_deg.push_back(d.phi_i_deg);
    scan.theta_r_deg.push_back(d.theta_r_deg);
    scan.phi_r_deg.push_back(d.phi_r_deg);
  }
}

double positive(double deviation, const std::string& channel, const AnglePair& at) {
  if (deviation > 0.0) return deviation;
  throw usage_error("channel " + channel + " has no noise at theta_i " + shortest(at.theta_i_deg) + ", theta_r " +
                    shortest(at.theta_r_deg) + ", so no uncertainty to state: give an additive noise too");
}

void check(const Noise& noise) {
  for (const double deviation : {noise.relative, noise.additive}) {
    if (!(deviation >= 0.0) || !std::isfinite(deviation)) {
      throw usage_error("noise " + shortest(deviation) + ": a standard deviation is finite and not negative");
    }
  }
}

}  // namespace

Scan simulate(const Material& material, Sampling sampling, const Noise& noise, std::uint64_t seed,
              bool with_uncertainty) {
  check(noise);
  const Evaluator evaluator(material);
  const bool coherent = material.components.has(Effect::coh);
  const std::vector<AnglePair> directions =
      sampling == Sampling::hemisphere ? hemisphere_sampling(coherent) : incidence_plane_sampling();

  Scan scan;
  scan.name = material.name;
  scan.source = "simulated " + scan.name;
  scan.geometry = sampling == Sampling::hemisphere ? ScanGeometry::hemispherical : ScanGeometry::incidence_plane;
  if (coherent) scan.solid_angle_sr = material.solid_angle_sr;
  set_directions(scan, directions);
  scan.metadata = {{"name", scan.name}, {"made_by", how_it_was_made(sampling, noise, seed)}};

  const std::vector<double> exact = evaluator.values(PairBatch(directions));
  for (std::size_t c = 0; c < evaluator.channels(); ++c) {
    const MaterialChannel& from = material.channels[c];
    ScanChannel channel{from.name, from.wavelength_um, from.n, from.kappa, {}, {}};
    for (std::size_t row = 0; row < directions.size(); ++row) {
      const double f = exact[row * evaluator.channels() + c];
      const double deviation = std::hypot(noise.relative * f, noise.additive);
      RandomStream stream(subkey(subkey(seed, row), from.name));
      channel.values.push_back(f + deviation * stream.gaussian());
      if (with_uncertainty) channel.u.push_back(positive(deviation, from.name, directions[row]));
    }
    scan.channels.push_back(std::move(channel));
  }
  return scan;
}

}  // namespace goniofit
