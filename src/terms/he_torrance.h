#pragma once
// Tier `he-torrance`: ln W(g, x) of He et al. 1991 (see he_torrance_series.h) fast, W within 1e-9 for every g > 0 and
// x >= 0; measured: 2.7e-10, derivatives 5e-9 of 1 + |d| with respect to ln g, 1.3e-8 relatively with respect to x.
//
//   ln g in [-2, 3.6)  polynomials in (ln g, x), found by the bits of 1 + h x: no transcendental at all
//   ln g >= 3.6        -ln g - y G(xi) + P(1/g, xi), y = x/g, xi = x/g²: G and P as polynomials, one exponential
//   ln g < -2          the sum from j = 1 for x < 600
//   beyond these       (W < 1e-290, but for g < e^-2) the saddle point where its peak is above 100, else the sum
//
// ns a value, scalar, one core of a 2.6 GHz server, SSE2 / AVX2 with FMA: 19 / 13, 29 / 20 from ln g = 3.6, 43 below
// -2; with the derivatives 34 / 27, 48 / 34 and 54. For comparison, the sum around its peak takes 200 ns (small g) to
// 6000 (g = 3000), the saddle point with Lambert's W inside 190.
//
// Tried: total degree 7 and 8 on the same rectangles (W to 3e-8, 4e-9), columns of half octaves (5e-8), rows of twice
// the height (2e-8), h = 1/(0.4 + g²/8) (7e-8: near x = 0 at g = 10 to 30, the missing j = 0 is a term e^(-g-x) of its
// own scale). The coefficients (0.45 MB) come from the sum and the saddle point when first needed, some 50 ms once a
// process, and so cannot disagree with them.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "chebyshev_patch.h"
#include "he_torrance_saddle.h"
#include "he_torrance_series.h"

namespace goniofit {

/// ln W and its derivatives.
using HeTorranceW = LogW<double>;

namespace he_torrance {

/// W below e^-669 = 1e-290.6 is left to the sum and the saddle point.
inline constexpr double log_w_covered = -669.0;

/// Saddle point or sum, whichever holds; at any g and x.
template <bool with_derivatives>
[[nodiscard]] inline HeTorranceW log_w_anywhere(double log_g, double x) {
  const double w = saddle_exponent(log_g, x);
  const double peak = std::exp(log_g + w);
  if (peak > 100.0 && peak > 2.0 * (1.0 + 2.0 * w)) return log_w_at_saddle(log_g, x, w);
  return log_series<with_derivatives>(log_g, x, w);
}

/// Where v = 1 + h x >= 1 lies among the quarters of octaves: t in [-1, 1) and dt/dv.
struct Column {
  std::size_t index;
  double t, by_v;

  [[nodiscard]] static Column of(double v) {
    constexpr int low_bits = 50;  // of the mantissa: the two above number the quarter
    constexpr std::uint64_t one = std::uint64_t{1023} << 52;
    const auto bits = std::bit_cast<std::uint64_t>(v);
    const auto low = std::bit_cast<double>((bits & ((std::uint64_t{1} << low_bits) - 1)) | one);
    const auto inverse_octave = std::bit_cast<double>((std::uint64_t{2046} - (bits >> 52)) << 52);
    return {(bits - one) >> low_bits, 8.0 * low - 9.0, 8.0 * inverse_octave};
  }
  [[nodiscard]] static double start(std::size_t index) {
    return std::ldexp(1.0 + 0.25 * static_cast<double>(index % 4), static_cast<int>(index / 4));
  }
  /// v at t.
  [[nodiscard]] static double v_at(std::size_t index, double t) {
    const double a = start(index);
    const double b = start(index + 1);
    return a + 0.5 * (1.0 + t) * (b - a);
  }
};

/// ln W over (ln g, x) for ln g in [-2, 3.6). With h = 1/(0.4 + g²/64) the quarter octaves resolve the
/// smallest j at x of a few units (a relative e^-g - x) as well as the tail.
class ModerateRoughness {
 public:
  static constexpr double begin = -2.0, end = 3.6;

  ModerateRoughness() {
    for (std::size_t r = 0; r < rows; ++r) add_row(r);
  }

