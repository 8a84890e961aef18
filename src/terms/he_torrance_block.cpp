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
/// So many places, or fewer, are faster one by one than as a strip.
constexpr std::size_t few_of_polynomial = 1;
constexpr std::size_t few_of_sum = 3;
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

/// The places of each region. The counters are fields of one register: in memory, each place would wait for the store
/// of the one before.
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

  [[gnu::always_inline]] void move(int from, int to) {
    const std::uint64_t n = count(from);
    std::copy_n(places(from), n, places(to) + count(to));
    counts += (n << (bits * to)) - (n << (bits * from));
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

  /// One lane.
  [[nodiscard]] [[gnu::always_inline]] static double log_w_over_g(double r, double x) {
    std::array<double, n + 1> e;
    const double g = 1.0 / r;
    e[n / 2] = exp(Lane<double>(x * (-1.0 / n))).v;
    const double s = add<n - 1>(e, g, x, coefficients[n]);
    return log(Lane<double>(s)).v - g - x * (1.0 / n);
  }

 private:
  /// s g^j + the terms of j and below. A recursion, not a loop: the lanes are to be the innermost one.
  template <std::size_t j>
  [[nodiscard]] [[gnu::always_inline]] static double add(std::array<double, n + 1>& e, double g, double x, double s) {
    if constexpr (j == 0) {
      return s;
    } else {
      if constexpr (j > n / 2) e[j] = exp(Lane<double>(x * (1.0 / n - 1.0 / j))).v;
      if constexpr (j < n / 2) e[j] = e[2 * j] * e[2 * j] * e[n / 2];
      return add<j - 1>(e, g, x, s * g + coefficients[j] * e[j]);
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
  const Real* const r = p.r.data();
  const Real* const x = p.x.data();
  Real* const result = p.result.data();
  const std::size_t end = padded<Real>(n);
#pragma GCC ivdep
  for (std::size_t i = 0; i < end; ++i) {
    result[i] = static_cast<Real>(ShortSum<terms>::log_w_over_g(static_cast<double>(r[i]), static_cast<double>(x[i])));
  }
}

/// What the fine and the coarse tier differ in: regions and their expressions.
struct Fine {
  using Real = double;
  static constexpr int usual = fine::shallow_large;
  static constexpr int rest = fine::rest;
  static constexpr int scalar = fine::scalar;
  static constexpr std::array<std::size_t, 3> terms{16, 32, 48};
  const FineCells& cells = FineCells::get();

  [[gnu::always_inline]] static Real inverse(Real log_g) { return exp(Lane<Real>(-log_g)).v; }
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
        return evaluate_sum<terms[0]>(p, n);
      case fine::sum_32:
        return evaluate_sum<terms[1]>(p, n);
      default:
        return evaluate_sum<terms[2]>(p, n);
    }
  }
};

template <class Number>
struct Coarse {
  using Real = Number;
  static constexpr int usual = coarse::saddle;
  static constexpr int rest = coarse::rest;
  static constexpr int scalar = coarse::scalar;
  static constexpr std::array<std::size_t, 3> terms{8, 16, 32};
  const CoarseCells<Real>& cells = CoarseCells<Real>::get();

  /// Within 6e-9 of 1/g, Taylor's series to the seventh power: y G(xi) reaches 690.
  [[gnu::always_inline]] static Real inverse(Real log_g) {
    constexpr Real reach = std::is_same_v<Real, float> ? Real(80) : Real(700);
    const auto [t, power] = lane::reduce(lane::at_most(reach, lane::at_least(-reach, -log_g)));
    const Real t2 = t * t;
    const Real low = (Real(1) + t) + t2 * (Real(1.0 / 2) + t * Real(1.0 / 6));
    const Real high = (Real(1.0 / 24) + t * Real(1.0 / 120)) + t2 * (Real(1.0 / 720) + t * Real(1.0 / 5040));
    return lane::scaled(low + t2 * t2 * high, power);
  }
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
        return evaluate_sum<terms[0]>(p, n);
      case coarse::sum_16:
        return evaluate_sum<terms[1]>(p, n);
      default:
        return evaluate_sum<terms[2]>(p, n);
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
      if (few(region, few_of_polynomial)) continue;
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
      rs[i] = Tier::inverse(log_g[i]);
      xs[i] = x[i];
    }
#pragma GCC ivdep
    for (std::size_t i = 0; i < n; ++i) region[i] = Tier::region(rs[i], xs[i]);
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
    for (int sum = 0; sum + 1 < Tier::scalar; ++sum) merge(sum);
    for (int sum = 0; sum < Tier::scalar; ++sum) {
      if (few(sum, few_of_sum)) continue;
      const std::size_t count = gather(sum);
      tier_.evaluate_rest(sum, some_, count);
      put(sum, count, Real(1));
    }
    each(Tier::scalar);
  }

  /// A sum's places go to the next longer sum, which is right for them too, where that makes fewer strips of terms.
  [[gnu::always_inline]] void merge(int sum) {
    constexpr auto terms = Tier::terms;
    const auto by = static_cast<std::size_t>(sum);
    const std::size_t a = buckets_.count(sum);
    const std::size_t b = buckets_.count(sum + 1);
    const std::size_t apart = strips<Real>(a) * terms[by] + strips<Real>(b) * terms[by + 1];
    if (strips<Real>(a + b) * terms[by + 1] < apart) buckets_.move(sum, sum + 1);
  }

  /// Whether there are at most `most` in a bucket, and done then.
  [[nodiscard]] [[gnu::always_inline]] bool few(int bucket, std::size_t most) {
    if (buckets_.count(bucket) > most) return false;
    each(bucket);
    return true;
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

template <class Tier, class Real = typename Tier::Real>
void run(const Real* log_g, const Real* x, std::size_t n, Real* log_w, InstructionSet instructions) {
  const auto run_block = Vectorised<Block<Tier>>::of(instructions);
  for (std::size_t i = 0; i < n; i += he_torrance_block) {
    run_block({log_g + i, x + i, std::min(n - i, he_torrance_block), log_w + i});
  }
}

}  // namespace

void log_he_torrance_block(const double* log_g, const double* x, std::size_t n, double* log_w,
                           HeTorranceAccuracy accuracy, InstructionSet instructions) {
  if (accuracy == HeTorranceAccuracy::coarse) return run<Coarse<double>>(log_g, x, n, log_w, instructions);
  if (instructions != InstructionSet::sse2) return run<Fine>(log_g, x, n, log_w, instructions);
  // Two lanes without a fused multiply-add lose to the tables.
  for (std::size_t i = 0; i < n; ++i) log_w[i] = log_w_of_one(log_g[i], x[i]);
}

void log_he_torrance_block(const float* log_g, const float* x, std::size_t n, float* log_w,
                           InstructionSet instructions) {
  run<Coarse<float>>(log_g, x, n, log_w, instructions);
}

}  // namespace goniofit
