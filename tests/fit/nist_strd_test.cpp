// NIST's reference problems for non-linear regression through the plumbing that fits BRDFs: bounded coefficients solved
// at given shape, the search over the shape, Ceres' polish, the uncertainties. Certified to 11 digits, from two starts
// each, the first one far. The files under nist/ hold readings, starts and certified values.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <sstream>

#include "fit/nist_models.h"
#include "fit/polish.h"
#include "fit/problem.h"
#include "fit/search.h"
#include "fit/uncertainty.h"
#include "support/error_message.h"
#include "support/paths.h"

namespace goniofit {
namespace {

using test::nist::Layout;
using test::nist::parameter;

struct Certified {
  double rss = 0.0;
  std::vector<double> start[2], value, deviation;
  PairBatch pairs;
  std::vector<double> y;
};

Certified read(const std::string& name) {
  const std::filesystem::path path = test::source_dir() / "tests/fit/nist" / (name + ".txt");
  std::ifstream in(path);
  if (!in) throw std::runtime_error("no file " + path.string());
  Certified c;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "rss") words >> c.rss;
    if (kind == "b") {
      double numbers[4] = {};
      for (double& x : numbers) words >> x;
      c.start[0].push_back(numbers[0]);
      c.start[1].push_back(numbers[1]);
      c.value.push_back(numbers[2]);
      c.deviation.push_back(numbers[3]);
    }
    if (kind == "d") {
      Pair pair{};
      double y = 0.0;
      words >> y >> pair.dot_h;
      if (double x2 = 0.0; words >> x2) pair.s_h2 = x2;
      c.y.push_back(name == "nelson" ? std::log(y) : y);
      c.pairs.push_back(pair);
    }
  }
  return c;
}

struct Case {
  const char* name;
  std::unique_ptr<const Basis> (*basis)(const Layout&);
  Layout layout;
  /// Whether the polish alone, from NIST's starts as they are, ends in the certified minimum.
  bool from_start[2] = {true, true};
  /// Narrower bounds for the search, where those that hold the far start overflow the shape factors elsewhere.
  std::map<std::string, ParameterSetting> search_within{};

  friend std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }
};

