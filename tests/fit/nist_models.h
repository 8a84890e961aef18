#pragma once
// The 27 problems of NIST's Statistical Reference Datasets for non-linear regression
// (https://www.itl.nist.gov/div898/strd/nls/nls_main.shtml) as bases: all of them are sums of coefficients times shape
// factors. Abscissas stand in two members of a pair: x (or x1) in dot_h, x2 in s_h2.

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "basis/pointwise_basis.h"

namespace goniofit::test::nist {

/// How NIST's b1, b2 ... are split: 'c' a coefficient, 's' a shape parameter, each counted in its order. Columns beyond
/// the coefficients have the constant 1.
struct Layout {
  const char* roles;
  std::vector<ShapeParameter> shape;  ///< named by NIST's names; bounds hold both starts
  /// Parameters of interchangeable terms: 0-based numbers of each term, the one that they are told apart by first.
  std::vector<std::vector<std::size_t>> terms{};
};

inline ShapeParameter parameter(const char* name, double lower, double upper, double origin = 0.0, double step = 0.25) {
  return {.name = name, .unit = "", .lower = lower, .upper = upper, .origin = origin, .step = step};
}

/// Values of the shape parameters from their logarithms.
template <class Model, class T>
std::array<T, Model::parameters> values_of(const T* z) {
  using std::exp;
  std::array<T, Model::parameters> b;
  for (std::size_t k = 0; k < b.size(); ++k) b[k] = Model::origin[k] + exp(z[k]);
  return b;
}

/// What all models have; `unshaped` leading columns do not read the shape.
template <std::size_t columns_, std::size_t parameters_, std::size_t unshaped_ = 0>
struct Sizes {
  static constexpr std::size_t columns = columns_, parameters = parameters_, unshaped = unshaped_;
  static constexpr std::array<double, parameters_> origin{};
};

struct Saturation : Sizes<1, 1> {  // Misra1a, BoxBOD
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    using std::exp;
    f[0] = 1.0 - exp(-values_of<Saturation>(z)[0] * p.dot_h);
  }
};

struct Misra1b : Sizes<1, 1> {
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    const T u = 1.0 + 0.5 * p.dot_h * values_of<Misra1b>(z)[0];
    f[0] = 1.0 - 1.0 / (u * u);
  }
};

struct Misra1c : Sizes<1, 1> {
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    using std::sqrt;
    f[0] = 1.0 - 1.0 / sqrt(1.0 + 2.0 * p.dot_h * values_of<Misra1c>(z)[0]);
  }
};

struct Misra1d : Sizes<1, 1> {
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    const T u = values_of<Misra1d>(z)[0] * p.dot_h;
    f[0] = u / (1.0 + u);
  }
};

struct DanWood : Sizes<1, 1> {
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    using std::exp;
    f[0] = exp(values_of<DanWood>(z)[0] * std::log(p.dot_h));
  }
};

struct Mgh09 : Sizes<1, 3> {
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    const auto b = values_of<Mgh09>(z);
    const double x = p.dot_h;
    f[0] = x * (x + b[0]) / (x * (x + b[1]) + b[2]);
  }
};

struct Mgh10 : Sizes<1, 2> {
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    using std::exp;
    const auto b = values_of<Mgh10>(z);
    f[0] = exp(b[0] / (p.dot_h + b[1]));
  }
};

struct Mgh17 : Sizes<3, 2, 1> {
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    using std::exp;
    const auto b = values_of<Mgh17>(z);
    f[0] = T(1.0);
    f[1] = exp(-b[0] * p.dot_h);
    f[2] = exp(-b[1] * p.dot_h);
  }
};

struct Rat42 : Sizes<1, 2> {
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    using std::exp;
    const auto b = values_of<Rat42>(z);
    f[0] = 1.0 / (1.0 + exp(b[0] - b[1] * p.dot_h));
  }
};

struct Rat43 : Sizes<1, 3> {
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    using std::exp;
    using std::log;
    const auto b = values_of<Rat43>(z);
    f[0] = exp(-log(1.0 + exp(b[0] - b[1] * p.dot_h)) / b[2]);
  }
};

struct Eckerle4 : Sizes<1, 2> {
  static constexpr std::array<double, 2> origin{0.0, 300.0};
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    using std::exp;
    const auto b = values_of<Eckerle4>(z);
    const T u = (p.dot_h - b[1]) / b[0];
    f[0] = exp(-0.5 * u * u) / b[0];
  }
};

