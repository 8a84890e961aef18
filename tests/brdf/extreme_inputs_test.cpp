// A loop over random materials and directions at the limits of what is valid: no value may be negative, infinite or
// not a number. GONIOFIT_EXTREME_INPUTS sets how many evaluations (a million if it is not set; a hundred million a
// night). Each number of evaluations draws the same materials and directions every time.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "brdf/evaluator.h"
#include "fit/surface_basis.h"
#include "support/extreme_materials.h"
#include "support/materials.h"

namespace goniofit {
namespace {

using test::Draw;

struct Counts {
  std::size_t evaluations = 0;  ///< of a pair of directions above the horizon
  std::size_t materials = 0;
  std::size_t zero = 0;       ///< the whole value
  std::size_t saturated = 0;  ///< at 1e300
  std::size_t cut = 0;        ///< Oren and Nayar's functional form below 0
  std::size_t in_cone = 0;    ///< with a coherent part
  std::size_t failures = 0;
  std::vector<std::string> examples;

  void add(const Counts& other) {
    evaluations += other.evaluations;
    materials += other.materials;
    zero += other.zero;
    saturated += other.saturated;
    cut += other.cut;
    in_cone += other.in_cone;
    failures += other.failures;
    examples.insert(examples.end(), other.examples.begin(), other.examples.end());
  }
};

std::string numbers(const std::vector<double>& values) {
  std::string out;
  for (const double v : values) {
    std::array<char, 40> digits{};
    std::snprintf(digits.data(), digits.size(), " %.17g", v);
    out += digits.data();
  }
  return out;
}

std::string description(const Material& m) {
  std::ostringstream out;
  const MaterialChannel& c = m.channels.front();
  out << m.model << " F " << name_of(m.terms.fresnel);
  out << " n, kappa, lambda" << numbers({c.n.value_or(0), c.kappa.value_or(0), c.wavelength_um.value_or(0)});
  for (const auto& [name, value] : m.parameters) out << " " << name << numbers({*value});
  if (m.model != surface_model) return out.str();
  out << " S " << name_of(m.terms.shadowing) << " sigma_e " << name_of(m.terms.effective_roughness) << " D "
      << name_of(m.terms.distribution) << " fs " << name_of(m.forms.fs) << " rough " << name_of(m.forms.rough) << " k "
      << name_of(m.forms.anisotropy);
  Surface s = m.surface;
  for (const std::string_view name : surface_parameter_names) {
    if (*s.find(name)) out << " " << name << numbers({**s.find(name)});
  }
  return out.str();
}

class Loop {
 public:
  explicit Loop(std::uint64_t seed) : materials_(seed) {}

  Counts run(std::size_t evaluations) {
    constexpr int directions_each = 25;
    while (counts_.evaluations < evaluations) {
      const Evaluator e(materials_.next());
      ++counts_.materials;
      // An integral over grooves takes as long as thousands of anything else.
      const bool slow = e.material().components.has(Effect::rough) && e.material().forms.rough == RoughForm::integral;
      for (int i = 0; i < (slow ? 2 : directions_each); ++i) evaluate(e);
    }
    return counts_;
  }

 private:
  // Angles, or vectors whose cosines are smaller than those of any angle; then their mirror and retro directions too.
  Pair pair() {
    Draw& d = materials_.draw();
    if (d.chance(0.7)) {
      angles_ = d.angles();
      return make_pair(angles_);
    }
    l_ = d.grazing_direction();
    v_ = d.chance(0.5) ? d.grazing_direction() : direction_of(d.theta(), d.uniform(-180, 180));
    if (d.chance(0.2)) v_ = mirrored(l_);
    if (d.chance(0.1)) v_ = l_;
    if (d.chance(0.5)) std::swap(l_, v_);
    angles_ = angles_of(l_, v_);
    return make_pair(l_, v_);
  }

