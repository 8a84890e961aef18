#include "terms/he_torrance_cells.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "terms/chebyshev_fit.h"
#include "terms/he_torrance.h"
#include "terms/he_torrance_regions.h"

namespace goniofit::he_torrance {
namespace {

using namespace chebyshev;

struct Sample {
  double a, l, value;
};

/// Least squares in products of Chebyshev polynomials, turned into powers. Points at Chebyshev's places come near to
/// the least maximum.
template <class S>
std::array<double, S::size> fit_staircase(const std::vector<Sample>& samples) {
  constexpr std::size_t rows = S::lengths.size();
  constexpr std::size_t longest = *std::max_element(S::lengths.begin(), S::lengths.end());
  Eigen::MatrixXd m(samples.size(), S::size);
  Eigen::VectorXd values(samples.size());
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const auto in_a = chebyshev_values(rows, samples[s].a);
    const auto in_l = chebyshev_values(longest, samples[s].l);
    Eigen::Index column = 0;
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t k = 0; k < S::lengths[i]; ++k) m(static_cast<Eigen::Index>(s), column++) = in_a[i] * in_l[k];
    }
    values[static_cast<Eigen::Index>(s)] = samples[s].value;
  }
  const Eigen::VectorXd x = m.householderQr().solve(values);

  const auto in_a = chebyshev_powers(rows);
  const auto in_l = chebyshev_powers(longest);
  std::array<double, S::size> c{};
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t k = 0; k < S::lengths[i]; ++k) {
      const double at = x[static_cast<Eigen::Index>(S::offset(i) + k)];
      for (std::size_t j = i % 2; j <= i; j += 2) {
        for (std::size_t p = k % 2; p <= k; p += 2) c[S::offset(j) + p] += at * in_a[i][j] * in_l[k][p];
      }
    }
  }
  return c;
}

/// T_i has powers i, i - 2 ... of a: their rows must have room.
template <class S>
constexpr bool descends() {
  for (std::size_t i = 2; i < S::lengths.size(); ++i) {
    if (S::lengths[i] > S::lengths[i - 2]) return false;
  }
  return true;
}

struct Place {
  double r, x;
};

/// Whether (r, x) is in the region or next to it.
template <class Contains>
bool near_region(const Contains& contains, const Place& p) {
  for (const double by_r : {0.98, 1.0, 1.02}) {
    for (const double by_x : {0.96, 1.0, 1.04}) {
      if (contains(p.r * by_r, p.x * by_x)) return true;
    }
  }
  return false;
}

/// f(r, x) at Chebyshev's places l and, for each, Chebyshev's places a of what there is of the region.
template <class S, class PlaceAt, class Contains, class F>
std::array<double, S::size> fit_region(const PlaceAt& place_at, const Contains& contains, const F& f) {
  static_assert(descends<S>());
  constexpr std::size_t na = 2 * S::lengths.size() + 2;
  constexpr std::size_t nl = 2 * *std::max_element(S::lengths.begin(), S::lengths.end()) + 2;
  constexpr int steps = 200;
  std::vector<Sample> samples;
  for (std::size_t k = 0; k < nl; ++k) {
    const double l = place(k, nl);
    double low = 1.0;
    double high = -1.0;
    for (int i = 1; i <= steps; ++i) {
      const double a = 2.0 * i / steps - 1.0;
      if (!near_region(contains, place_at(a, l))) continue;
      low = std::min(low, i == 1 ? -1.0 : a);
      high = a;
    }
    for (std::size_t i = 0; i < na && low < high; ++i) {
      const double a = low + 0.5 * (1.0 + place(i, na)) * (high - low);
      const Place p = place_at(a, l);
      samples.push_back({a, l, f(p.r, p.x)});
    }
  }
  return fit_staircase<S>(samples);
}

template <std::size_t n, class Real>
void assign(std::array<Real, n>& to, const std::array<double, n>& from) {
  std::transform(from.begin(), from.end(), to.begin(), [](double c) { return static_cast<Real>(c); });
}

/// ln v from `low` to `high`.
template <std::size_t length, class Real>
void fit(LogVariable<length, Real>& variable, double low, double high) {
  const double scale = 2.0 / (high - low);
  variable.by_exponent = static_cast<Real>(scale * std::numbers::ln2);
  // m - 1.5 lies in [-1/2, 1/2).
  auto c = fit_line<length>([&](double t) { return scale * (std::log(1.5 + 0.5 * t) - low) - 1.0; });
  for (std::size_t k = 0; k < length; ++k) c[k] = std::ldexp(c[k], static_cast<int>(k));
  assign(variable.of_mantissa, c);
}

