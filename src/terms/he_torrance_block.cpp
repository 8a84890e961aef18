#include "terms/he_torrance_block.h"
#include "support/vectorised.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "terms/he_torrance.h"
#include "terms/he_torrance_cells.h"
#include "terms/he_torrance_regions.h"

namespace goniofit {
namespace {

using namespace he_torrance;

/// Dense loops run over whole strips, the widest vectors: no remainder in narrower ones.
template <class Real>
constexpr std::size_t strip = 64 / sizeof(Real);
/// Fewer places than this are faster one by one than as a strip.
constexpr std::size_t few = 2;
constexpr std::size_t capacity = he_torrance_block + strip<float>;

template <class Real>
constexpr std::size_t strips(std::size_t n) {
  return (n + strip<Real> - 1) / strip<Real>;
}
template <class Real>
constexpr std::size_t padded(std::size_t n) {
  return strips<Real>(n) * strip<Real>;
}

template <class Real>
using Column = std::array<Real, capacity>;

/// Inputs of the expressions, and what they give: ln W + ln g of polynomials, ln W - ln g of sums.
template <class Real>
struct Places {
  alignas(64) Column<Real> r, x, variable, result;
};

/// The places of each region. The counters are fields of one register: in
/// memory, each place would wait for the store of the one before.
struct Buckets {
  static constexpr int size = 7;
  static constexpr int bits = 9;  ///< of a counter: a block has 256 places

  alignas(64) std::array<std::array<std::int32_t, capacity>, size> place;
  std::uint64_t counts = 0;

  [[nodiscard]] [[gnu::always_inline]] std::size_t count(int bucket) const {
    return counter(counts, static_cast<std::uint64_t>(bucket));
  }
  [[nodiscard]] [[gnu::always_inline]] std::int32_t* places(int bucket) {
    return place[static_cast<std::size_t>(bucket)].data();
  }
  [[nodiscard]] [[gnu::always_inline]] static std::size_t counter(std::uint64_t counts, std::uint64_t bucket) {
    return (counts >> (bits * bucket)) & ((1U << bits) - 1);
  }

  /// region[i] of place_at(i).
  template <class Number, class PlaceAt>
  [[gnu::always_inline]] void fill(const Number* region, std::size_t n, const PlaceAt& place_at) {
    std::uint64_t filled = 0;
    std::int32_t* const places = place[0].data();
    for (std::size_t i = 0; i < n; ++i) {
      const auto bucket = static_cast<std::uint64_t>(region[i]);
      places[bucket * capacity + counter(filled, bucket)] = place_at(i);
      filled += std::uint64_t{1} << (bits * bucket);
    }
    counts = filled;
  }
};

/// ln W - ln g = ln S - g - x/n, S = sum_{j<=n} g^(j-1)/(j! j) e^(x/n - x/j): an exponential of j <= n/2 is the square
/// of that of 2j times e^(-x/n). In double, since S may be e^-690.
template <std::size_t n>
struct ShortSum {
  static constexpr std::array<double, n + 1> coefficients = [] {
    std::array<double, n + 1> c{};
    double factorial = 1.0;
    for (std::size_t j = 1; j <= n; ++j) {
      factorial *= static_cast<double>(j);
      c[j] = 1.0 / (factorial * static_cast<double>(j));
    }
    return c;
  }();