  void evaluate(const Evaluator& e) {
    const Pair p = pair();
    if (!(p.cos_i > 0.0) || !(p.cos_r > 0.0)) return;
    ++counts_.evaluations;
    double sum = 0.0;
    bool sound = true;
    for (const Effect effect : all_effects) {
      const double f = e.value(p, 0, effect);
      sound = sound && f >= 0.0 && f <= saturation;  // false of NaN
      sum += f;
      if (effect == Effect::coh && f > 0.0) ++counts_.in_cone;
    }
    const double f = e.material().model == surface_model ? std::min(sum, saturation) : e.value(p, 0);
    if (f == 0.0) ++counts_.zero;
    if (f == saturation) ++counts_.saturated;
    if (e.cut_at_zero(p)) ++counts_.cut;
    if (!sound || !(f >= 0.0) || !(f <= saturation)) report(e, p);
  }

  void report(const Evaluator& e, const Pair& p) {
    constexpr std::size_t enough = 8;
    ++counts_.failures;
    if (counts_.examples.size() >= enough) return;
    std::vector<double> parts;
    for (const Effect effect : all_effects) parts.push_back(e.value(p, 0, effect));
    counts_.examples.push_back(
        description(e.material()) + "\n  cosines" + numbers({p.cos_i, p.cos_r}) + ", angles" +
        numbers({angles_.theta_i_deg, angles_.phi_i_deg, angles_.theta_r_deg, angles_.phi_r_deg}) + "\n  effects" +
        numbers(parts) + ", value" + numbers({e.value(p, 0)}));
  }

