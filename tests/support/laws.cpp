#include "support/laws.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "basis/optics.h"
#include "brdf/evaluator.h"
#include "fit/surface_basis.h"
#include "geometry/angles.h"
#include "peers/peers.h"
#include "support/albedo.h"
#include "support/random_directions.h"

namespace goniofit::test {

namespace {

// Below, the batch's exponentials, which end at e^-700, differ: times sec⁴ theta_b/(cos_i cos_r) at 90 - 1e-14 degrees
// that is 1e-210. It is zero for any purpose.
constexpr double nothing = 1e-205;

double slack(double f, double precision) { return precision * f * (1.0 + std::fabs(std::log(std::max(f, nothing)))); }

std::string text(const AnglePair& a) {
  char out[160];
  std::snprintf(out, sizeof out, "%.17g, %.17g -> %.17g, %.17g", a.theta_i_deg, a.phi_i_deg, a.theta_r_deg,
                a.phi_r_deg);
  return out;
}

bool in_domain(const Pair& p) { return p.cos_i > 0.0 && p.cos_r > 0.0; }
bool in_cone(const Material& m, const Pair& p) { return p.mirror_distance2 <= m.solid_angle_sr / pi; }

std::vector<AnglePair> random_pairs(int count, unsigned seed) {
  Draw draw(seed);
  std::vector<AnglePair> out;
  while (static_cast<int>(out.size()) < count) {
    const AnglePair a = draw.angles();
    if (in_domain(make_pair(a))) out.push_back(a);
  }
  return out;
}

// Whole degrees, so that turning and mirroring them rounds nothing.
std::vector<AnglePair> random_pairs_of_whole_azimuths(int count, unsigned seed) {
  std::vector<AnglePair> out = random_pairs(count, seed);
  for (AnglePair& a : out) {
    a.phi_i_deg = std::floor(a.phi_i_deg);
    a.phi_r_deg = std::floor(a.phi_r_deg);
  }
  return out;
}

// The material as fits see it.
struct AsBasis {
  std::unique_ptr<const Basis> basis;
  std::vector<double> z;
  const Material& material;

  explicit AsBasis(const Material& m) : material(m) {
    const Surface& s = m.surface;
    if (m.model == surface_model) {
      const ShapeSettings settings = ShapeSettings::of(m.terms, m.forms, s.anisotropic());
      basis = std::make_unique<SurfaceBasis>(m.components, settings, m.solid_angle_sr);
    } else {
      basis = make_peer(m.model, m.solid_angle_sr);
    }
    for (const ShapeParameter& p : basis->shape_parameters()) {
      const double value = m.model == surface_model ? **Surface(s).find(p.name) : *m.parameters.at(p.name);
      z.push_back(std::log(value - p.origin));
    }
  }

  [[nodiscard]] std::size_t columns() const { return basis->columns().size(); }
  [[nodiscard]] double wavelength_um() const { return material.channels[0].wavelength_um.value_or(1.0); }