struct Chwirut : Sizes<1, 3> {  // no coefficient at all: its column has the constant 1
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    using std::exp;
    const auto b = values_of<Chwirut>(z);
    f[0] = exp(-b[0] * p.dot_h) / (b[1] + b[2] * p.dot_h);
  }
};

struct Lanczos : Sizes<3, 3> {
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    using std::exp;
    const auto b = values_of<Lanczos>(z);
    for (std::size_t j = 0; j < 3; ++j) f[j] = exp(-b[j] * p.dot_h);
  }
};

struct Gauss : Sizes<3, 5> {
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    using std::exp;
    const auto b = values_of<Gauss>(z);
    const T u = (p.dot_h - b[1]) / b[2];
    const T v = (p.dot_h - b[3]) / b[4];
    f[0] = exp(-b[0] * p.dot_h);
    f[1] = exp(-u * u);
    f[2] = exp(-v * v);
  }
};

/// Of degree columns - 1 over degree parameters.
template <class Model, class T>
void rational(double x, const T* z, T* f) {
  const auto b = values_of<Model>(z);
  T denominator(0.0);
  for (std::size_t k = b.size(); k-- > 0;) denominator = x * (denominator + b[k]);
  f[0] = 1.0 / (1.0 + denominator);
  for (std::size_t j = 1; j < Model::columns; ++j) f[j] = x * f[j - 1];
}

struct Thurber : Sizes<4, 3> {
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    rational<Thurber>(p.dot_h, z, f);
  }
};

struct Hahn1 : Sizes<4, 3> {
  static constexpr std::array<double, 3> origin{-0.1, 0.0, -2e-6};
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    rational<Hahn1>(p.dot_h, z, f);
  }
};

struct Kirby2 : Sizes<3, 2> {
  static constexpr std::array<double, 2> origin{-0.01, 0.0};
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    rational<Kirby2>(p.dot_h, z, f);
  }
};

struct Bennett5 : Sizes<1, 2> {
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    using std::exp;
    using std::log;
    const auto b = values_of<Bennett5>(z);
    f[0] = exp(-log(b[0] + p.dot_h) / b[1]);
  }
};

struct Roszman1 : Sizes<3, 2, 2> {
  static constexpr std::array<double, 2> origin{0.0, -460.0};
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    using std::atan;
    const auto b = values_of<Roszman1>(z);
    f[0] = T(1.0);
    f[1] = T(-p.dot_h);
    f[2] = -atan(b[0] / (p.dot_h - b[1])) / 3.14159265358979323846;
  }
};

struct Enso : Sizes<7, 2, 3> {
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    using std::cos;
    using std::sin;
    const auto b = values_of<Enso>(z);
    const double turn = 2.0 * 3.14159265358979323846 * p.dot_h;
    f[0] = T(1.0);
    f[1] = T(std::cos(turn / 12.0));
    f[2] = T(std::sin(turn / 12.0));
    for (std::size_t k = 0; k < 2; ++k) {
      f[3 + 2 * k] = cos(turn / b[k]);
      f[4 + 2 * k] = sin(turn / b[k]);
    }
  }
};

struct Nelson : Sizes<2, 1, 1> {
  static constexpr std::array<double, 1> origin{-0.2};
  template <class T>
  static void factors(const Pair& p, const T* z, T* f) {
    using std::exp;
    f[0] = T(1.0);
    f[1] = -p.dot_h * exp(-values_of<Nelson>(z)[0] * p.s_h2);
  }
};

template <class Model>
std::unique_ptr<const Basis> basis_of(const Layout& layout) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<BasisCoefficient> coefficients;
  std::vector<BasisColumn> columns;
  std::vector<ShapeParameter> shape = layout.shape;
  for (std::size_t k = 0; k < shape.size(); ++k) shape[k].origin = Model::origin[k];
  const std::string roles = layout.roles;
  for (std::size_t i = 0; i < roles.size(); ++i) {
    if (roles[i] == 'c') coefficients.push_back({"b" + std::to_string(i + 1), -infinity, infinity});
  }
  while (coefficients.size() < Model::columns) coefficients.push_back({"one", 1.0, 1.0});
  for (std::size_t j = 0; j < Model::columns; ++j) columns.push_back({j, OpticsFactor::one, j >= Model::unshaped});
  return std::make_unique<PointwiseBasis<Model>>(coefficients, columns, shape);
}

}  // namespace goniofit::test::nist
