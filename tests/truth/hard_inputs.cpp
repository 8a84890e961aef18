#include <initializer_list>
#include <string>
#include <utility>

#include "inputs.h"

namespace goniofit::truth {

namespace {

struct Angles {
  double theta_i, phi_i, theta_r, phi_r;
};

/// Rows share a default material (columns.h) but for what `change` makes of it.
class Corners {
 public:
  template <class Change>
  void add(const char* what, const Angles& angles, const Change& change) {
    Inputs a;
    a.theta_i = angles.theta_i;
    a.phi_i = angles.phi_i;
    a.theta_r = angles.theta_r;
    a.phi_r = angles.phi_r;
    a.corner = what;
    change(a);
    rows_.push_back(a);
  }
  void add(const char* what, const Angles& angles) {
    add(what, angles, [](Inputs&) {});
  }
  [[nodiscard]] std::vector<Inputs> take() { return std::move(rows_); }

 private:
  std::vector<Inputs> rows_;
};

constexpr auto slope_of = [](double slope) {
  return [slope](Inputs& a) {
    a.slope = slope;
    a.slope_y = slope * 2;
  };
};

void normal_incidence(Corners& corners) {
  for (const double slope : {0.01, 0.1, 1.0}) {
    for (const double theta : {0.0, 30.0, 85.0, 89.999999}) {
      corners.add("L = N: ln(1-c) is ln 0; fs 0/0 in theta_f; cot theta infinite", {0, 0, theta, 180}, slope_of(slope));
    }
    corners.add("L = N with an azimuth of its own: nothing but the anisotropic terms may read it", {0, 37, 30, 200},
                slope_of(slope));
    corners.add("V = N: ln(1-c_r) is ln 0; theta_f is 90 degrees", {40, 10, 0, 0}, slope_of(slope));
  }
  for (const double theta : {1e-12, 1e-9, 1e-6, 1e-3, 0.1}) {
    corners.add("near normal: 1 - c by subtraction loses its digits; fs of order theta^4", {theta, 0, theta, 180});
    corners.add("near normal: 1 - c_i by subtraction loses its digits", {theta, 12.5, 50, 170});
    corners.add("V near normal: theta_f near 90 degrees; its tangent near infinity", {50, 12.5, theta, 192.5});
  }
}

void grazing(Corners& corners) {
  for (const double slope : {0.001, 0.1, 1.0}) {
    for (const double theta : {89.0, 89.9, 89.999, 89.99999, 89.999999}) {
      corners.add("V grazing: S1/c is 0/0; c from a rounded pi/2 is wrong", {30, 0, theta, 150}, slope_of(slope));
      corners.add("L grazing: S1/c is 0/0; sigma_e vanishes", {theta, 0, 60, 175}, slope_of(slope));
      corners.add("both grazing at the mirror: sigma_e underflows; 1/m_e^2 overflows; T from 1 - F has no digits",
                  {theta, 0, theta, 180}, slope_of(slope));
    }
    corners.add("both grazing near the mirror: exp(-tan^2/4m_e^2)/m_e^2 is 0 times infinity",
                {89.99, 0, 89.99, 180.001}, slope_of(slope));
    corners.add("both grazing sideways: s nearly horizontal; tan theta_b of order 1e7", {89.999999, 0, 89.999999, 90},
                slope_of(slope));
    corners.add("both grazing retro: tan beta sin alpha without bound (Oren-Nayar); |s|^2/s_z huge",
                {89.999999, 0, 89.999999, 0}, slope_of(slope));
    corners.add("one at 89.999999 and one at 89.9999: cosines two orders apart", {89.999999, 0, 89.9999, 179},
                slope_of(slope));
  }
}

void mirror_and_retro(Corners& corners) {
  for (const double slope : {1e-6, 1e-3, 0.1, 10.0}) {
    for (const double theta : {5.0, 45.0, 80.0, 89.9}) {
      corners.add("exact mirror: s_x^2 + s_y^2 must be exactly 0 against 1/m^2", {theta, 0, theta, 180},
                  slope_of(slope));
    }
    corners.add("exact mirror at another azimuth: sines of 217.25 and 37.25 degrees must cancel exactly",
                {45, 37.25, 45, 217.25}, slope_of(slope));
    corners.add("exact retro: 1 - u must be 0; |L - V| cancels", {60, 20, 60, 20}, slope_of(slope));
  }
  for (const double slope : {1e-6, 1e-4, 1e-2}) {
    for (const double widths : {0.1, 1.0, 4.0}) {
      const double off = widths * slope * 100;
      corners.add("near mirror in the plane: s_h^2 by subtraction; amplified by 1/m^2", {55, 0, 55 + off, 180},
                  slope_of(slope));
      corners.add("near mirror out of the plane: s_h^2 by subtraction; amplified by 1/m^2", {55, 0, 55, 180 + off},
                  slope_of(slope));
    }
  }
  for (const double off : {1e-12, 1e-9, 1e-6, 1e-3}) {
    corners.add("near retro: 1 - u by subtraction loses its digits (Schlick's fifth power)", {60, 0, 60 + off, off});
    corners.add("edge of the fs half-plane: cos theta_f near 0; tan^2 near infinity", {50, 0, 60, 90 + off},
                [](Inputs& a) { a.slope = 10; });
  }
  corners.add("fs exactly at its edge: cos(90 degrees) must be 0", {50, 0, 60, 90});
  corners.add("fs exactly at its edge at another azimuth", {50, 37, 60, 127});
  // The mirror cone of 0.0005 sr has a half-angle of 0.7228 degrees.
  for (const double off : {0.5, 0.722, 0.724, 1.0}) {
    corners.add("edge of the mirror cone: 1 - cos of 0.72 degrees", {70, 0, 70 + off, 180});
  }
}

void smooth_and_rough(Corners& corners) {
  for (const double ratio : {1e-7, 1e-6, 1e-4, 1e-2}) {
    for (const double slope : {1e-3, 0.1}) {
      const auto change = [&](Inputs& a) {
        a.slope = slope;
        a.sigma_um = ratio * a.wavelength_um;
      };
      corners.add("sigma to 0: W of order g; an expansion for large g is nonsense", {40, 0, 40, 180}, change);
      corners.add("sigma to 0: W at x/g large", {40, 0, 55, 170}, change);
      corners.add("sigma to 0 near grazing", {89.9, 0, 89.5, 179}, change);
    }
  }
  for (const double ratio : {10.0, 100.0, 1000.0}) {
    for (const double slope : {0.01, 0.2}) {
      const auto change = [&](Inputs& a) {
        a.slope = slope;
        a.sigma_um = ratio * a.wavelength_um;
      };
      corners.add("sigma/lambda large: g^j and j! overflow; e^-g underflows", {20, 0, 20, 180}, change);
      corners.add("sigma/lambda large: thousands of terms matter", {20, 0, 24, 175}, change);
      corners.add("sigma/lambda large at grazing: sigma_e brings g down", {89.99, 0, 89.9, 180}, change);
    }
  }
  for (const double slope : {1e-6, 1e-4, 1e-2}) {
    for (const double ratio : {0.01, 0.3, 3.0}) {
      const auto change = [&](Inputs& a) {
        a.slope = slope;
        a.sigma_um = ratio * a.wavelength_um;
      };
      corners.add("x/g huge: the sum's mass sits far above j = g", {30, 0, 50, 180}, change);
      corners.add("x/g huge and retro", {60, 0, 70, 0}, change);
    }
  }
}

void slopes(Corners& corners) {
  for (const double slope : {1e-6, 1e-5, 1e-3, 1.0, 3.0, 10.0}) {
    corners.add("slope extreme: (1-c)^q underflows or q below 1", {35, 0, 50, 165}, slope_of(slope));
    corners.add("slope extreme at 89.999 degrees: 1 - (1-c)^q by subtraction", {89.999, 0, 30, 165}, slope_of(slope));
    corners.add("slope extreme at the normal", {0.001, 0, 0.001, 180}, slope_of(slope));
    corners.add("slope extreme: fs exponent over 16 m_e^2", {75, 0, 75, 180}, slope_of(slope));
  }
  for (const double ratio : {1e-4, 1e-2, 1e2, 1e4}) {
    const auto change = [&](Inputs& a) {
      a.slope = 0.05;
      a.slope_y = 0.05 * ratio;
    };
    corners.add("axis ratio extreme: s_x and s_y apart lose what their sum keeps", {40, 30, 42, 212}, change);
    corners.add("axis ratio extreme along x", {40, 0, 42, 180}, change);
    corners.add("axis ratio extreme along y: cos(90 degrees) must be 0", {40, 90, 42, 270}, change);
  }
}

void optics(Corners& corners) {
  for (const auto& [n, kappa] : {std::pair{1.0, 0.0},
                                 {1.000000001, 0.0},
                                 {1.0, 1e-8},
                                 {1.5, 0.0},
                                 {1.5, 1e-8},
                                 {1.5, 1e-3},
                                 {0.05, 10.0},
                                 {0.618, 5.47},
                                 {1.5, 1e6},
                                 {1e-3, 1e3},
                                 {50.0, 0.0}}) {
    const auto change = [&](Inputs& a) {
      a.n = n;
      a.kappa = kappa;
    };
    corners.add("extreme index at the normal: a - u cancels for n near 1", {0, 0, 0, 0}, change);
    corners.add("extreme index at 45 degrees: b cancels for small kappa", {45, 0, 45, 180}, change);
    corners.add("extreme index near Brewster: Rp vanishes", {56.31, 0, 56.31, 180}, change);
    corners.add("extreme index at grazing: Rp is 0/0 at u = 0; T from 1 - F has no digits",
                {89.999999, 0, 89.999999, 180}, change);
    corners.add("extreme index off the mirror", {30, 0, 70, 100}, change);
  }
}

void tails_and_facets(Corners& corners) {
  for (const double tail : {1.0001, 1.2, 2.0, 50.0, 1e6}) {
    const auto change = [&](Inputs& a) { a.tail = tail; };
    corners.add("tail extreme: (tail-1)^tail and its counterpart each leave the range", {30, 0, 60, 180}, change);
    corners.add("tail extreme at the mirror", {60, 0, 60, 180}, change);
    corners.add("tail extreme at grazing", {89.99, 0, 89.99, 179.9}, change);
  }
  for (const double facet : {0.0, 1e-6, 90.0}) {
    const auto change = [&](Inputs& a) { a.facet_slope_deg = facet; };
    corners.add("Oren-Nayar: facets flat or vertical; forward side", {60, 0, 70, 180}, change);
    corners.add("Oren-Nayar: facets flat or vertical; both grazing", {89.999999, 0, 89.999999, 0}, change);
    corners.add("Oren-Nayar: C2 jumps at 90 degrees but is multiplied by 0", {60, 0, 70, 90}, change);
  }
}

void combinations(Corners& corners) {
  for (const double slope : {1e-6, 1e-3, 10.0}) {
    for (const double ratio : {1e-7, 1000.0}) {
      const auto change = [&](Inputs& a) {
        a.slope = slope;
        a.slope_y = slope * 3;
        a.sigma_um = ratio * a.wavelength_um;
        a.n = 1.000000001;
        a.kappa = 1e-8;
        a.tail = 1.2;
      };
      corners.add("all at once at the grazing mirror", {89.999999, 0, 89.999999, 180}, change);
      corners.add("all at once near the normal", {1e-9, 0, 1e-6, 180}, change);
      corners.add("all at once retro at grazing", {89.999, 10, 89.999, 10}, change);
      corners.add("all at once off the mirror", {45, 0, 46, 178}, change);
    }
  }
}

}  // namespace

std::vector<Inputs> hard_inputs() {
  Corners corners;
  normal_incidence(corners);
  grazing(corners);
  mirror_and_retro(corners);
  smooth_and_rough(corners);
  slopes(corners);
  optics(corners);
  tails_and_facets(corners);
  combinations(corners);
  return corners.take();
}

std::vector<LobeInputs> lobe_inputs() {
  std::vector<LobeInputs> rows;
  for (const double g : {1e-12, 1e-6, 1e-3, 0.03, 0.25,  0.7,   1.0,    1.7, 3.0, 6.5, 10.0, 20.0,
                         31.0,  33.0, 50.0, 99.0, 101.0, 400.0, 2500.0, 2e4, 3e5, 1e6, 1e8}) {
    for (const double y : {0.0, 1e-6, 0.01, 0.3, 1.0, 4.0, 15.0, 40.0, 200.0, 3948.0, 1e5, 1e8})
      rows.push_back({g, y * g});
  }
  return rows;
}

}  // namespace goniofit::truth
