#include "terms/he_torrance_block.h"

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

/// The places of up to seven regions, and of what comes after them together. Counters of eight bits in one register:
/// counters in memory would make each place wait for the store of the one before.
struct Buckets {
  static constexpr int size = 8;
  static constexpr int last = size - 1;

  alignas(64) std::array<std::array<std::int32_t, capacity>, size> place;
  std::uint64_t counts = 0;

  [[nodiscard]] std::size_t count(int bucket) const { return (counts >> (8 * bucket)) & 255; }

  /// Region i goes to bucket i - first, or the last. No bucket may come to 256.
  template <class Number, class PlaceAt>
  [[gnu::always_inline]] void fill(const Number* region, std::size_t n, int first, const PlaceAt& place_at) {
    std::uint64_t filled = 0;
    std::int32_t* const places = place[0].data();
    for (std::size_t i = 0; i < n; ++i) {
      const std::int32_t at = place_at(i);
      const auto bucket = static_cast<std::uint64_t>(std::min<Number>(region[at] - static_cast<Number>(first), last));
      places[bucket * capacity + ((filled >> (8 * bucket)) & 255)] = at;
      filled += std::uint64_t{1} << (8 * bucket);
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
  static constexpr int first_sum = fine::sum_16;
  static constexpr int scalar = fine::scalar;
  const FineCells& cells = FineCells::get();

  [[gnu::always_inline]] static RegionNumber<Real> region(Real r, Real x) { return fine_region(r, x); }
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
      case fine::origin:
        return evaluate(cells.origin, p, n);
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
  static constexpr int first_sum = coarse::sum_8;
  static constexpr int scalar = coarse::scalar;
  const CoarseCells<Real>& cells = CoarseCells<Real>::get();

  [[gnu::always_inline]] static RegionNumber<Real> region(Real r, Real x) { return coarse_region(r, x); }
  [[gnu::always_inline]] void evaluate_region(int region, Places<Real>& p, std::size_t n) const {
    switch (region) {
      case coarse::saddle:
        return evaluate(cells.saddle, p, n);
      case coarse::origin:
        return evaluate(cells.origin, p, n);
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

/// Places that share a region; all of them where `place` is null.
struct Task {
  int region;
  std::size_t count;
  std::int32_t* place;
};

/// A block by one tier.
template <class Tier>
class Run {
 public:
  using Real = typename Tier::Real;

  [[gnu::always_inline]] Run(const Real* log_g, const Real* x, std::size_t n, Real* log_w)
      : log_g_(log_g), x_(x), n_(n), log_w_(log_w) {}

  [[gnu::always_inline]] void operator()() {
    if (n_ == 0) return;
    classify();
    plan();
    for (std::size_t i = 0; i < tasks_; ++i) carry_out(task_[i]);
  }

 private:
  [[gnu::always_inline]] void classify() {
    const std::size_t n = n_;
    const Real* const log_g = log_g_;
    const Real* const x = x_;
    Real* const rs = all_.r.data();
    Real* const xs = all_.x.data();
    RegionNumber<Real>* const regions = region_.data();
#pragma GCC ivdep
    for (std::size_t i = 0; i < n; ++i) {
      rs[i] = exp(Lane<Real>(-log_g[i])).v;
      xs[i] = x[i];
      regions[i] = Tier::region(rs[i], x[i]);
    }
    for (std::size_t i = n; i < padded<Real>(n); ++i) {
      rs[i] = rs[0];
      xs[i] = xs[0];
    }
  }

  /// Where most places are of one region, its expression is evaluated at all places as they lie, before the others.
  [[gnu::always_inline]] void plan() {
    const std::size_t n = n_;
    RegionNumber<Real> differ = 0;
    for (std::size_t i = 0; i < n; ++i) differ |= region_[i] ^ region_[0];
    if (differ == 0) {
      task_[tasks_++] = {static_cast<int>(region_[0]), n_, nullptr};
      return;
    }
    common_.fill(region_.data(), n_, 0, [](std::size_t i) { return static_cast<std::int32_t>(i); });
    for (int b = 0; b < Buckets::last; ++b) {
      if (4 * common_.count(b) >= 3 * n_) task_[tasks_++] = {b, n_, nullptr};
    }
    const bool has_major = tasks_ > 0;
    for (int b = 0; b < Buckets::last; ++b) {
      if (!(has_major && b == task_[0].region)) add(common_, b, b);
    }
    const std::size_t rest = common_.count(Buckets::last);
    if (rest == 0) return;
    const auto& places = common_.place[Buckets::last];
    rare_.fill(region_.data(), rest, Buckets::last, [&](std::size_t i) { return places[i]; });
    for (int b = 0; b < Buckets::size; ++b) add(rare_, b, b + Buckets::last);
  }
  /// A few places are faster one by one than in a strip with nothing else.
  [[gnu::always_inline]] void add(Buckets& buckets, int bucket, int region) {
    const std::size_t count = buckets.count(bucket);
    if (count > 0)
      task_[tasks_++] = {count > few ? region : Tier::scalar, count,
                         buckets.place[static_cast<std::size_t>(bucket)].data()};
  }

  [[gnu::always_inline]] void carry_out(const Task& t) {
    if (t.region == Tier::scalar) return one_by_one(t);
    Places<Real>& p = t.place == nullptr ? all_ : some_;
    if (t.place != nullptr) gather(t);
    tier_.evaluate_region(t.region, p, t.count);
    const Real sign = t.region < Tier::first_sum ? Real(-1) : Real(1);
    const Real* const log_g = log_g_;
    const Real* const result = p.result.data();
    Real* const log_w = log_w_;
    const std::size_t n = t.count;
    if (t.place == nullptr) {
#pragma GCC ivdep
      for (std::size_t i = 0; i < n; ++i) log_w[i] = result[i] + sign * log_g[i];
    } else {
      const std::int32_t* const place = t.place;
#pragma GCC ivdep
      for (std::size_t i = 0; i < n; ++i) log_w[place[i]] = result[i] + sign * log_g[place[i]];
    }
  }

  [[gnu::always_inline]] void gather(const Task& t) {
    for (std::size_t i = t.count; i < padded<Real>(t.count); ++i) t.place[i] = t.place[0];
    const std::int32_t* const place = t.place;
    const Real* const r = all_.r.data();
    const Real* const x = all_.x.data();
    Real* const some_r = some_.r.data();
    Real* const some_x = some_.x.data();
    const std::size_t end = padded<Real>(t.count);
#pragma GCC ivdep
    for (std::size_t i = 0; i < end; ++i) {
      some_r[i] = r[place[i]];
      some_x[i] = x[place[i]];
    }
  }

  [[gnu::always_inline]] void one_by_one(const Task& t) {
    for (std::size_t i = 0; i < t.count; ++i) {
      const std::size_t at = t.place == nullptr ? i : static_cast<std::size_t>(t.place[i]);
      log_w_[at] = static_cast<Real>(log_w_of_one(static_cast<double>(log_g_[at]), static_cast<double>(x_[at])));
    }
  }

  const Real* log_g_;
  const Real* x_;
  std::size_t n_;
  Real* log_w_;
  Tier tier_;
  Places<Real> all_, some_;
  alignas(64) std::array<RegionNumber<Real>, capacity> region_;
  Buckets common_, rare_;
  std::array<Task, 2 * Buckets::size + 1> task_;
  std::size_t tasks_ = 0;
};

template <class Tier, class Real = typename Tier::Real>
GONIOFIT_TARGET_SSE2 void run_sse2(const Real* log_g, const Real* x, std::size_t n, Real* log_w) {
  Run<Tier>(log_g, x, n, log_w)();
}
template <class Tier, class Real = typename Tier::Real>
GONIOFIT_TARGET_AVX2 void run_avx2(const Real* log_g, const Real* x, std::size_t n, Real* log_w) {
  Run<Tier>(log_g, x, n, log_w)();
}
template <class Tier, class Real = typename Tier::Real>
GONIOFIT_TARGET_AVX512 void run_avx512(const Real* log_g, const Real* x, std::size_t n, Real* log_w) {
  Run<Tier>(log_g, x, n, log_w)();
}

template <class Tier, class Real = typename Tier::Real>
void run(const Real* log_g, const Real* x, std::size_t n, Real* log_w, InstructionSet instructions) {
  static constexpr std::array by_instructions{&run_sse2<Tier>, &run_avx2<Tier>, &run_avx512<Tier>};
  by_instructions[static_cast<std::size_t>(instructions)](log_g, x, n, log_w);
}

}  // namespace

void log_he_torrance_block(const double* log_g, const double* x, std::size_t n, double* log_w,
                           HeTorranceAccuracy accuracy, InstructionSet instructions) {
  if (accuracy == HeTorranceAccuracy::fine) return run<Fine>(log_g, x, n, log_w, instructions);
  run<Coarse<double>>(log_g, x, n, log_w, instructions);
}

void log_he_torrance_block(const float* log_g, const float* x, std::size_t n, float* log_w,
                           InstructionSet instructions) {
  run<Coarse<float>>(log_g, x, n, log_w, instructions);
}

}  // namespace goniofit
