#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "inputs.h"

namespace goniofit::truth {

namespace {

/// SplitMix64 (Steele, Lea & Flood 2014).
class Random {
 public:
  double uniform(double low, double high) { return low + (high - low) * static_cast<double>(next() >> 11U) * 0x1p-53; }
  /// Uniform in the logarithm.
  double scale(double low, double high) { return std::pow(10.0, uniform(std::log10(low), std::log10(high))); }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  template <std::size_t n>
  double one_of(const std::array<double, n>& values) {
    return values[static_cast<std::size_t>(next() % n)];
  }

 private:
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }
  std::uint64_t state_ = 20050818;
};

/// The double nearest to four significant digits of x: a short column, and no trace of libm's last bit.
double rounded(double x) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.4g", x);
  return std::strtod(buffer.data(), nullptr);
}

double two_decimals(double x) { return std::round(x * 100) / 100; }

void draw_material(Random& random, Inputs& a) {
  a.slope = rounded(random.scale(1e-3, 1));
  a.slope_y = rounded(std::fmin(1.0, std::fmax(1e-3, a.slope * random.scale(0.25, 4))));
  a.wavelength_um = random.one_of(std::array{0.45, 0.55, 0.65, 1.06, 10.6});
  a.sigma_um = rounded(a.wavelength_um * random.scale(0.01, 10));
  a.tail = rounded(1 + random.scale(0.2, 49));
  a.n = rounded(random.uniform(1, 3));
  a.kappa = random.chance(0.5) ? 0 : rounded(random.scale(1e-3, 8));
  a.facet_slope_deg = rounded(random.uniform(0, 60));
  a.k_dd = two_decimals(random.uniform(0, 1));
  a.k_udf = two_decimals(random.uniform(0, 0.5));
  a.k_uds = two_decimals(random.uniform(0, 1));
  a.k_fs = two_decimals(random.uniform(0, 2));
}

double theta(Random& random) { return rounded(random.uniform(0, 85)); }
double phi(Random& random) { return rounded(random.uniform(0, 360)); }

void general(Random& random, Inputs& a) {
  a.theta_i = theta(random);
  a.phi_i = phi(random);
  a.theta_r = theta(random);
  a.phi_r = phi(random);
}

void in_plane(Random& random, Inputs& a) {
  a.theta_i = theta(random);
  a.theta_r = theta(random);
  a.phi_r = random.chance(0.5) ? 180 : 0;
}

/// Within a few widths of the lobe (half-angle of H about 2 slope), whatever the slope.
void lobe(Random& random, Inputs& a) {
  a.theta_i = theta(random);
  a.phi_i = phi(random);
  const double width_deg = 150 * a.slope;
  a.theta_r = rounded(std::fmin(85, std::fabs(a.theta_i + random.uniform(-width_deg, width_deg))));
  const double turn = width_deg / std::fmax(0.1, std::sin(a.theta_i * 3.14159 / 180));
  const double reach = std::fmin(turn, 90);
  a.phi_r = std::round((a.phi_i + 180 + random.uniform(-reach, reach)) * 1e4) / 1e4;
}

/// phi in quarters of a degree: phi + 180 is exact.
double exact_phi(Random& random) { return std::round(random.uniform(0, 720)) / 4; }

void mirror(Random& random, Inputs& a) {
  a.theta_i = a.theta_r = theta(random);
  a.phi_i = exact_phi(random);
  a.phi_r = a.phi_i + 180;
}

void retro(Random& random, Inputs& a) {
  a.theta_i = a.theta_r = theta(random);
  a.phi_i = a.phi_r = exact_phi(random);
}

void special_angles(Random& random, Inputs& a) {
  constexpr std::array thetas{0.0, 10.0, 15.0, 20.0, 30.0, 40.0, 45.0, 50.0, 60.0, 70.0, 75.0, 80.0, 85.0};
  constexpr std::array phis{0.0, 30.0, 45.0, 60.0, 90.0, 120.0, 135.0, 150.0, 180.0, 225.0, 270.0, 300.0};
  a.theta_i = random.one_of(thetas);
  a.theta_r = random.one_of(thetas);
  a.phi_i = random.one_of(phis);
  a.phi_r = random.one_of(phis);
}

struct Stratum {
  const char* name;
  int rows;
  void (*draw)(Random&, Inputs&);
};

}  // namespace

std::vector<Inputs> ordinary_inputs() {
  constexpr std::array strata{Stratum{"general", 3500, general}, Stratum{"in-plane", 1500, in_plane},
                              Stratum{"lobe", 3000, lobe},       Stratum{"mirror", 600, mirror},
                              Stratum{"retro", 400, retro},      Stratum{"special", 1000, special_angles}};
  Random random;
  std::vector<Inputs> rows;
  for (const Stratum& stratum : strata) {
    for (int i = 0; i < stratum.rows; ++i) {
      Inputs a;
      draw_material(random, a);
      stratum.draw(random, a);
      a.corner = stratum.name;
      rows.push_back(a);
    }
  }
  return rows;
}

}  // namespace goniofit::truth
