#pragma once
// Materials at the limits of what validate() lets pass: every tier, effect, form and peer.

#include <cmath>
#include <string>
#include <vector>

#include "brdf/material.h"
#include "peers/peers.h"
#include "support/random_directions.h"
#include "terms/student_t_shadowing.h"

namespace goniofit::test {

class ExtremeMaterials {
 public:
  explicit ExtremeMaterials(std::uint64_t seed) : draw_(seed) {}

  /// Nine of ten are surfaces.
  [[nodiscard]] Material next() { return draw_.chance(0.9) ? surface() : peer(); }
  [[nodiscard]] Draw& draw() { return draw_; }

 private:
  // Bounds as often as anything between.
  double extreme(double low, double high) {
    if (draw_.chance(0.1)) return low;
    return draw_.chance(0.1) ? high : draw_.log_uniform(low, high);
  }

  template <class E>
  E any(std::initializer_list<E> of) {
    return of.begin()[draw_.one_of(static_cast<int>(of.size()))];
  }

  // The sum takes up to 6 us and the grooves' integral 1000 times as long as all else: rarely.
  DistributionTier distribution() {
    using enum DistributionTier;
    if (draw_.chance(0.01)) return he_torrance_series;
    return any({rough_limit, he_torrance, student_t});
  }
  RoughForm rough() {
    if (draw_.chance(2e-4)) return RoughForm::integral;
    return any({RoughForm::functional, RoughForm::qualitative});
  }

  void set_optics(Material& m) {
    MaterialChannel& c = m.channels.front();
    c.wavelength_um = draw_.log_uniform(0.3, 12.0);
    m.terms.fresnel = any({FresnelTier::schlick, FresnelTier::exact, FresnelTier::none});
    c.n = draw_.chance(0.1) ? 1.0 : extreme(1e-3, 1e3);
    c.kappa = draw_.chance(0.3) ? 0.0 : extreme(1e-9, 1e6);
  }

  Material surface() {
    Material m;
    m.name = "extreme";
    m.channels.resize(1);
    m.channels.front().name = "R";
    for (const Effect e : all_effects) {
      if (draw_.chance(0.8)) m.components.insert(e);
    }
    if (m.components.empty()) m.components.insert(Effect::dd);
    set_optics(m);
    m.terms.distribution = distribution();
    using enum ShadowingTier;
    m.terms.shadowing = any({li_torrance, smith, schlick, none});
    m.terms.effective_roughness =
        any({EffectiveRoughnessTier::li_torrance, EffectiveRoughnessTier::he, EffectiveRoughnessTier::none});
    m.forms = {any({FsForm::printed, FsForm::reciprocal}), rough(),
               any({AnisotropyForm::consistent, AnisotropyForm::printed})};
    m.surface.slope = extreme(smallest_slope, largest_slope);
    if (draw_.chance(0.4)) m.surface.slope_y = extreme(smallest_slope, largest_slope);
    m.surface.sigma_um = *m.channels.front().wavelength_um * extreme(1e-12, 1e3);
    const double shortest = m.terms.shadowing == smith ? smallest_tail_with_smith : 1.0;
    m.surface.tail = shortest + extreme(1e-9, 1e12);
    m.surface.facet_slope_deg =
        draw_.chance(0.1) ? 0.0 : std::min(extreme(1e-9, largest_facet_slope_deg), largest_facet_slope_deg);
    for (const Coefficient c : all_coefficients) m.channels.front().coefficient(c) = draw_.uniform(0.0, 1.0);
    m.solid_angle_sr = draw_.chance(0.5) ? default_solid_angle_sr : draw_.log_uniform(1e-12, 6.0);
    return m;
  }

  Material peer() {
    Material m;
    m.name = "extreme";
    m.channels.resize(1);
    m.channels.front().name = "R";
    m.model = std::string(
        peer_catalogue()[static_cast<std::size_t>(draw_.one_of(static_cast<int>(peer_catalogue().size())))].name);
    set_optics(m);
    const auto basis = make_peer(m.model);
    for (const ShapeParameter& p : basis->shape_parameters())
      m.parameters[p.name] = std::clamp(extreme(p.lower, p.upper), p.lower, p.upper);
    for (const BasisCoefficient& c : basis->coefficients()) {
      if (!c.constant()) m.channels.front().peer_k[c.name] = draw_.uniform(0.0, 1.0);
    }
    return m;
  }

  Draw draw_;
};

}  // namespace goniofit::test
