// One source, four arithmetics: the shape templates of every combination of tiers as doubles, as dual numbers, as SIMD
// batches and as 50-digit floats. (stability_test.cpp has the doubles' error against the tables; fifty_digits_test.cpp
// the formulas' own.)

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "batch_loops.h"
#include "brdf/shape_kernels.h"
#include "combinations.h"
#include "quantities.h"

namespace goniofit::stability {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double representable = 650.0;  ///< of |ln f|

/// The largest of some errors, and where it was.
class Largest {
 public:
  void add(double error, const ShapeSettings& settings, const Inputs& in) {
    ++count_;
    if (error <= worst_) return;
    worst_ = std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
    where_ = name_of(settings) + " at " + describe(in);
  }
  void expect_below(double bound, const char* what, std::size_t least_count = 1000) const {
    EXPECT_GT(count_, least_count) << what;
    EXPECT_LE(worst_, bound) << what << ": " << where_;
    std::printf("  %-40s %6zu values, max %.2g, %s\n", what, count_, worst_, where_.c_str());
  }

 private:
  std::size_t count_ = 0;
  double worst_ = -1.0;
  std::string where_;
};

/// The logarithms that ln f is the sum of: at grazing those of sigma_e and of the lobe cancel.
double log_magnitude(const ShapeSettings& settings, const Sample<double>& s, const Outcome<double>& f) {
  const double ratio = std::fabs(surface_terms(settings, s.surface, s.pair).log_height_ratio);
  const double power = settings.distribution == DistributionTier::student_t ? s.in.tail : 1.0;
  return 1.0 + std::fabs(f.log) + 2.0 * power * ratio;
}

/// dd, or fs where asked for.
template <class T, class G>
Outcome<T> shape(bool forward, const ShapeSettings& settings, const Sample<T, G>& sample) {
  return forward ? fs(settings, sample) : dd(settings, sample);
}

/// Whether a double holds the value with all of its digits.
bool held(const Outcome<double>& f) { return f.value > 0.0 && std::fabs(f.log) < representable; }

using Jet = ceres::Jet<double, 4>;
constexpr std::array members{&SurfaceParameters<Big>::log_slope, &SurfaceParameters<Big>::log_slope_y,
                             &SurfaceParameters<Big>::tail, &SurfaceParameters<Big>::log_sigma};

Sample<Jet, double> dual_sample(const Inputs& in, const Pair& pair) {
  Sample<Jet, double> s = sample_of<Jet, double>(in, pair);
  s.surface.log_slope.v[0] = 1.0;
  s.surface.log_slope_y.v[1] = 1.0;
  s.surface.tail.v[2] = 1.0;
  s.surface.log_sigma.v[3] = 1.0;
  return s;
}

TEST(Arithmetics, DualNumbersHaveTheValueOfDoubles) {
  const std::vector<Inputs> rows = spread_rows(500, 5);
  Largest errors;
  for (const ShapeSettings& settings : combinations()) {
    for (const Inputs& in : rows) {
      const Pair pair = make_pair(truth::angles_of(in));
      for (const bool forward : {false, true}) {
        const Sample<double> sample = sample_of<double>(in, pair);
        const Outcome<double> f = shape(forward, settings, sample);
        if (!held(f)) continue;
        const Jet dual = shape(forward, settings, dual_sample(in, pair)).value;
        errors.add(std::fabs(dual.a / f.value - 1.0) / log_magnitude(settings, sample, f), settings, in);
      }
    }
  }
  errors.expect_below(8.0 * eps, "dual - double");  // a dual number divides by way of a reciprocal
}

/// d ln f by a parameter, by a central difference in 50 digits.
double wide_derivative(bool forward, const ShapeSettings& settings, const Sample<Big>& at, std::size_t member) {
  const Big h("1e-14");
  const auto moved = [&](const Big& step) {
    Sample<Big> sample = at;
    sample.surface.*members[member] += step;
    return shape(forward, settings, sample).log;
  };
  return static_cast<double>((moved(h) - moved(-h)) / (2 * h));
}

bool reads(const ShapeSettings& settings, std::size_t member) {
  if (member == 1) return settings.anisotropic;
  if (member == 2) return settings.distribution == DistributionTier::student_t;
  return member == 0 || settings.wave_optics();
}

class DerivativeErrors {
 public:
  /// Duals of `settings`, and of he-torrance-series where these are he-torrance, which has the same 50-digit form.
  void compare(bool forward, const ShapeSettings& settings, const Inputs& in) {
    const Pair pair = make_pair(truth::angles_of(in));
    if (!held(shape(forward, settings, sample_of<double>(in, pair)))) return;
    const Sample<Big> wide = sample_of<Big>(in, test::big_pair_of(truth::angles_of(in)));
    const bool table = settings.distribution == DistributionTier::he_torrance;
    const ShapeSettings exact = table ? with(settings, DistributionTier::he_torrance_series) : settings;
    for (std::size_t m = 0; m < members.size(); ++m) {
      if (!reads(settings, m) || (forward && m > 1)) continue;
      const double truth = wide_derivative(forward, exact, wide, m);
      errors.add(error(forward, exact, in, pair, m, truth), exact, in);
      if (table) tabulated.add(error(forward, settings, in, pair, m, truth), settings, in);
    }
  }

  Largest errors, tabulated;