  /// One strip.
  template <class Real>
  [[gnu::always_inline]] static void evaluate(const Real* r, const Real* xs, Real* result) {
    constexpr std::size_t width = strip<Real>;
    using Strip = std::array<double, width>;
    alignas(64) std::array<Strip, n + 1> e;
    alignas(64) Strip g;
    alignas(64) Strip x;
    alignas(64) Strip s;
    for (std::size_t k = 0; k < width; ++k) {
      x[k] = static_cast<double>(xs[k]);
      g[k] = 1.0 / static_cast<double>(r[k]);
      e[0][k] = exp(Lane<double>(x[k] * (-1.0 / n))).v;
      e[n / 2][k] = e[0][k];
      s[k] = coefficients[n];
    }
    for (std::size_t j = n - 1; j > 0; --j) {
      if (j > n / 2) {
        const double rate = 1.0 / static_cast<double>(n) - 1.0 / static_cast<double>(j);
        for (std::size_t k = 0; k < width; ++k) e[j][k] = exp(Lane<double>(x[k] * rate)).v;
      } else if (j < n / 2) {
        for (std::size_t k = 0; k < width; ++k) e[j][k] = e[2 * j][k] * e[2 * j][k] * e[0][k];
      }
      for (std::size_t k = 0; k < width; ++k) s[k] = s[k] * g[k] + coefficients[j] * e[j][k];
    }
    for (std::size_t k = 0; k < width; ++k) {
      result[k] = static_cast<Real>(log(Lane<double>(s[k])).v - g[k] - x[k] * (1.0 / n));
    }
  }
};

/// The logarithm in a loop of its own: in one with the polynomials, vectors would wait for one another's long chains.
template <class Cell, class Real>
[[gnu::always_inline]] inline void evaluate(const Cell& cell, Places<Real>& p, std::size_t n) {
  const Real* const r = p.r.data();
  const Real* const x = p.x.data();
  Real* const l = p.variable.data();
  Real* const result = p.result.data();
  const std::size_t end = padded<Real>(n);
#pragma GCC ivdep
  for (std::size_t i = 0; i < end; ++i) l[i] = cell.variable(r[i], x[i]);
#pragma GCC ivdep
  for (std::size_t i = 0; i < end; ++i) result[i] = cell.log_g_w(r[i], x[i], l[i]);
}

template <std::size_t terms, class Real>
[[gnu::always_inline]] inline void evaluate_sum(Places<Real>& p, std::size_t n) {
  for (std::size_t i = 0; i < n; i += strip<Real>) ShortSum<terms>::evaluate(&p.r[i], &p.x[i], &p.result[i]);
}

/// What the fine and the coarse tier differ in: regions and their expressions.
struct Fine {
  using Real = double;
  static constexpr int usual = fine::shallow_large;
  static constexpr int rest = fine::rest;
  static constexpr int scalar = fine::scalar;
  const FineCells& cells = FineCells::get();

  [[gnu::always_inline]] static RegionNumber<Real> region(Real r, Real x) { return fine_region(r, x); }
  [[gnu::always_inline]] static RegionNumber<Real> region_of_rest(Real r, Real x) { return fine_rest(r, x); }
  [[gnu::always_inline]] void evaluate_region(int region, Places<Real>& p, std::size_t n) const {
    switch (region) {
      case fine::shallow_large:
        return evaluate(cells.shallow_large, p, n);
      case fine::shallow:
        return evaluate(cells.shallow, p, n);
      case fine::deep:
        return evaluate(cells.deep, p, n);
      case fine::shallow_small:
        return evaluate(cells.shallow_small, p, n);
      case fine::deep_small:
        return evaluate(cells.deep_small, p, n);
      default:
        return evaluate(cells.origin, p, n);
    }
  }
  [[gnu::always_inline]] static void evaluate_rest(int region, Places<Real>& p, std::size_t n) {
    switch (region) {
      case fine::sum_16:
        return evaluate_sum<16>(p, n);
      case fine::sum_32:
        return evaluate_sum<32>(p, n);
      default:
        return evaluate_sum<48>(p, n);
    }
  }
};

template <class Number>
struct Coarse {
  using Real = Number;
  static constexpr int usual = coarse::saddle;
  static constexpr int rest = coarse::rest;
  static constexpr int scalar = coarse::scalar;
  const CoarseCells<Real>& cells = CoarseCells<Real>::get();