  /// False where x is beyond the table.
  template <bool with_derivatives>
  [[nodiscard]] bool find(double log_g, double x, HeTorranceW& w) const {
    const double position = (log_g - begin) * rows_per_unit;
    const std::size_t r = std::min(static_cast<std::size_t>(position), rows - 1);  // the last double below `end`
    const Row& row = row_[r];
    const Column column = Column::of(1.0 + row.h * x);
    if (column.index >= row.columns) return false;
    const double a = 2.0 * (position - static_cast<double>(r)) - 1.0;
    const ChebyshevPatch& patch = patch_[row.first + column.index];
    if constexpr (with_derivatives) {
      const ChebyshevPatch::Gradient p = patch.gradient(a, column.t);
      w = {p.value, p.by_a * (2.0 * rows_per_unit), p.by_t * column.by_v * row.h};
    } else {
      w.value = patch.value(a, column.t);
    }
    return true;
  }

 private:
  static constexpr std::size_t rows = 14;
  static constexpr double rows_per_unit = static_cast<double>(rows) / (end - begin);

  struct Row {
    double h = 0.0;
    std::size_t first = 0, columns = 0;
  };

  void add_row(std::size_t r) {
    const double bottom = begin + static_cast<double>(r) / rows_per_unit;
    const double height = 1.0 / rows_per_unit;
    const double g = std::exp(bottom + 0.5 * height);
    Row& row = row_[r];
    row.h = 1.0 / (0.4 + g * g / 64.0);
    row.first = patch_.size();
    for (; starts_covered(row, bottom + height); ++row.columns) {
      patch_.push_back(ChebyshevPatch::fit([&](double a, double t) {
        const double x = (Column::v_at(row.columns, t) - 1.0) / row.h;
        return log_w_anywhere<false>(bottom + 0.5 * (1.0 + a) * height, x).value;
      }));
    }
  }
  [[nodiscard]] static bool starts_covered(const Row& row, double top) {
    const double x = (Column::start(row.columns) - 1.0) / row.h;
    return log_w_anywhere<false>(top, x).value > log_w_covered;
  }

  std::array<Row, rows> row_;
  std::vector<ChebyshevPatch> patch_;
};

/// G(xi) = e(w)/xi, so that y G(xi) is the exponent at the saddle point.
[[nodiscard]] inline double saddle_decay(double xi) {
  const double w = saddle_exponent(0.0, xi);
  return w > 0.0 ? (2.0 + std::expm1(-w) / w) * std::exp(-w) : 1.0;
}

/// P(r, xi) = ln(g W) + y G(xi), r = 1/g.
[[nodiscard]] inline double log_prefactor(double r, double xi) {
  const double w = saddle_exponent(0.0, xi);
  const double inverse_peak = r * std::exp(-w);
  if (inverse_peak < 0.01) {
    return std::log1p(saddle_correction(1.0 / (1.0 + 2.0 * w), inverse_peak).sum) - w - 0.5 * std::log1p(2.0 * w);
  }
  const double log_g = -std::log(r);
  return log_series<false>(log_g, xi / (r * r), w).value + log_g + xi / r * saddle_decay(xi);
}

/// ln W = -ln g - y G(xi) + P(1/g, xi) for ln g >= 3.6, over quarter octaves of 1 + 8 xi.
class LargeRoughness {
 public:
  static constexpr double begin = ModerateRoughness::end;

  LargeRoughness() {
    const double least_g = std::exp(begin);
    for (std::size_t c = 0; log_w_anywhere<false>(begin, xi_at(c, -1.0) * least_g * least_g).value > log_w_covered;
         ++c) {
      columns_.push_back({ChebyshevLine::fit([&](double t) { return saddle_decay(xi_at(c, t)); }), {}});
      for (std::size_t b = 0; b < 2; ++b) {
        const double r0 = band_[b];
        const double r1 = band_[b + 1];
        columns_.back().p[b] = ChebyshevPatch::fit(
            [&](double a, double t) { return log_prefactor(r0 + 0.5 * (1.0 + a) * (r1 - r0), xi_at(c, t)); });
      }
    }
  }