/// xi from `xi_low` to `xi_high`, peaks from `least_peak` up.
template <class S, std::size_t log_length, std::size_t decay_length, class Real, class Contains>
void fit(SaddleCell<S, log_length, decay_length, Real>& cell, double xi_low, double xi_high, double least_peak,
         const Contains& contains) {
  using Cell = SaddleCell<S, log_length, decay_length, Real>;
  const double low = std::log1p(Cell::scale * xi_low);
  const double high = std::log1p(Cell::scale * xi_high);
  const auto xi_at = [&](double l) { return std::expm1(low + 0.5 * (1.0 + l) * (high - low)) / Cell::scale; };
  const auto root = fit_line<Cell::root_length>(
      [&](double l) { return std::sqrt(2.0 * least_peak) * std::exp(-0.5 * saddle_exponent(0.0, xi_at(l))); });
  fit(cell.log_variable, low, high);
  assign(cell.root_q, root);
  assign(cell.decay, fit_line<decay_length>([&](double l) { return saddle_decay(xi_at(l)); }));
  const auto place_at = [&](double a, double l) {
    const double r = (1.0 + a) / std::pow(polynomial<Cell::root_length>(root.data(), l), 2);
    return Place{r, xi_at(l) / (r * r)};
  };
  assign(cell.prefactor,
         fit_region<S>(place_at, contains, [](double r, double x) { return log_prefactor(r, x * r * r); }));
}

/// g from `least_g` to `greatest_g`, x up to `greatest_x`.
template <class S, std::size_t log_length, class Real, class Contains>
void fit(OriginCell<S, log_length, Real>& cell, double least_g, double greatest_g, double greatest_x,
         const Contains& contains) {
  using Cell = OriginCell<S, log_length, Real>;
  const double high = std::log1p(Cell::scale * greatest_x);
  const double least_r = 1.0 / greatest_g;
  const double greatest_r = 1.0 / least_g;
  fit(cell.log_variable, 0.0, high);
  cell.a_scale = static_cast<Real>(2.0 / (greatest_r - least_r));
  cell.a_shift = static_cast<Real>(-(greatest_r + least_r) / (greatest_r - least_r));
  const auto place_at = [&](double a, double l) {
    return Place{least_r + 0.5 * (1.0 + a) * (greatest_r - least_r), std::expm1(0.5 * (1.0 + l) * high) / Cell::scale};
  };
  assign(cell.prefactor, fit_region<S>(place_at, contains, [](double r, double x) {
           return log_he_torrance_series(-std::log(r), x) - std::log(r) + x * r;
         }));
}

auto in_fine(fine::Region region) {
  return [region](double r, double x) { return fine_region(r, x) == region; };
}
auto in_coarse(coarse::Region region) {
  return [region](double r, double x) { return coarse_region(r, x) == region; };
}

FineCells fit_fine() {
  FineCells c;
  constexpr double margin = 1.02;  // around the region's bounds of xi
  fit(c.shallow_large, 0.0, margin * deep_xi, 47.0, in_fine(fine::shallow_large));
  fit(c.shallow, 0.0088, margin * deep_xi, 18.6, in_fine(fine::shallow));
  fit(c.deep, deep_xi / margin, margin * greatest_xi, 18.6, in_fine(fine::deep));
  fit(c.shallow_small, 0.055, margin * deep_xi, 11.3, in_fine(fine::shallow_small));
  fit(c.deep_small, deep_xi / margin, 182.0, 11.3, in_fine(fine::deep_small));
  fit(c.origin, 14.9, 70.5, 25.2, in_fine(fine::origin));
  return c;
}

template <class Real>
CoarseCells<Real> fit_coarse() {
  CoarseCells<Real> c;
  fit(c.saddle, 0.0, greatest_xi, 8.0, in_coarse(coarse::saddle));
  fit(c.origin, 8.9, 40.5, 15.2, in_coarse(coarse::origin));
  return c;
}

}  // namespace

const FineCells& FineCells::get() {
  static const FineCells cells = fit_fine();
  return cells;
}

template <class Real>
const CoarseCells<Real>& CoarseCells<Real>::get() {
  static const CoarseCells cells = fit_coarse<Real>();
  return cells;
}
template struct CoarseCells<double>;
template struct CoarseCells<float>;

}  // namespace goniofit::he_torrance