  [[gnu::always_inline]] static RegionNumber<Real> region(Real r, Real x) { return coarse_region(r, x); }
  [[gnu::always_inline]] static RegionNumber<Real> region_of_rest(Real r, Real x) { return coarse_rest(r, x); }
  [[gnu::always_inline]] void evaluate_region(int region, Places<Real>& p, std::size_t n) const {
    switch (region) {
      case coarse::saddle:
        return evaluate(cells.saddle, p, n);
      default:
        return evaluate(cells.origin, p, n);
    }
  }
  [[gnu::always_inline]] static void evaluate_rest(int region, Places<Real>& p, std::size_t n) {
    switch (region) {
      case coarse::sum_8:
        return evaluate_sum<8>(p, n);
      case coarse::sum_16:
        return evaluate_sum<16>(p, n);
      default:
        return evaluate_sum<32>(p, n);
    }
  }
};

[[gnu::noinline]] double log_w_of_one(double log_g, double x) { return he_torrance_log_w(log_g, x); }

/// A block by one tier.
template <class Tier>
class Run {
 public:
  using Real = typename Tier::Real;
  using Number = RegionNumber<Real>;

  [[gnu::always_inline]] Run(const Real* log_g, const Real* x, std::size_t n, Real* log_w)
      : log_g_(log_g), x_(x), n_(n), log_w_(log_w) {}

  [[gnu::always_inline]] void operator()() {
    if (n_ == 0) return;
    classify();
    const std::size_t others = count_unusual();
    if (4 * others > n_) {
      buckets_.fill(region_.data(), n_, [](std::size_t i) { return static_cast<std::int32_t>(i); });
    } else {
      sort_unusual(others);
      tier_.evaluate_region(Tier::usual, all_, n_);
      put_all();
    }
    for (int region = 0; region < Tier::rest; ++region) {
      if (!one_by_one(region)) continue;
      const std::size_t n = gather(region);
      tier_.evaluate_region(region, some_, n);
      put(region, n, Real(-1));
    }
    if (buckets_.count(Tier::rest) > 0) sums();
  }

 private:
  [[gnu::always_inline]] void classify() {
    const std::size_t n = n_;
    const Real* const log_g = log_g_;
    const Real* const x = x_;
    Real* const rs = all_.r.data();
    Real* const xs = all_.x.data();
    Number* const region = region_.data();
#pragma GCC ivdep
    for (std::size_t i = 0; i < n; ++i) {
      rs[i] = exp(Lane<Real>(-log_g[i])).v;
      xs[i] = x[i];
      region[i] = Tier::region(rs[i], x[i]);
    }
    for (std::size_t i = n; i < padded<Real>(n); ++i) {
      rs[i] = rs[0];
      xs[i] = xs[0];
    }
  }

  [[nodiscard]] [[gnu::always_inline]] std::size_t count_unusual() const {
    const std::size_t n = n_;
    const Number* const region = region_.data();
    Number count = 0;
    for (std::size_t i = 0; i < n; ++i) count += region[i] == Tier::usual ? Number(0) : Number(1);
    return static_cast<std::size_t>(count);
  }

  /// Where most places are usual, their expression is evaluated at all places as they lie, before the others.
  [[gnu::always_inline]] void sort_unusual(std::size_t count) {
    const Number* const region = region_.data();
    std::int32_t* const place = place_.data();
    Number* const their_region = rest_region_.data();
    std::size_t found = 0;
    for (std::size_t i = 0; found < count; ++i) {
      place[found] = static_cast<std::int32_t>(i);
      their_region[found] = region[i];
      found += region[i] == Tier::usual ? 0 : 1;
    }
    buckets_.fill(their_region, count, [place](std::size_t i) { return place[i]; });
  }

  /// What is left once the polynomials are done.
  [[gnu::always_inline]] void sums() {
    const std::size_t n = gather(Tier::rest);
    const Real* const r = some_.r.data();
    const Real* const x = some_.x.data();
    Number* const region = rest_region_.data();
#pragma GCC ivdep
    for (std::size_t i = 0; i < n; ++i) region[i] = Tier::region_of_rest(r[i], x[i]);
    std::copy_n(buckets_.places(Tier::rest), n, place_.data());
    const std::int32_t* const place = place_.data();
    buckets_.fill(region, n, [place](std::size_t i) { return place[i]; });
    for (int sum = 0; sum < Tier::scalar; ++sum) {
      if (!one_by_one(sum)) continue;
      const std::size_t count = gather(sum);
      tier_.evaluate_rest(sum, some_, count);
      put(sum, count, Real(1));
    }
    each(Tier::scalar);
  }