std::vector<Case> cases() {
  using namespace test::nist;
  const Layout misra{"cs", {parameter("b2", 1e-6, 1e-1)}};
  const Layout chwirut{"sss", {parameter("b1", 1e-3, 10), parameter("b2", 1e-4, 1), parameter("b3", 1e-4, 1)}};
  const Layout lanczos{"cscscs",
                       {parameter("b2", 0.1, 20), parameter("b4", 0.1, 20), parameter("b6", 0.1, 20)},
                       {{1, 0}, {3, 2}, {5, 4}}};
  const Layout gauss{"cscsscss",
                     {parameter("b2", 1e-3, 0.1), parameter("b4", 40, 140), parameter("b5", 5, 60),
                      parameter("b7", 100, 240), parameter("b8", 5, 60)}};
  std::vector<Case> all;
  all.push_back({"misra1a", basis_of<Saturation>, misra});
  all.push_back({"misra1b", basis_of<Misra1b>, misra});
  all.push_back({"misra1c", basis_of<Misra1c>, misra});
  all.push_back({"misra1d", basis_of<Misra1d>, misra});
  all.push_back({"boxbod", basis_of<Saturation>, {"cs", {parameter("b2", 1e-3, 1e2)}}});
  all.push_back({"danwood", basis_of<DanWood>, {"cs", {parameter("b2", 0.1, 20)}}});
  all.push_back({"mgh09",
                 basis_of<Mgh09>,
                 {"csss", {parameter("b2", 1e-3, 1e3), parameter("b3", 1e-3, 1e3), parameter("b4", 1e-3, 1e3)}}});
  // From the first start the polish creeps along a curved valley, and says that it has not converged.
  all.push_back({"mgh10",
                 basis_of<Mgh10>,
                 {"css", {parameter("b2", 10, 1e7, 0, 0.05), parameter("b3", 1, 1e6, 0, 0.05)}},
                 {false, true},
                 {{"b2", {{}, 1e3, 3e4}}, {"b3", {{}, 100, 1000}}}});
  // At the first start both exponentials are over before the second reading: nothing tells the polish where to go.
  all.push_back({"mgh17",
                 basis_of<Mgh17>,
                 {"cccss", {parameter("b4", 1e-4, 10), parameter("b5", 1e-4, 10)}, {{3, 1}, {4, 2}}},
                 {false, true}});
  all.push_back({"rat42", basis_of<Rat42>, {"css", {parameter("b2", 0.01, 20), parameter("b3", 1e-3, 1)}}});
  all.push_back({"rat43",
                 basis_of<Rat43>,
                 {"csss", {parameter("b2", 0.1, 30), parameter("b3", 1e-2, 10), parameter("b4", 0.05, 20)}}});
  all.push_back(
      {"eckerle4", basis_of<Eckerle4>, {"css", {parameter("b2", 0.5, 50), parameter("b3", 395, 505, 0, 0.02)}}});
  all.push_back({"chwirut1", basis_of<Chwirut>, chwirut});
  all.push_back({"chwirut2", basis_of<Chwirut>, chwirut});
  all.push_back({"lanczos1", basis_of<Lanczos>, lanczos});
  all.push_back({"lanczos2", basis_of<Lanczos>, lanczos});
  all.push_back({"lanczos3", basis_of<Lanczos>, lanczos});
  all.push_back({"gauss1", basis_of<Gauss>, gauss});
  all.push_back({"gauss2", basis_of<Gauss>, gauss});
  all.push_back({"gauss3", basis_of<Gauss>, gauss});
  all.push_back({"thurber",
                 basis_of<Thurber>,
                 {"ccccsss", {parameter("b5", 1e-3, 10), parameter("b6", 1e-3, 10), parameter("b7", 1e-3, 10)}}});
  all.push_back({"kirby2", basis_of<Kirby2>, {"cccss", {parameter("b4", -0.0095, 0.1), parameter("b5", 1e-7, 1e-2)}}});
  all.push_back(
      {"hahn1",
       basis_of<Hahn1>,
       {"ccccsss", {parameter("b5", -0.09, 0.1), parameter("b6", 1e-6, 1e-1), parameter("b7", -1.95e-6, 1e-5)}}});
  all.push_back(
      {"bennett5", basis_of<Bennett5>, {"css", {parameter("b2", 10, 200, 0, 0.03), parameter("b3", 0.3, 3, 0, 0.03)}}});
  all.push_back({"roszman1", basis_of<Roszman1>, {"ccss", {parameter("b3", 10, 1e5), parameter("b4", -450, 400)}}});
  all.push_back(
      {"enso",
       basis_of<Enso>,
       {"cccsccscc", {parameter("b4", 15, 100, 0, 0.04), parameter("b7", 15, 100, 0, 0.04)}, {{3, 4, 5}, {6, 7, 8}}}});
  all.push_back({"nelson", basis_of<Nelson>, {"ccs", {parameter("b3", -0.19, 0.1, 0, 0.02)}}});
  return all;
}

// The default of 1e-14 of the loss is some 1e-6 standard errors, which of a parameter that is known to half its value
// (enso) is less than six digits.
constexpr double tolerance = 1e-17;

class NistStrd : public testing::TestWithParam<Case> {
 protected:
  NistStrd() : data_(read(GetParam().name)), problem_(problem_within({})) {}

  [[nodiscard]] Problem problem_within(const std::map<std::string, ParameterSetting>& bounds) const {
    FitSettings settings;
    settings.parameters = bounds;
    const auto n = static_cast<Eigen::Index>(data_.y.size());
    return {GetParam().basis(GetParam().layout),
            {data_.pairs, {Eigen::Map<const Eigen::VectorXd>(data_.y.data(), n)}},
            settings};
  }

  /// NIST's numbers as a point of the problem.
  [[nodiscard]] FitPoint point_at(const std::vector<double>& b) const {
    FitPoint p;
    SmallVector k = problem_.channels[0].lower;  // constants are where they have to be
    Eigen::Index coefficient = 0;
    for (std::size_t i = 0; i < b.size(); ++i) {
      if (is_coefficient(i)) {
        k[coefficient++] = b[i];
      } else {
        p.z.push_back(std::log(b[i] - shape(p.z.size()).origin));
      }
    }
    p.coefficients.push_back(k);
    return p;
  }

  /// A point in NIST's numbers.
  [[nodiscard]] std::vector<double> numbers_at(const FitPoint& p) const {
    std::vector<double> b;
    std::size_t z = 0;
    Eigen::Index coefficient = 0;
    for (std::size_t i = 0; i < data_.value.size(); ++i) {
      if (is_coefficient(i)) {
        b.push_back(p.coefficients[0][coefficient++]);
      } else {
        b.push_back(shape(z).origin + std::exp(p.z[z]));
        ++z;
      }
    }
    return b;
  }