 private:
  static double error(bool forward, const ShapeSettings& settings, const Inputs& in, const Pair& pair, std::size_t m,
                      double truth) {
    const Jet f = shape(forward, settings, dual_sample(in, pair)).value;
    return std::fabs(f.v[static_cast<Eigen::Index>(m)] / f.a - truth) / (1.0 + std::fabs(truth));
  }
};

// The 50-digit function has its own pair, from the degrees: the derivative's error holds the geometry's.
TEST(Arithmetics, DualNumbersHaveTheDerivativesOfFiftyDigits) {
  const std::vector<Inputs> rows = spread_rows(3300, 49);
  DerivativeErrors all;
  for (const ShapeSettings& settings : combinations()) {
    if (settings.distribution == DistributionTier::he_torrance_series) continue;
    for (const Inputs& in : rows) {
      if (settings.wave_optics() && in.sigma_um > 0.5 * in.wavelength_um) continue;  // a long sum
      if (settings.forms.fs == FsForm::printed) all.compare(false, settings, in);
      if (settings.shadowing == ShadowingTier::none && settings.distribution == DistributionTier::rough_limit) {
        all.compare(true, settings, in);
      }
    }
  }
  all.errors.expect_below(1e-10, "derivatives against 50 digits");
  all.tabulated.expect_below(1.3e-8, "the same, W from its table", 80);
}

/// Rows that share the surface, as a batch does.
struct Batch {
  Inputs surface;
  std::vector<Inputs> rows;
  PairBatch pairs;
};

std::vector<Batch> batches() {
  std::vector<Inputs> rows = spread_rows(41, 1);
  std::vector<Batch> all;
  for (const double slope : {1e-6, 1e-3, 0.05, 0.4, 10.0}) {
    for (const double tail : {1.6, 2.0, 40.0}) {
      Batch batch;
      batch.surface.slope = slope;
      batch.surface.slope_y = std::clamp(0.3 * slope, 1e-6, 10.0);
      batch.surface.tail = tail;
      batch.rows = rows;
      for (Inputs& in : batch.rows) {
        in.slope = slope;
        in.slope_y = batch.surface.slope_y;
        in.tail = tail;
        batch.pairs.push_back(make_pair(truth::angles_of(in)));
      }
      all.push_back(std::move(batch));
    }
  }
  return all;
}

/// The exponential of a batch's lobe is at least e^-690; values below e^-660 times what stands before it show that.
double floored_share(bool forward, const ShapeSettings& settings, const Sample<double>& s) {
  if (forward) return std::exp(-660.0);
  const SurfaceTerms<double> t = surface_terms(settings, s.surface, s.pair);
  return t.shadowing_over_cosines * slope_independent_factor(s.pair) * std::exp(-660.0);
}

void compare_batches(const std::vector<BatchLoop>& loops, bool forward, const char* what) {
  Largest errors;
  const std::vector<Batch> all = batches();
  for (const BatchLoop& loop : loops) {
    for (const Batch& batch : all) {
      std::vector<double> values(batch.rows.size());
      const SurfaceParameters<double> surface = sample_of<double>(batch.surface, Pair{}).surface;
      loop.run(batch.pairs, surface, values.data());
      for (std::size_t i = 0; i < values.size(); ++i) {
        const Inputs& in = batch.rows[i];
        const Sample<double> sample = sample_of<double>(in, batch.pairs[i]);
        const Outcome<double> f = shape(forward, loop.settings, sample);
        if (held(f) && f.value > floored_share(forward, loop.settings, sample)) {
          errors.add(std::fabs(values[i] / f.value - 1.0) / (1.0 + std::fabs(f.log)), loop.settings, in);
        } else if (f.value < 1.0) {
          EXPECT_LT(values[i], 1e-200) << name_of(loop.settings) << " at " << describe(in);
        } else {
          EXPECT_GT(values[i], 1e280) << name_of(loop.settings) << " at " << describe(in);
        }
      }
    }
  }
  errors.expect_below(1e-13, what);
}

TEST(Arithmetics, BatchesOfTheRoughLimitAgreeWithScalars) {
  compare_batches(rough_limit_loops(), false, "batches, dd at rough-limit");
}

TEST(Arithmetics, BatchesOfStudentTAgreeWithScalars) {
  compare_batches(student_t_loops(), false, "batches, dd at student-t");
}

TEST(Arithmetics, BatchesOfForwardScatteringAgreeWithScalars) { compare_batches(fs_loops(), true, "batches, fs"); }

TEST(Arithmetics, BatchesOfFresnelAndOrenNayarAgreeWithScalars) {
  const Batch batch = batches().front();
  for (const PlainLoop& loop : plain_loops()) {
    for (const double parameter : {0.0, 1e-6, 0.04, 0.6, 1.0}) {
      std::vector<double> values(batch.rows.size());
      loop.run(batch.pairs, parameter, values.data());
      for (std::size_t i = 0; i < values.size(); ++i) {
        const double scalar = loop.scalar(batch.pairs[i], parameter);
        EXPECT_NEAR(values[i], scalar, 1e-13 * std::max(std::fabs(scalar), 1e-3))
            << loop.name << " at " << parameter << ", " << describe(batch.rows[i]);
      }
    }
  }
}

}  // namespace
}  // namespace goniofit::stability
