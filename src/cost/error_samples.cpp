#include "cost/error_samples.h"

#include <cmath>
#include <optional>

#include "brdf/sampler.h"
#include "cost/reference.h"
#include "geometry/angles.h"
#include "synthetic/random.h"

namespace goniofit {

namespace {

double incidence(const Domain& d, const ErrorSettings& s, std::size_t i) {
  const double span = d.theta_i_max_deg - d.theta_i_min_deg;
  const auto n = static_cast<double>(s.incidences);
  double part = s.incidences > 1 ? static_cast<double>(i) / (n - 1.0) : 0.5;
  if (s.random_incidence) {
    part = (static_cast<double>(i) + RandomStream(subkey(subkey(s.seed, "incidence"), i)).uniform()) / n;
  }
  return d.theta_i_min_deg + span * part;
}

// The lobes of all effects but coh, whose energy is taken apart; none where there is nothing else.
std::optional<Sampler> lobes_of(Material m) {
  m.components.erase(Effect::coh);
  if (acting_effects(m).empty()) return std::nullopt;
  return Sampler(Evaluator(std::move(m)));
}

class Drawing {
 public:
  Drawing(const Material& reference, const Domain& domain)
      : sampler_(lobes_of(reference)), least_cos_(cos_deg(domain.theta_r_max_deg)) {}

  // Half each; without lobes all from the hemisphere.
  [[nodiscard]] std::optional<Direction> draw(const Direction& l, bool from_lobe, RandomStream& random) const {
    const double u1 = random.uniform();
    const double u2 = random.uniform();
    const double u3 = random.uniform();
    if (!from_lobe || !sampler_) {
      const double z = least_cos_ + (1.0 - least_cos_) * u1;
      const double r = std::sqrt((1.0 - z) * (1.0 + z));
      return Direction{r * std::cos(2.0 * pi * u2), r * std::sin(2.0 * pi * u2), z};
    }
    const std::optional<DirectionSample> sample = sampler_->sample(l, {u1, u2, u3});
    if (!sample || sample->direction.z <= least_cos_) return std::nullopt;
    return sample->direction;
  }

  [[nodiscard]] double density(const Direction& l, const Direction& v) const {
    const double uniform = 1.0 / (2.0 * pi * (1.0 - least_cos_));
    return sampler_ ? 0.5 * (uniform + sampler_->pdf(l, v)) : uniform;
  }

 private:
  std::optional<Sampler> sampler_;
  double least_cos_;
};

}  // namespace

ErrorSamples error_samples(const Material& reference, const Domain& domain, const ErrorSettings& settings) {
  validate(domain);
  const Drawing drawing(reference, domain);
  ErrorSamples s;
  s.theta_r_max_deg = domain.theta_r_max_deg;
  s.drawn = static_cast<double>(settings.directions);
  s.solid_angle_sr = domain.solid_angle_sr.value_or(reference.solid_angle_sr);
  for (std::size_t i = 0; i < settings.incidences; ++i) {
    const double theta_i = incidence(domain, settings, i);
    RandomStream random(subkey(subkey(settings.seed, "directions"), i));
    const Direction l = direction_of(theta_i, random.uniform(-180.0, 180.0));
    s.theta_i_deg.push_back(theta_i);
    s.first.push_back(s.directions.size());
    s.mirrors.push_back(l, mirrored(l));
    for (std::size_t k = 0; k < settings.directions; ++k) {
      const std::optional<Direction> v = drawing.draw(l, k % 2 == 1, random);
      if (!v) continue;
      s.directions.push_back(l, *v);
      s.weights.push_back(v->z / drawing.density(l, *v));
    }
  }
  s.first.push_back(s.directions.size());
  return s;
}

}  // namespace goniofit
