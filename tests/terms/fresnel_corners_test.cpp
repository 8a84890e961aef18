#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_complex.hpp>
#include <complex>

#include "terms/fresnel.h"
#include "terms/term_errors.h"

namespace goniofit {
namespace {

using namespace term_errors;
using Dual = ceres::Jet<double, 2>;  // of (n, kappa)
using Complex = boost::multiprecision::cpp_complex_50;

// Fresnel's amplitudes with Snell's complex cosine.
Big amplitudes(const Big& n, const Big& kappa, const Big& u) {
  const Complex index(n, kappa);
  Complex refracted = sqrt(Complex(index * index - (1 - u * u)));
  if (refracted.real() < 0) refracted = -refracted;
  const Complex s = (Complex(u) - refracted) / (Complex(u) + refracted);
  const Complex p = (index * index * u - refracted) / (index * index * u + refracted);
  return (norm(s).real() + norm(p).real()) / 2;
}

// The textbook's a² + b² form in double.
template <class T>
T naive(const T& n, const T& kappa, double u) {
  using std::sqrt;
  const double sin2 = 1.0 - u * u;
  const T p = n * n - kappa * kappa - sin2;
  const T modulus = sqrt(p * p + 4.0 * n * n * kappa * kappa);
  const T a = sqrt(0.5 * (modulus + p));
  const T b2 = 0.5 * (modulus - p);
  const T rs = ((a - u) * (a - u) + b2) / ((a + u) * (a + u) + b2);
  const double t = sin2 / u;
  return 0.5 * rs * (1.0 + ((a - t) * (a - t) + b2) / ((a + t) * (a + t) + b2));
}

const std::vector<double> indices{0.05,      0.2,  0.618, 0.958, 0.999999, 1.0 + 1e-12,
                                  1.0000001, 1.01, 1.5,   2.42,  4.5,      10.0};
const std::vector<double> kappas{0.0, 1e-12, 1e-6, 1e-3, 0.1, 1.0, 6.69, 1e3, 1e6};
const std::vector<double> cosines{1.0, 1.0 - 1e-12, 0.999, 0.9, 0.7, 0.5, 0.3, 0.1, 0.01, 1e-4, 1e-8, 1e-12};

template <class F>
void everywhere(const F& f) {
  for (const double n : indices)
    for (const double kappa : kappas)
      for (const double u : cosines) f(n, kappa, u, place("n %.7g, kappa %g, cos %g", n, kappa, u));
}

TEST(FresnelCorners, ReflectionAndTransmissionAreFresnelsAmplitudes) {
  Errors reflection, transmission;
  everywhere([&](double n, double kappa, double u, const std::string& where) {
    const Big truth = amplitudes(Big(n), Big(kappa), Big(u));
    reflection.add(relative_error(fresnel_exact(n, kappa, u, 1.0 - u), truth), where);
    reflection.add_naive(relative_error(naive(n, kappa, u), truth), where);
    const Big rest = 1 - truth;
    if (rest < Big("1e-30")) {  // total reflection: what is left of it is round-off of the 50 digits
      EXPECT_LT(transmission_exact(n, kappa, u, 1.0 - u), 1e-29) << where;
    } else {
      transmission.add(relative_error(transmission_exact(n, kappa, u, 1.0 - u), rest), where);
      transmission.add_naive(relative_error(1.0 - naive(n, kappa, u), rest), where);
    }
  });
  reflection.print("F, exact");
  transmission.print("1 - F, exact");
  EXPECT_LT(reflection.worst(), 2e-15);
  EXPECT_LT(transmission.worst(), 2e-15);
  EXPECT_GT(reflection.naive(), 1e-3);
}

TEST(FresnelCorners, DerivativesAreRightAndFinite) {
  Errors by_n, by_kappa;
  everywhere([&](double n, double kappa, double u, const std::string& where) {
    const Dual f = fresnel_exact(Dual(n, 0), Dual(kappa, 1), u, 1.0 - u);
    ASSERT_TRUE(std::isfinite(f.v[0]) && std::isfinite(f.v[1])) << where;
    // Relative to the derivative or, where that vanishes, to 1e-6: F itself has its last digit at 1e-16.
    const auto error = [](double got, const Big& truth) {
      return std::fabs(static_cast<double>((got - truth) / std::max(Big(abs(truth)), Big(1e-6))));
    };
    const Big h("1e-18");
    const Big d_n = (amplitudes(n + h, Big(kappa), Big(u)) - amplitudes(n - h, Big(kappa), Big(u))) / (2 * h);
    if (abs(1 - Big(u) * u - Big(n) * n) > 1e-6) by_n.add(error(f.v[0], d_n), where);
    if (kappa == 0.0) return;
    const Big k = h * std::min(1.0, kappa);
    const Big d_k = (amplitudes(Big(n), kappa + k, Big(u)) - amplitudes(Big(n), kappa - k, Big(u))) / (2 * k);
    by_kappa.add(error(f.v[1], d_k), where);
  });
  by_n.print("dF/dn");
  by_kappa.print("dF/dkappa");
  EXPECT_LT(by_n.worst(), 1e-9);
  EXPECT_LT(by_kappa.worst(), 1e-9);
  EXPECT_FALSE(std::isfinite(naive(Dual(0.5, 0), Dual(0.0, 1), 0.3).v[0]));  // √0 in total reflection
}

TEST(FresnelCorners, SingularPlacesHaveTheirLimits) {
  // No interface, down to where u² underflows.
  for (const double u : {1.0, 0.3, 1e-8, 1e-100, 1e-153, 1e-160, 1e-200, 1e-300}) {
    EXPECT_NEAR(fresnel_exact(1.0, 0.0, u, 1.0 - u), 0.0, 1e-15) << u;
    EXPECT_NEAR(transmission_exact(1.0, 0.0, u, 1.0 - u), 1.0, 1e-7) << u;
    EXPECT_TRUE(std::isfinite(fresnel_exact(Dual(1.0, 0), Dual(0.0, 1), u, 1.0 - u).v[0])) << u;
  }
  // Grazing: everything is reflected, 1 - F is proportional to u.
  for (const auto& [n, kappa] : {std::pair(1.5, 0.0), {0.958, 6.69}, {1.0 + 1e-9, 0.0}, {2.0, 1e6}}) {
    EXPECT_EQ(fresnel_exact(n, kappa, 1e-300, 1.0), 1.0);
    EXPECT_NEAR(transmission_exact(n, kappa, 1e-300, 1.0) / transmission_exact(n, kappa, 1e-20, 1.0) / 1e-280, 1.0,
                1e-14);
  }
  // Total reflection is total, and not differentiable only at its edge: there the derivative is finite.
  for (const double u : {1e-300, 0.1, 0.5, 0.79}) EXPECT_EQ(fresnel_exact(0.6, 0.0, u, 1.0 - u), 1.0) << u;
  const auto edge = complex_root(Dual(0.0, 0), Dual(0.0, 1));
  EXPECT_EQ(edge.a.v[0], 0.0);
  EXPECT_EQ(edge.b.v[1], 0.0);
  for (const double n : {0.6, 0.6 - 1e-16, 0.6 + 1e-16}) {
    const Dual f = fresnel_exact(Dual(n, 0), Dual(0.0, 1), 0.8, 1.0 - 0.8);
    EXPECT_TRUE(std::isfinite(f.v[0]) && std::isfinite(f.v[1])) << n;
    EXPECT_NEAR(f.a, 1.0, 1e-6);  // 1 - F goes with the root of the distance
  }
}

TEST(FresnelScaled, IsSchlicksEquationFourteen) {
  for (const auto& [n, kappa] : {std::pair(1.5, 0.0), {0.958, 6.69}, {2.8, 3.2}}) {
    const double mean_f0 = normal_reflectance(n, kappa);
    EXPECT_NEAR(normal_transmission(n, kappa), 1.0 - mean_f0, 1e-15);
    for (const double f0 : {0.02, 0.3, 0.95}) {
      for (const double u : {1.0, 0.8, 0.3, 1e-3}) {
        const Big mean = amplitudes(Big(n), Big(kappa), Big(u));
        const Big at_normal = amplitudes(Big(n), Big(kappa), Big(1));
        const Big truth = f0 + (1 - Big(f0)) * (mean - at_normal) / (1 - at_normal);
        EXPECT_LT(std::fabs(static_cast<double>(fresnel_scaled(f0, n, kappa, u, 1.0 - u) - truth)), 4e-15);
        EXPECT_LT(relative_error(transmission_scaled(f0, n, kappa, u, 1.0 - u), 1 - truth), 4e-15);
      }
      EXPECT_EQ(fresnel_scaled(f0, n, kappa, 1.0, 0.0), f0);
      EXPECT_NEAR(fresnel_scaled(f0, n, kappa, 0.0, 1.0), 1.0, 1e-15);
    }
    EXPECT_NEAR(fresnel_scaled(mean_f0, n, kappa, 0.4, 0.6), fresnel_exact(n, kappa, 0.4, 0.6), 1e-15);
  }
  EXPECT_LT(fresnel_scaled(0.0, 0.958, 6.69, 0.3, 0.7), 0.0);  // as the header warns
}

}  // namespace
}  // namespace goniofit
