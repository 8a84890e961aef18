#pragma once
// What every model owes its callers, as one suite that runs over any material:
//
//   GONIOFIT_LAWS(Paint, {.name = "garnet", .material = test::garnet_red_paint_13()});
//
// checks of each case that its values are finite and not negative, that it is reciprocal, that it reflects no more than
// it receives, that it has the symmetry it claims, and that all arithmetics agree on it. A model that breaks a law says
// where and by how much, and the suite holds it to that number from both sides. laws.cpp has the checks.

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "brdf/material.h"
#include "geometry/pair.h"

namespace goniofit::test {

/// A directional albedo above 1 of the first channel, as measured by directional_albedo.
struct Excess {
  double theta_i_deg, phi_i_deg;
  double albedo;
};

/// The largest |f(L,V) - f(V,L)| over the largest f among these pairs.
struct Irreciprocity {
  std::vector<AnglePair> pairs;
  double of_largest;
};

struct LawCase {
  std::string name;
  Material material;

  /// The albedo is at most 1 between these, at every azimuth.
  double conserves_from_deg = 0.0, conserves_up_to_deg = 85.0;
  /// Each within 2 %.
  std::vector<Excess> excess{};

  /// Where it is given, fs as printed and what lies in the mirror cone are left out of the other pairs' test, nothing
  /// else is. Within 10 %.
  std::optional<Irreciprocity> irreciprocity{};

  /// Relative agreement of the values of all arithmetics, of f (1 + |ln f|). That of f(L,V) and f(V,L) is a hundred
  /// times it, since their geometry is rounded differently.
  double precision = 1e-13;
  /// Of the derivatives with differences of the values, whose own error grows with the values'.
  double derivative_precision = 1e-7;
  /// Derivatives are compared where a shape factor is above this.
  double differentiable_above = 1e-100;
  int directions = 500;
};

/// What fs as printed and a mirror cone are held to.
[[nodiscard]] std::vector<AnglePair> in_plane_grid();
/// At 80 degrees, the far edge of the mirror cone of the default solid angle.
[[nodiscard]] std::vector<AnglePair> edge_of_mirror_cone();

/// f of both materials at pairs of directions with the corners drawn often, relative to 1 + |ln f|; first channel.
void expect_same(const Material& a, const Material& b, double tolerance, int directions = 500);

inline std::ostream& operator<<(std::ostream& out, const LawCase& c) { return out << c.name; }
[[nodiscard]] inline std::string law_case_name(const testing::TestParamInfo<LawCase>& info) { return info.param.name; }

class Laws : public testing::TestWithParam<LawCase> {};

}  // namespace goniofit::test

/// Registers the laws for one or more LawCases; their names are letters, digits and _.
#define GONIOFIT_LAWS(family, ...)                                                                               \
  INSTANTIATE_TEST_SUITE_P(family, Laws, testing::ValuesIn(std::vector<::goniofit::test::LawCase>{__VA_ARGS__}), \
                           ::goniofit::test::law_case_name)