  /// Classical standard errors in NIST's numbers; where double precision has no digits of s, with NIST's.
  [[nodiscard]] std::vector<double> deviations_at(const FitPoint& p) const {
    const Uncertainties u = uncertainties(problem_, p, linearise(problem_, p));
    const double s_certified = std::sqrt(data_.rss / static_cast<double>(data_.y.size() - data_.value.size()));
    const auto deviation = [&](const ParameterUncertainty& of) {
      return exact() ? s_certified * of.u_unscaled : of.u_classical;
    };
    std::vector<double> out;
    std::size_t z = 0;
    std::size_t coefficient = 0;
    for (std::size_t i = 0; i < data_.value.size(); ++i) {
      if (is_coefficient(i)) {
        out.push_back(deviation(u.coefficients[0][coefficient++]));
      } else {
        out.push_back(std::exp(p.z[z]) * deviation(u.shape[z]));
        ++z;
      }
    }
    return out;
  }

  /// Puts interchangeable terms in the order of the certified ones.
  void put_in_order(std::vector<double>& b, std::vector<double>& u) const {
    const auto& terms = GetParam().layout.terms;
    if (terms.empty()) return;
    std::vector<std::size_t> rank(terms.size());
    std::vector<std::size_t> certified(terms.size());
    for (std::size_t t = 0; t < terms.size(); ++t) rank[t] = certified[t] = t;
    const auto by = [&terms](const std::vector<double>& v) {
      return [&terms, &v](std::size_t s, std::size_t t) { return v[terms[s][0]] < v[terms[t][0]]; };
    };
    std::sort(rank.begin(), rank.end(), by(b));
    std::sort(certified.begin(), certified.end(), by(data_.value));
    const std::vector<double> from = b;
    const std::vector<double> from_u = u;
    for (std::size_t t = 0; t < terms.size(); ++t) {
      for (std::size_t i = 0; i < terms[t].size(); ++i) {
        b[terms[certified[t]][i]] = from[terms[rank[t]][i]];
        u[terms[certified[t]][i]] = from_u[terms[rank[t]][i]];
      }
    }
  }

  /// Digits of the worst: the logarithm of the relative error.
  static double digits(const std::vector<double>& found, const std::vector<double>& certified) {
    double worst = 11.0;  // as many as NIST gives
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double error = std::fabs(found[i] / certified[i] - 1.0);
      worst = std::isfinite(error) ? std::min(worst, -std::log10(std::max(error, 1e-11))) : 0.0;
    }
    return std::max(worst, 0.0);
  }

  struct Digits {
    double parameters, deviations, rss;
  };
  [[nodiscard]] Digits digits_of(const FitPoint& p) const {
    std::vector<double> b = numbers_at(p);
    std::vector<double> u = deviations_at(p);
    put_in_order(b, u);
    return {digits(b, data_.value), digits(u, data_.deviation), digits({p.loss}, {data_.rss})};
  }

  void expect_precise(const Digits& d) const {
    EXPECT_GE(d.parameters, 6.0);
    EXPECT_GE(d.deviations, 5.0);
  }

  /// Whether all that the data leave is the rounding of their 14th digit.
  [[nodiscard]] bool exact() const { return data_.rss < 1e-20; }
  [[nodiscard]] bool is_coefficient(std::size_t i) const { return GetParam().layout.roles[i] == 'c'; }
  [[nodiscard]] const ShapeParameter& shape(std::size_t z) const { return problem_.basis->shape_parameters()[z]; }

  Certified data_;
  Problem problem_;
};

// The data are NIST's: at the certified parameters the residual sum of squares is the certified one. Those of lanczos1
// are exact to 14 digits and certified to 11, which is more than its residuals.
TEST_P(NistStrd, CertifiedResidualsReproduce) {
  const double loss = linearise(problem_, point_at(data_.value)).loss;
  if (exact()) {
    EXPECT_LT(loss, 1e-18);
  } else {
    EXPECT_NEAR(loss / data_.rss, 1.0, 1e-8);
  }
}