  /// First channel.
  template <class FactorOf>
  [[nodiscard]] double value(const Pair& p, const FactorOf& factor_of) const {
    const MaterialChannel& c = material.channels[0];
    const ChannelOptics optics =
        c.f0 ? ChannelOptics::of_reflectance(*c.f0) : ChannelOptics::of_index(c.n.value_or(1.0), c.kappa.value_or(0.0));
    double sum = 0.0;
    for (std::size_t j = 0; j < columns(); ++j) {
      const BasisColumn& column = basis->columns()[j];
      const BasisCoefficient& coefficient = basis->coefficients()[column.coefficient];
      const double k = coefficient.constant() ? coefficient.lower : c.coefficient(coefficient.name).value_or(0.0);
      sum += std::pow(k, column.power) * optics_factor(column.optics, material.terms.fresnel, optics, p) * factor_of(j);
    }
    return sum;
  }
};

// Rows of arrays in the shape that batches write.
struct Table {
  Table(std::size_t rows, std::size_t pairs) : data(rows, std::vector<double>(pairs)) {
    for (std::vector<double>& row : data) pointers.push_back(row.data());
  }
  std::vector<std::vector<double>> data;
  std::vector<double*> pointers;
};

// Differences of f among its two orders, of what the case does not except.
void check_reciprocity(const Evaluator& e, const LawCase& c, const AnglePair& a, std::optional<Effect> effect) {
  const auto value = [&](const Pair& p) { return effect ? e.value(p, 0, *effect) : e.value(p, 0); };
  const double there = value(make_pair(a));
  const double back = value(make_pair(swapped(a)));
  if (there >= saturation || back >= saturation) return;
  ASSERT_NEAR(there, back, slack(there, 100.0 * c.precision) + nothing)
      << text(a) << (effect ? " " + std::string(name_of(*effect)) : "");
}

double measured_irreciprocity(const Evaluator& e, const std::vector<AnglePair>& pairs) {
  double difference = 0.0;
  double largest = 0.0;
  for (const AnglePair& a : pairs) {
    const double there = e.value(make_pair(a), 0);
    const double back = e.value(make_pair(swapped(a)), 0);
    difference = std::max(difference, std::fabs(there - back));
    largest = std::max({largest, there, back});
  }
  return difference / largest;
}

bool anisotropic(const Material& m) {
  if (m.model == surface_model) return m.surface.anisotropic();
  const auto basis = make_peer(m.model);
  const auto& shape = basis->shape_parameters();
  return std::any_of(shape.begin(), shape.end(),
                     [](const ShapeParameter& p) { return p.name == "alpha_y" || p.name == "p" || p.name == "p_1"; });
}

std::vector<double> azimuths_of(const Material& m) {
  return anisotropic(m) ? std::vector<double>{0.0, 42.5, 90.0} : std::vector<double>{0.0};
}

}  // namespace

std::vector<AnglePair> in_plane_grid() {
  std::vector<AnglePair> out;
  for (double i = 5.0; i < 90.0; i += 5.0) {
    for (double r = 5.0; r < 90.0; r += 5.0) out.push_back(in_plane(i, r));
  }
  return out;
}

std::vector<AnglePair> edge_of_mirror_cone() {
  const double half_angle = degrees(std::acos(1.0 - default_solid_angle_sr / (2.0 * pi)));
  return {in_plane(80.0, 80.0 + (1.0 - 1e-9) * half_angle)};
}

void expect_same(const Material& a, const Material& b, double tolerance, int directions) {
  const Evaluator one(a);
  const Evaluator other(b);
  double worst = 0.0;
  for (const AnglePair& at : random_pairs(directions, 31)) {
    const double f = one.value(make_pair(at), 0);
    const double g = other.value(make_pair(at), 0);
    if (f < nothing && g < nothing) continue;
    worst = std::max(worst, std::fabs(f - g) / slack(g, 1.0));
    ASSERT_NEAR(f, g, slack(g, tolerance)) << text(at);
  }
  testing::Test::RecordProperty("largest_difference", std::to_string(worst));
}

TEST_P(Laws, FiniteAndNotNegative) {
  const LawCase& c = GetParam();
  const Evaluator e(c.material);
  for (const AnglePair& a : random_pairs(c.directions, 21)) {
    for (std::size_t channel = 0; channel < e.channels(); ++channel) {
      const double f = e.value(make_pair(a), channel);
      ASSERT_TRUE(std::isfinite(f) && f >= 0.0 && f <= saturation) << f << " at " << text(a);
    }
  }
}

TEST_P(Laws, Reciprocal) {
  const LawCase& c = GetParam();
  const Evaluator e(c.material);
  const bool printed = c.irreciprocity && c.material.forms.fs == FsForm::printed;
  for (const AnglePair& a : random_pairs(c.directions, 22)) {
    if (c.irreciprocity && in_cone(c.material, make_pair(a))) continue;
    if (c.material.model != surface_model) check_reciprocity(e, c, a, std::nullopt);
    for (const Effect effect : all_effects) {
      if (!c.material.components.has(effect) || (printed && effect == Effect::fs)) continue;
      check_reciprocity(e, c, a, effect);
    }
    if (HasFatalFailure()) return;
  }
  if (!c.irreciprocity) return;
  const double stated = c.irreciprocity->of_largest;
  EXPECT_NEAR(measured_irreciprocity(e, c.irreciprocity->pairs), stated, 0.1 * stated);
}

TEST_P(Laws, ReflectsNoMoreThanItReceivesOrAsMuchAsStated) {
  const LawCase& c = GetParam();
  constexpr double quadrature = 2e-5;
  std::string row;
  for (const double phi : azimuths_of(c.material)) {
    for (const double theta : {0.0, 30.0, 60.0, 80.0, 85.0, 89.0}) {
      if (theta > std::max(c.conserves_up_to_deg, 85.0)) continue;
      const double albedo = directional_albedo(c.material, theta, phi);
      row += (theta == 0.0 ? " | " : " ") + std::to_string(albedo).substr(0, 6);
      EXPECT_GE(albedo, 0.0) << theta << " " << phi;
      if (theta < c.conserves_from_deg || theta > c.conserves_up_to_deg) continue;
      EXPECT_LE(albedo, 1.0 + quadrature) << theta << " " << phi;
    }
  }
  std::printf("albedo of %-40s%s", c.name.c_str(), row.c_str());
  for (const Excess& x : c.excess) {
    const double albedo = directional_albedo(c.material, x.theta_i_deg, x.phi_i_deg);
    std::printf(", %.3f at %g", albedo, x.theta_i_deg);
    EXPECT_GT(x.albedo, 1.0) << "no excess";
    EXPECT_NEAR(albedo, x.albedo, 0.02 * x.albedo) << x.theta_i_deg << " " << x.phi_i_deg;
  }
  std::printf("\n");
}

TEST_P(Laws, HasItsSymmetry) {
  const LawCase& c = GetParam();
  const Evaluator e(c.material);
  const bool has_axes = anisotropic(c.material);
  bool changed = false;
  for (const AnglePair& a : random_pairs_of_whole_azimuths(std::min(c.directions, 200), 23)) {
    const double f = e.value(make_pair(a), 0);
    const auto turned = [&](double by) {
      return e.value(make_pair({a.theta_i_deg, a.phi_i_deg + by, a.theta_r_deg, a.phi_r_deg + by}), 0);
    };
    const auto mirrored = [&](double axis) {
      return e.value(make_pair({a.theta_i_deg, axis - a.phi_i_deg, a.theta_r_deg, axis - a.phi_r_deg}), 0);
    };
    // Only the azimuth difference is read, and it is the same to the last bit.
    if (!has_axes) {
      for (const double by : {37.0, 90.0, 180.0}) ASSERT_EQ(f, turned(by)) << text(a) << " turned by " << by;
      ASSERT_EQ(f, mirrored(0.0)) << text(a);
      continue;
    }
    const double allowed = slack(f, 1e-12) + nothing;
    ASSERT_NEAR(f, turned(180.0), allowed) << text(a);
    ASSERT_NEAR(f, mirrored(0.0), allowed) << text(a);
    ASSERT_NEAR(f, mirrored(180.0), allowed) << text(a);
    changed = changed || std::fabs(f - turned(90.0)) > 1e-3 * f;
  }
  EXPECT_EQ(changed, has_axes);
}

TEST_P(Laws, ArithmeticsAgree) {
  const LawCase& c = GetParam();
  const Evaluator e(c.material);
  const AsBasis b(c.material);
  const std::vector<AnglePair> angles = random_pairs(c.directions, 24);
  const PairBatch pairs(angles);
  const std::size_t parameters = b.z.size();
  Table batch(b.columns(), pairs.size());
  Table duals(b.columns(), pairs.size());
  Table derivatives(b.columns() * parameters, pairs.size());
  b.basis->shape_factors(pairs, b.z, b.wavelength_um(), batch.pointers);
  b.basis->shape_factors(pairs, b.z, b.wavelength_um(), duals.pointers, derivatives.pointers);
  std::vector<double> one(b.columns());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Pair p = pairs[i];
    const double f = e.value(p, 0);
    if (f >= saturation || e.cut_at_zero(p)) continue;  // a basis does neither
    const double allowed = slack(f, c.precision) + nothing;
    b.basis->shape_factors(p, b.z, b.wavelength_um(), one);
    ASSERT_NEAR(b.value(p, [&](std::size_t j) { return one[j]; }), f, allowed) << "one pair: " << text(angles[i]);
    ASSERT_NEAR(b.value(p, [&](std::size_t j) { return batch.data[j][i]; }), f, allowed)
        << "batch: " << text(angles[i]);
    ASSERT_NEAR(b.value(p, [&](std::size_t j) { return duals.data[j][i]; }), f, allowed) << "dual: " << text(angles[i]);
  }
}