  template <bool with_derivatives>
  [[nodiscard]] bool find(double log_g, double x, HeTorranceW& w) const {
    const double r = std::exp(-log_g);
    const double y = x * r;
    const double v_1 = scale * y * r;  // v - 1
    const Column column = Column::of(1.0 + v_1);
    if (column.index >= columns_.size()) return false;
    const Functions& f = columns_[column.index];
    const std::size_t b = r < band_[1] ? 0 : 1;
    const double a = (r - band_[b]) * per_band_[b] - 1.0;
    double g_by_t = 0.0;
    const double g = f.g.at<with_derivatives>(column.t, g_by_t);
    if constexpr (with_derivatives) {
      const ChebyshevPatch::Gradient p = f.p[b].gradient(a, column.t);
      const double by_v = (p.by_t - y * g_by_t) * column.by_v;
      w = {p.value - y * g - log_g, y * g - 1.0 - 2.0 * v_1 * by_v - r * per_band_[b] * p.by_a,
           r * (scale * r * by_v - g)};
    } else {
      w.value = f.p[b].value(a, column.t) - y * g - log_g;
    }
    return true;
  }

 private:
  static constexpr double scale = 8.0;

  struct Functions {
    ChebyshevLine g;
    std::array<ChebyshevPatch, 2> p;
  };

  [[nodiscard]] static double xi_at(std::size_t column, double t) { return (Column::v_at(column, t) - 1.0) / scale; }

  std::array<double, 3> band_{0.0, 0.008, 1.0001 * std::exp(-begin)};
  std::array<double, 2> per_band_{2.0 / (band_[1] - band_[0]), 2.0 / (band_[2] - band_[1])};
  std::vector<Functions> columns_;
};

/// For g < e^-2 and x < 600, from j = 1, relative to whose summand no other exceeds e^600. Log-concave: past the peak
/// the rest is less than the last term.
template <bool with_derivatives>
[[nodiscard]] inline HeTorranceW short_sum(double log_g, double x) {
  const double g = std::exp(log_g);
  SeriesSums<double> s;
  double weight = 1.0;
  double ratio = 1.0;
  for (int k = 1; ratio > 0.5 || weight > 1e-12 * s.weight; ++k) {
    const double j = k;
    add_summand<with_derivatives>(s, x, j, weight);
    ratio = g * j / ((j + 1.0) * (j + 1.0)) * std::exp(x / (j * (j + 1.0)));
    weight *= ratio;
  }
  return {log_g - g - x + std::log(s.weight), s.stein / s.weight, -s.inverse_j / s.weight};
}

struct Tables {
  ModerateRoughness moderate;
  LargeRoughness large;

  [[nodiscard]] static const Tables& get() {
    static const Tables tables;
    return tables;
  }
};

template <bool with_derivatives>
[[nodiscard]] inline HeTorranceW log_w(double log_g, double x) {
  if (log_g < ModerateRoughness::begin && x < 600.0) return short_sum<with_derivatives>(log_g, x);
  HeTorranceW w{};
  const Tables& tables = Tables::get();
  if (log_g >= LargeRoughness::begin) {
    if (tables.large.find<with_derivatives>(log_g, x, w)) return w;
  } else if (log_g >= ModerateRoughness::begin) {
    if (tables.moderate.find<with_derivatives>(log_g, x, w)) return w;
  }
  return log_w_anywhere<with_derivatives>(log_g, x);
}

/// A dual number: a value and its derivatives.
template <class T>
concept Dual = requires(T& t) {
  t.a = 0.0;
  t.v = 0.0 * t.v + 0.0 * t.v;
};

}  // namespace he_torrance

/// ln W(g, x).
[[nodiscard]] inline double he_torrance_log_w(double log_g, double x) {
  return he_torrance::log_w<false>(log_g, x).value;
}

/// ln W(g, x), d/d ln g and d/dx.
[[nodiscard]] inline HeTorranceW he_torrance_log_w_derivatives(double log_g, double x) {
  return he_torrance::log_w<true>(log_g, x);
}

/// ln W(g, x) of doubles or dual numbers; of any other scalar by the sum, since polynomials fitted to 1e-10 have no
/// more digits to give.
template <class T>
[[nodiscard]] T log_he_torrance(const T& log_g, const T& x) {
  if constexpr (std::is_same_v<T, double>) {
    return he_torrance_log_w(log_g, x);
  } else if constexpr (he_torrance::Dual<T>) {
    const HeTorranceW w = he_torrance_log_w_derivatives(log_g.a, x.a);
    T result(w.value);
    result.v = w.by_log_g * log_g.v + w.by_x * x.v;
    return result;
  } else {
    return log_he_torrance_series(log_g, x);
  }
}

}  // namespace goniofit