TEST_P(NistStrd, EndsInTheCertifiedMinimum) {
  std::ostringstream line;
  line << std::fixed << std::setprecision(1) << std::left << std::setw(9) << GetParam().name << std::right;
  for (std::size_t s = 0; s < 2; ++s) {
    SCOPED_TRACE("start " + std::to_string(s + 1));
    const Polished alone = polish(problem_, point_at(data_.start[s]), tolerance);
    const Digits d = digits_of(alone.point);
    line << "  start " << s + 1 << std::setw(6) << d.parameters << std::setw(6) << d.deviations << std::setw(5)
         << alone.iterations << (alone.converged ? " " : "!");
    EXPECT_EQ(d.parameters >= 6.0, GetParam().from_start[s]);
    if (GetParam().from_start[s]) expect_precise(d);
  }
  const Problem problem = problem_within(GetParam().search_within);
  const SearchOutcome found = search(problem);
  Polished best;
  for (const FitPoint& minimum : found.minima) {
    Polished polished = polish(problem, minimum, tolerance);
    if (&minimum == &found.minima.front() || polished.point.loss < best.point.loss) best = std::move(polished);
  }
  const Digits d = digits_of(best.point);
  line << "  search" << std::setw(6) << d.parameters << std::setw(6) << d.deviations << std::setw(6) << d.rss
       << std::setw(7) << found.evaluations;
  std::cout << line.str() << '\n';
  expect_precise(d);
  EXPECT_TRUE(best.converged);
  if (!exact()) {
    EXPECT_GE(d.rss, 9.0);
  }
}

// What a fit leaves open at its own accuracy does not show beside the standard errors.
TEST_P(NistStrd, DefaultAccuracyIsFarBelowTheStandardErrors) {
  const std::vector<double> b = numbers_at(polish(problem_, point_at(data_.start[1])).point);
  for (std::size_t i = 0; i < b.size(); ++i) {
    const double deviation = exact() ? 1e-4 * data_.value[i] : data_.deviation[i];
    EXPECT_LT(std::fabs(b[i] - data_.value[i]), 1e-4 * deviation) << "b" << i + 1;
  }
}

INSTANTIATE_TEST_SUITE_P(All, NistStrd, testing::ValuesIn(cases()),
                         [](const auto& instance) { return std::string(instance.param.name); });

std::unique_ptr<const Basis> saturation() {
  return test::nist::basis_of<test::nist::Saturation>({"cs", {parameter("b2", 1e-6, 1e-1)}});
}

// A weight of 4 is half the uncertainty: the unscaled form takes its word, the classical one finds the same scatter.
TEST(ReadingsProblem, WeightsScaleTheUnscaledFormAlone) {
  const Certified c = read("misra1a");
  const Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(c.y.data(), static_cast<Eigen::Index>(c.y.size()));
  const auto uncertainty = [&](const Eigen::VectorXd& weight) {
    const Problem problem(saturation(), {c.pairs, {y, 2.0 * y}, weight});
    const Polished best = polish(problem, search(problem).minima.front());
    EXPECT_NEAR(best.point.coefficients[1][0] / best.point.coefficients[0][0], 2.0, 1e-8);
    return uncertainties(problem, best.point, linearise(problem, best.point)).shape[0];
  };
  const ParameterUncertainty one = uncertainty({});
  const ParameterUncertainty four = uncertainty(Eigen::VectorXd::Constant(y.size(), 4.0));
  EXPECT_NEAR(four.u_unscaled / one.u_unscaled, 0.5, 1e-6);
  EXPECT_NEAR(four.u_classical / one.u_classical, 1.0, 1e-6);
  EXPECT_NEAR(four.u / one.u, 1.0, 1e-6);
}

TEST(ReadingsProblem, ContradictionsAreNamed) {
  const Certified c = read("misra1a");
  const auto message = [&](Readings readings) {
    return test::error_message([&] { const Problem problem(saturation(), std::move(readings)); });
  };
  const Eigen::VectorXd y = Eigen::VectorXd::Ones(14);
  EXPECT_NE(message({{}, {Eigen::VectorXd{}}}).find("none given"), std::string::npos);
  EXPECT_NE(message({c.pairs, {}}).find("none given"), std::string::npos);
  EXPECT_NE(message({c.pairs, {y, Eigen::VectorXd::Ones(13)}}).find("13 values in channel 2"), std::string::npos);
  EXPECT_NE(message({c.pairs, {y}, Eigen::VectorXd::Zero(14)}).find("a weight above zero"), std::string::npos);
  EXPECT_NE(message({c.pairs, {y}, Eigen::VectorXd::Ones(15)}).find("a weight above zero"), std::string::npos);
}

}  // namespace
}  // namespace goniofit