TEST_P(Laws, DerivativesAreThoseOfTheValues) {
  const LawCase& c = GetParam();
  const AsBasis b(c.material);
  const std::size_t parameters = b.z.size();
  const std::vector<AnglePair> angles = random_pairs(std::min(c.directions, 200), 25);
  const PairBatch pairs(angles);
  Table values(b.columns(), pairs.size());
  Table derivatives(b.columns() * parameters, pairs.size());
  b.basis->shape_factors(pairs, b.z, b.wavelength_um(), values.pointers, derivatives.pointers);
  for (std::size_t k = 0; k < parameters; ++k) {
    constexpr double h = 2e-4;
    std::vector<Table> at;
    for (const double step : {-2.0 * h, -h, h, 2.0 * h}) {
      std::vector<double> moved = b.z;
      moved[k] += step;
      b.basis->shape_factors(pairs, moved, b.wavelength_um(), at.emplace_back(b.columns(), pairs.size()).pointers);
    }
    for (std::size_t j = 0; j < b.columns(); ++j) {
      if (!b.basis->columns()[j].reads_shape) continue;
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        const double f = std::fabs(values.data[j][i]);
        const double ours = derivatives.data[j * parameters + k][i];
        if (f < saturation) {
          ASSERT_TRUE(std::isfinite(ours)) << ours << ", value " << f << ", column " << j << " by "
                                           << b.basis->shape_parameters()[k].name << " at " << text(angles[i]);
        }
        const double steepness = std::fabs(ours) / (f + 1e-300);
        if (f < c.differentiable_above || f > saturation || steepness > 20.0) continue;
        const double theirs =
            (at[0].data[j][i] - 8.0 * at[1].data[j][i] + 8.0 * at[2].data[j][i] - at[3].data[j][i]) / (12.0 * h);
        // The differences' own error: h⁴ times a fifth derivative (of exp(-e), e ~ m_e^-2 of an exponent much steeper
        // than e itself towards grazing), and round-off over h.
        ASSERT_NEAR(ours, theirs, f * (c.derivative_precision + 1e-11 * std::pow(1.0 + steepness, 5.0)))
            << "column " << j << " by " << b.basis->shape_parameters()[k].name << " at " << text(angles[i]);
      }
    }
  }
}

}  // namespace goniofit::test
