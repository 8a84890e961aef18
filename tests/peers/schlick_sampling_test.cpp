#include "peers/schlick_sampling.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "peer_support.h"
#include "peers/schlick.h"
#include "quadrature.h"

namespace goniofit {
namespace {

constexpr int samples = 200000;

// chi² per degree of freedom of draws against a distribution function, in 50 equally likely bins.
template <class Draw, class Cumulative>
double chi2_per_dof(const Draw& draw, const Cumulative& cumulative) {
  constexpr int bins = 50;
  std::vector<double> counts(bins, 0.0);
  for (int i = 0; i < samples; ++i) {
    const double c = cumulative(draw());
    counts[static_cast<std::size_t>(std::clamp(static_cast<int>(c * bins), 0, bins - 1))] += 1.0;
  }
  const double expected = static_cast<double>(samples) / bins;
  double chi2 = 0.0;
  for (const double count : counts) chi2 += (count - expected) * (count - expected) / expected;
  return chi2 / (bins - 1);
}

class Uniform {
 public:
  explicit Uniform(unsigned seed) : random_(seed) {}
  double operator()() { return distribution_(random_); }

 private:
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> distribution_{0.0, 1.0};
};

// A distribution function tabulated from a density by Simpson's rule: independent of any closed inverse.
template <class Density>
std::vector<double> tabulated(const Density& density, double upper) {
  constexpr int n = 20000;
  std::vector<double> table{0.0};
  for (int i = 0; i < n; ++i) {
    const double x = upper * i / n;
    const double h = upper / n;
    table.push_back(table.back() + h / 6.0 * (density(x) + 4.0 * density(x + 0.5 * h) + density(x + h)));
  }
  return table;
}

double looked_up(const std::vector<double>& table, double upper, double x) {
  const double place = x / upper * static_cast<double>(table.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(place), table.size() - 2);
  return table[i] + (place - static_cast<double>(i)) * (table[i + 1] - table[i]);
}

TEST(SchlickSampling, ZenithFollowsZ) {
  for (const double r : {0.02, 0.3, 1.0}) {
    Uniform uniform(41);
    const auto density = [r](double t) { return 2.0 * t * r / std::pow(1.0 + r * t * t - t * t, 2); };
    const std::vector<double> table = tabulated(density, 1.0);
    EXPECT_NEAR(table.back(), 1.0, 1e-6) << r;
    const double chi2 = chi2_per_dof([&] { return 1.0 / std::sqrt(1.0 + schlick_facet_tan2(1.0 - uniform(), r)); },
                                     [&](double t) { return looked_up(table, 1.0, t); });
    EXPECT_LT(chi2, 1.7) << r;
  }
}

// The arctangent samples the normalised A; (29) as printed samples neither form, but the density stated for it.
TEST(SchlickSampling, OnlyTheArctangentFollowsA) {
  const double quarter = 0.5 * pi;
  for (const double p : {0.1, 0.5, 0.9}) {
    const std::vector<double> normalised =
        tabulated([p](double phi) { return schlick_azimuth_normalised(phi, p) / (0.5 * pi); }, quarter);
    std::vector<double> printed = tabulated([p](double phi) { return schlick_azimuth_printed(phi, p); }, quarter);
    for (double& c : printed) c /= printed.back();
    const std::vector<double> drawn =
        tabulated([p](double phi) { return schlick_facet_azimuth_printed_density(phi, p); }, quarter);
    EXPECT_NEAR(normalised.back(), 1.0, 1e-9);
    EXPECT_NEAR(drawn.back(), 1.0, 1e-9);

    Uniform uniform(42);
    const auto exact = [&] { return schlick_facet_azimuth(uniform(), p); };
    const auto as_printed = [&] { return schlick_facet_azimuth_printed(uniform(), p); };
    const auto of = [&](const std::vector<double>& table) {
      return [&table, quarter](double phi) { return looked_up(table, quarter, phi); };
    };
    EXPECT_LT(chi2_per_dof(exact, of(normalised)), 1.7) << p;
    EXPECT_LT(chi2_per_dof(as_printed, of(drawn)), 1.7) << p;
    const double misfit = chi2_per_dof(as_printed, of(normalised));
    const double misfit_printed = chi2_per_dof(as_printed, of(printed));
    std::printf("p %.1f: chi²/dof of (29) against A %.0f, against the printed A %.0f\n", p, misfit, misfit_printed);
    EXPECT_GT(misfit, 50.0) << p;
    EXPECT_GT(misfit_printed, 50.0) << p;
  }
}

// The density of whole directions: its reciprocal sums to the solid angle it covers, and f cos/density to the albedo of
// the lobe, for both forms of A.
TEST(SchlickSampling, DirectionsHaveTheStatedDensity) {
  const double r = 0.4;
  const double p = 0.5;
  const HemispherePoint viewer{40.0, 25.0};
  Uniform uniform(43);
  const auto lobe = [&](const Pair& pair, auto form_tag) {
    constexpr SchlickAzimuth form = decltype(form_tag)::value;
    const double g_i = pair.cos_i + r * pair.one_minus_cos_i;
    const double g_r = pair.cos_r + r * pair.one_minus_cos_r;
    return schlick_zenith(r, pair) * schlick_azimuth<form>(p, pair) / (4.0 * pi * g_i * g_r);
  };
  constexpr std::integral_constant<SchlickAzimuth, SchlickAzimuth::normalised> normalised;
  constexpr std::integral_constant<SchlickAzimuth, SchlickAzimuth::printed> printed;
  double cap = 0.0;
  double albedo = 0.0;
  double albedo_printed = 0.0;
  for (int i = 0; i < samples; ++i) {
    const auto sample = sample_schlick_lobe(viewer, 1.0 - uniform(), uniform(), r, p);
    if (!sample) continue;
    const Pair pair = make_pair({sample->light.theta_deg, sample->light.phi_deg, viewer.theta_deg, viewer.phi_deg});
    if (pair.cos_i > 0.5) cap += 1.0 / sample->density / samples;
    const double weighted = lobe(pair, normalised) * pair.cos_i / sample->density / samples;
    albedo += weighted;
    albedo_printed += weighted * sample->printed_weight;
  }
  EXPECT_NEAR(cap / pi, 1.0, 0.02);  // the cap above 60° has solid angle pi
  // The quadrature's light is at azimuth 0: the surface turned by the viewer's azimuth instead.
  const auto turned = [&](auto form) {
    return test::directional_albedo(
        [&, form](const Pair& seen) {
          Pair pair = seen;
          const double c = cos_deg(viewer.phi_deg);
          const double s = sin_deg(viewer.phi_deg);
          // s_x and s_y up to a common sign, from the sign of their product.
          const double x = std::sqrt(seen.s_x2);
          const double sine = seen.s_y2 > 0.0 ? std::sqrt(seen.s_y2) : 0.0;
          const auto one = [&](double y) {
            pair.s_x2 = (x * c - y * s) * (x * c - y * s);
            pair.s_y2 = (x * s + y * c) * (x * s + y * c);
            return lobe(pair, form);
          };
          return 0.5 * (one(sine) + one(-sine));  // mirror images in the plane come in pairs
        },
        viewer.theta_deg, std::sqrt(r));
  };
  EXPECT_NEAR(albedo, turned(normalised), 0.004);
  EXPECT_NEAR(albedo_printed, turned(printed), 0.004);
  EXPECT_GT(std::fabs(albedo - albedo_printed), 0.002);
}

}  // namespace
}  // namespace goniofit