  /// Does so and returns false where there are few in the bucket, or none.
  [[nodiscard]] [[gnu::always_inline]] bool one_by_one(int bucket) {
    if (buckets_.count(bucket) > few) return true;
    each(bucket);
    return false;
  }
  [[gnu::always_inline]] void each(int bucket) {
    const std::int32_t* const place = buckets_.places(bucket);
    for (std::size_t i = 0; i < buckets_.count(bucket); ++i) {
      const auto at = static_cast<std::size_t>(place[i]);
      log_w_[at] = static_cast<Real>(log_w_of_one(static_cast<double>(log_g_[at]), static_cast<double>(x_[at])));
    }
  }

  /// The inputs of a bucket, side by side; how many there are.
  [[gnu::always_inline]] std::size_t gather(int bucket) {
    const std::size_t n = buckets_.count(bucket);
    const std::size_t end = padded<Real>(n);
    std::int32_t* const place = buckets_.places(bucket);
    for (std::size_t i = n; i < end; ++i) place[i] = place[0];
    const Real* const r = all_.r.data();
    const Real* const x = all_.x.data();
    Real* const some_r = some_.r.data();
    Real* const some_x = some_.x.data();
#pragma GCC ivdep
    for (std::size_t i = 0; i < end; ++i) {
      some_r[i] = r[place[i]];
      some_x[i] = x[place[i]];
    }
    return n;
  }

  /// ln W from results and `sign` ln g.
  [[gnu::always_inline]] void put(int bucket, std::size_t n, Real sign) {
    const std::int32_t* const place = buckets_.places(bucket);
    const Real* const log_g = log_g_;
    const Real* const result = some_.result.data();
    Real* const log_w = log_w_;
#pragma GCC ivdep
    for (std::size_t i = 0; i < n; ++i) log_w[place[i]] = result[i] + sign * log_g[place[i]];
  }
  [[gnu::always_inline]] void put_all() {
    const std::size_t n = n_;
    const Real* const log_g = log_g_;
    const Real* const result = all_.result.data();
    Real* const log_w = log_w_;
#pragma GCC ivdep
    for (std::size_t i = 0; i < n; ++i) log_w[i] = result[i] - log_g[i];
  }

  const Real* log_g_;
  const Real* x_;
  std::size_t n_;
  Real* log_w_;
  Tier tier_;
  Places<Real> all_, some_;
  alignas(64) std::array<Number, capacity> region_, rest_region_;
  std::array<std::int32_t, capacity> place_;
  Buckets buckets_;
};

template <class Tier>
struct Block {
  using Real = typename Tier::Real;
  struct Arguments {
    const Real* log_g;
    const Real* x;
    std::size_t n;
    Real* log_w;
  };
  [[gnu::always_inline]] static void run(const Arguments& a) { Run<Tier>(a.log_g, a.x, a.n, a.log_w)(); }
};

}  // namespace

void log_he_torrance_block(const double* log_g, const double* x, std::size_t n, double* log_w,
                           HeTorranceAccuracy accuracy, InstructionSet instructions) {
  if (accuracy == HeTorranceAccuracy::fine) return Vectorised<Block<Fine>>::of(instructions)({log_g, x, n, log_w});
  Vectorised<Block<Coarse<double>>>::of(instructions)({log_g, x, n, log_w});
}

void log_he_torrance_block(const float* log_g, const float* x, std::size_t n, float* log_w,
                           InstructionSet instructions) {
  Vectorised<Block<Coarse<float>>>::of(instructions)({log_g, x, n, log_w});
}

}  // namespace goniofit