  test::ExtremeMaterials materials_;
  Counts counts_;
  AnglePair angles_;
  Direction l_, v_;
};

std::size_t evaluations_wanted() {
  const char* const set = std::getenv("GONIOFIT_EXTREME_INPUTS");
  return set != nullptr ? std::strtoull(set, nullptr, 10) : 1000000;
}

TEST(ExtremeInputs, GiveNoNegativeInfiniteOrUndefinedValue) {
  const std::size_t wanted = evaluations_wanted();
  ASSERT_GT(wanted, 0U) << "GONIOFIT_EXTREME_INPUTS";
  std::array<Counts, 2> half;
  std::array<std::thread, 2> threads;
  for (std::size_t i = 0; i < threads.size(); ++i) {
    threads[i] = std::thread([&half, i, wanted] { half[i] = Loop(1000 + i).run((wanted + 1) / 2); });
  }
  for (std::thread& t : threads) t.join();
  Counts all = half[0];
  all.add(half[1]);
  std::printf("%zu evaluations of %zu materials: %zu zero, %zu saturated, %zu cut at zero, %zu with a coherent part\n",
              all.evaluations, all.materials, all.zero, all.saturated, all.cut, all.in_cone);
  for (const std::string& example : all.examples) ADD_FAILURE() << example;
  EXPECT_EQ(all.failures, 0U);
  // The corners were drawn.
  EXPECT_GT(all.saturated, all.evaluations / 10000);
  EXPECT_GT(all.cut, all.evaluations / 10000);
  EXPECT_GT(all.in_cone, all.evaluations / 10000);
}

// What the loop has found; each stays a test of its own.

Material mirror_like(double slope) {
  Material m = test::ground_glass_41();
  m.components = {Effect::dd};
  m.surface = {.slope = slope};
  return m;
}

// The lobe is infinite and F is 0.
TEST(ExtremeInputs, WithoutAnInterfaceNothingReflects) {
  Material m = mirror_like(1e-5);
  m.terms.fresnel = FresnelTier::exact;
  m.channels[0].n = 1.0;
  m.channels[0].kappa = 0.0;
  const Pair mirror = make_pair(in_plane(89.9999, 89.9999));
  EXPECT_EQ(Evaluator(m).value(mirror, 0), 0.0);
  m.channels[0].n = 1.5;
  EXPECT_EQ(Evaluator(m).value(mirror, 0), saturation);
}

// sec⁴ theta_b of such directions is infinite, e^-tan² is 0.
TEST(ExtremeInputs, DirectionsAHairAboveTheHorizonHaveValues) {
  for (const double cosine : {1e-60, 1e-200, 1e-300}) {
    const Direction l{1.0, 0.0, cosine};
    for (const Direction& v : {l, mirrored(l), Direction{0.0, 1.0, cosine}, Direction{0.0, 0.0, 1.0}}) {
      for (const Material& m : {test::ground_glass_41(), test::he_ground_glass(), test::long_tailed_paint()}) {
        const double f = Evaluator(m).value(make_pair(l, v), 0);
        EXPECT_TRUE(f >= 0.0 && f <= saturation) << f << " " << m.name;
      }
    }
  }
  EXPECT_EQ(make_pair(Direction{1.0, 0.0, 0.0}, Direction{}).cos_i, 0.0);  // on it is outside still
}

// 1 - F was 1 - (1 - u)⁵ there, -1e-16 by rounding, times a value of 1e98.
TEST(ExtremeInputs, WhatAClearLayerLeavesIsNotNegative) {
  Material m;
  m.name = m.model = "schlick-double";
  m.parameters = {{"r_1", 1.0}, {"p_1", 0.71}, {"r_2", 0.15}, {"p_2", 0.06}};
  m.channels.resize(1);
  m.channels[0].name = "R";
  m.channels[0].f0 = 0.9;
  m.channels[0].peer_k["C_2"] = 0.5;
  const Evaluator e(m);
  for (double phi = 0.0; phi < 360.0; phi += 1.0) {
    const Direction flat = direction_of(90.0, phi);
    const Direction l{flat.x, flat.y, 1e-50};
    ASSERT_GE(e.value(make_pair(l, mirrored(l)), 0), 0.0) << phi;
  }
}

// The integral's direct part is 1 less what is missing of it: -1e-16 by rounding where nothing is left.
TEST(ExtremeInputs, GroovesAtDoubleForwardGrazingAreNotNegative) {
  Material m = test::rough_plaster();
  m.components = {Effect::rough};
  m.forms.rough = RoughForm::integral;
  // Facet slopes and azimuths at which it was so.
  for (const auto& [facet_slope, phi] : {std::pair{7.2558255158308584e-09, -169.95433062915839},
                                         std::pair{4.5832759205656211e-07, -60.346808654161578}}) {
    m.surface.facet_slope_deg = facet_slope;
    const Direction flat = direction_of(90.0, phi);
    const Direction l{flat.x, flat.y, 1e-50};
    EXPECT_GE(Evaluator(m).value(make_pair(l, mirrored(l)), 0), 0.0) << phi << " " << facet_slope;
  }
}

// A lobe that sigma_e makes infinitely narrow: e^-infinity has the derivative 0, not 0 * infinity.
TEST(ExtremeInputs, DerivativesBesideAnInfinitelyNarrowLobeAreZero) {
  Material m = mirror_like(0.1);
  m.surface.slope_y = 0.01;
  m.forms.anisotropy = AnisotropyForm::printed;
  const SurfaceBasis basis(m.components, ShapeSettings::of(m.terms, m.forms, true), m.solid_angle_sr);
  const PairBatch pair({{89.999999999999574, -108.96541155844255, 89.999999999998096, 71.034588441557446}});
  const std::array<double, 2> z{std::log(0.1), std::log(0.01)};
  double value = -1.0;
  std::array<double, 2> by{-1.0, -1.0};
  const std::array<double*, 1> values{&value};
  const std::array<double*, 2> derivatives{by.data(), by.data() + 1};
  basis.shape_factors(pair, z, 0.55, values, derivatives);
  EXPECT_EQ(value, 0.0);
  EXPECT_EQ(by[0], 0.0);
  EXPECT_EQ(by[1], 0.0);
}

}  // namespace
}  // namespace goniofit
