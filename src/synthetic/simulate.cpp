#include "synthetic/simulate.h"

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "brdf/azimuths.h"
#include "brdf/evaluator.h"
#include "geometry/angles.h"
#include "geometry/samplings.h"
#include "support/error.h"
#include "support/text.h"
#include "synthetic/random.h"

namespace goniofit {
namespace {

std::string how_it_was_made(Sampling sampling, const std::vector<double>& azimuths, const Noise& noise,
                            std::uint64_t seed) {
  std::string text = "goniofit simulate --sampling ";
  text += sampling == Sampling::hemisphere ? "hemisphere" : "incidence-plane";
  if (azimuths != std::vector{0.0}) {
    text += " --phi-i ";
    for (std::size_t i = 0; i < azimuths.size(); ++i) text += (i == 0 ? "" : ",") + shortest(azimuths[i]);
  }
  text += " --noise " + shortest(noise.relative);
  if (noise.additive != 0.0) text += "," + shortest(noise.additive);
  return text + " --seed " + std::to_string(seed);
}

// What of the material only the instrument's solid angle gives a height: coh, and the mirror part of Schlick's models.
bool reads_solid_angle(const Material& material) {
  return material.components.has(Effect::coh) || material.model.starts_with("schlick");
}

// Where the cell centres would miss the peak. He's distribution goes over into that of coh as the surface gets smooth.
bool needs_mirror(const Material& material) {
  return reads_solid_angle(material) ||
         (material.components.has(Effect::dd) && (material.terms.distribution == DistributionTier::he_torrance ||
                                                  material.terms.distribution == DistributionTier::he_torrance_series));
}

// The sampling, once for each azimuth of incidence.
std::vector<AnglePair> directions_of(const Material& material, Sampling sampling, const std::vector<double>& azimuths) {
  const std::vector<AnglePair> plain =
      sampling == Sampling::hemisphere ? hemisphere_sampling(needs_mirror(material)) : incidence_plane_sampling();
  std::vector<AnglePair> all;
  all.reserve(plain.size() * azimuths.size());
  for (const double turn : azimuths) {
    for (AnglePair d : plain) {
      if (turn != 0.0) {
        d.phi_i_deg = wrap_deg(d.phi_i_deg + turn);
        d.phi_r_deg = wrap_deg(d.phi_r_deg + turn);
      }
      all.push_back(d);
    }
  }
  return all;
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

void check(const std::vector<double>& azimuths) {
  std::set<double> given;
  for (const double phi : azimuths) {
    if (!std::isfinite(phi)) throw usage_error("azimuth of incidence " + shortest(phi) + ": expected a finite number");
    if (!given.insert(wrap_deg(phi)).second) {
      throw usage_error("azimuth of incidence " + shortest(phi) + ": is given twice, expected each once");
    }
  }
}

}  // namespace

std::vector<double> incidence_azimuths(const Material& material) {
  if (is_anisotropic(Evaluator(material))) return {0.0, 45.0, 90.0};
  return {0.0};
}

Scan simulate(const Material& material, Sampling sampling, const Noise& noise, std::uint64_t seed,
              bool with_uncertainty, const std::vector<double>& phi_i_deg) {
  check(noise);
  check(phi_i_deg);
  const Evaluator evaluator(material);
  const std::vector<double> azimuths = phi_i_deg.empty() ? incidence_azimuths(material) : phi_i_deg;
  const std::vector<AnglePair> directions = directions_of(material, sampling, azimuths);

  Scan scan;
  scan.name = material.name;
  scan.source = "simulated " + scan.name;
  // A scan of the plane of incidence states no azimuth: those that do are hemispherical.
  const bool in_plane = sampling == Sampling::incidence_plane && azimuths == std::vector{0.0};
  scan.geometry = in_plane ? ScanGeometry::incidence_plane : ScanGeometry::hemispherical;
  if (reads_solid_angle(material)) scan.solid_angle_sr = material.solid_angle_sr;
  set_directions(scan, directions);
  scan.metadata = {{"name", scan.name}, {"made_by", how_it_was_made(sampling, azimuths, noise, seed)}};

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
