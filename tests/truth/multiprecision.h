#pragma once
// The arithmetic of the truth tables: MPFR floats, whose elementary functions are correctly rounded, and the little the
// definitions need beside them.
//
// Real carries 400 decimal digits, so that a definition can stand exactly as printed: 1 - (1 - c)^q near the normal or
// 1 + (z0/sigma)² near its limit cancel up to 324 digits before the result leaves the range of doubles, and more than
// 70 remain. Hundred (100 digits) serves derivatives and long sums, where nothing cancels by more than 40.

#include <boost/multiprecision/mpfr.hpp>
#include <ios>
#include <string>

namespace goniofit::truth {

template <unsigned digits>
using Digits = boost::multiprecision::number<
    boost::multiprecision::mpfr_float_backend<digits, boost::multiprecision::allocate_stack>,
    boost::multiprecision::et_off>;
using Real = Digits<400>;
using Hundred = Digits<100>;

template <class R>
[[nodiscard]] R pi() {
  R value;
  mpfr_const_pi(value.backend().data(), MPFR_RNDN);
  return value;
}

/// numerator / denominator: a decimal constant such as 0.45 as the papers mean it, not as a double rounds it.
template <class R>
[[nodiscard]] R ratio(long numerator, long denominator) {
  return R(numerator) / R(denominator);
}

template <class R>
[[nodiscard]] R square(const R& x) {
  return x * x;
}

/// To 75 digits of itself, x >= 0, whatever the digits of R: its one cancellation in the definitions, Smith's Lambda,
/// costs 2 log10 x of them and ends at x = 30, where all is below the range of doubles. MPFR's own takes milliseconds
/// from x = 4 on; there the continued fraction (Abramowitz & Stegun 7.1.14)
/// erfc x = e^(-x²)/sqrt(pi) 1/(x + (1/2)/(x + 1/(x + (3/2)/(x + ...)))) is evaluated from a depth that leaves 1e-80.
/// The two are compared in tables_test.cpp.
template <class R>
[[nodiscard]] R complementary_error(const R& argument) {
  using Few = Digits<90>;
  const Few x(argument);
  Few value;
  if (x < 4) {
    mpfr_erfc(value.backend().data(), x.backend().data(), MPFR_RNDN);
    return R(value);
  }
  const long depth = 50 + static_cast<long>(5000 / square(static_cast<double>(x)));
  Few tail = x;
  for (long k = depth; k >= 1; --k) tail = x + k / (2 * tail);
  return R(exp(-x * x) / (sqrt(pi<Few>()) * tail));
}

/// ln Gamma(x), x > 0.
template <class R>
[[nodiscard]] R log_gamma(const R& x) {
  R value;
  mpfr_lngamma(value.backend().data(), x.backend().data(), MPFR_RNDN);
  return value;
}

// Sine and cosine of an angle in degrees. The reduction to the first octant is done in degrees, where it is exact, so
// that azimuths 180° apart give opposite vectors to the last bit and the exact mirror direction has s_x = s_y = 0.
template <class R>
[[nodiscard]] R sin_first_quadrant_deg(const R& d) {
  const R degree = pi<R>() / 180;
  return d <= 45 ? R(sin(d * degree)) : R(cos((90 - d) * degree));
}

template <class R>
[[nodiscard]] R sin_deg(const R& degrees) {
  R d = fmod(degrees, R(360));
  if (d < 0) d += 360;
  if (d >= 360) d -= 360;
  const int quadrant = static_cast<int>(floor(d / 90));
  const R rest = d - 90 * quadrant;
  const R magnitude = sin_first_quadrant_deg(quadrant % 2 == 0 ? rest : R(90 - rest));
  return quadrant < 2 ? magnitude : R(-magnitude);
}

template <class R>
[[nodiscard]] R cos_deg(const R& degrees) {
  return sin_deg(R(degrees + 90));
}

/// What complex Fresnel reflection needs of complex numbers (std::complex is specified for built-in floats only).
template <class R>
struct Complex {
  R re, im;
  friend Complex operator+(const Complex& a, const Complex& b) { return {a.re + b.re, a.im + b.im}; }
  friend Complex operator-(const Complex& a, const Complex& b) { return {a.re - b.re, a.im - b.im}; }
  friend Complex operator*(const Complex& a, const Complex& b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
  }
  friend Complex operator/(const Complex& a, const Complex& b) {
    const R d = b.re * b.re + b.im * b.im;
    return {(a.re * b.re + a.im * b.im) / d, (a.im * b.re - a.re * b.im) / d};
  }
};

template <class R>
[[nodiscard]] R squared_modulus(const Complex<R>& z) {
  return z.re * z.re + z.im * z.im;
}

/// The principal root: real part >= 0.
template <class R>
[[nodiscard]] Complex<R> square_root(const Complex<R>& z) {
  const R modulus = sqrt(squared_modulus(z));
  const R re = sqrt((modulus + z.re) / 2);
  const R im = sqrt((modulus - z.re) / 2);
  return {re, z.im < 0 ? R(-im) : im};
}

/// `digits` significant decimal digits, "inf" and "-inf" included, "0" for what rounds to 0 as a double.
template <class R>
[[nodiscard]] std::string text(const R& value, int digits) {
  using boost::multiprecision::isfinite;
  if (isfinite(value) && abs(value) < R("2.4e-324")) return "0";
  return value.str(digits, std::ios_base::fmtflags{});
}

}  // namespace goniofit::truth
