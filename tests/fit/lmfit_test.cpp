// The same fits by lmfit (M. Newville et al., https://lmfit.github.io/lmfit-py), which minimises by MINPACK with
// numerical derivatives: for reference problems and for a BRDF scan, whose model lmfit_fits.py writes anew from the
// paper. Nothing but the scan's file is common to the two.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

#include "fit/fit.h"
#include "io/scan_reader.h"
#include "support/run_program.h"

namespace goniofit {
namespace {

struct Estimate {
  double value = 0.0, deviation = 0.0;
};
using Estimates = std::map<std::string, Estimate>;  // "fit parameter"

/// A Python that has lmfit; empty where none is here.
std::string python_with_lmfit() {
  for (const char* python : {"/usr/bin/python3", "python3"}) {
    if (test::run({python, "-c", "import lmfit"}).status == 0) return python;
  }
  return {};
}

Estimates lmfit_estimates(const std::string& python) {
  const std::filesystem::path fit = test::source_dir() / "tests/fit";
  const test::Outcome o = test::run({python, (fit / "lmfit_fits.py").string(), (fit / "nist").string(),
                                     (test::source_dir() / "data/ground_glass_41.csv").string()});
  EXPECT_EQ(o.status, 0) << o.err;
  Estimates all;
  std::istringstream in(o.out);
  std::string name;
  std::string parameter;
  for (Estimate e; in >> name >> parameter >> e.value >> e.deviation;) all[name + " " + parameter] = e;
  return all;
}

class Lmfit : public testing::Test {
 protected:
  void SetUp() override {
    const std::string python = python_with_lmfit();
    if (python.empty()) GTEST_SKIP() << "no Python with lmfit is here (Debian: python3-lmfit)";
    estimates_ = lmfit_estimates(python);
  }
  void expect_same(const std::string& name, double value, double deviation) const {
    ASSERT_TRUE(estimates_.contains(name)) << name;
    const Estimate& e = estimates_.at(name);
    EXPECT_NEAR(value / e.value, 1.0, 1e-6) << name;
    EXPECT_NEAR(deviation / e.deviation, 1.0, 1e-4) << name;
  }
  Estimates estimates_;
};

// Ours are held to NIST's values in nist_strd_test.cpp: here lmfit is.
TEST_F(Lmfit, AgreesOnReferenceProblems) {
  for (const char* name : {"misra1a", "rat43", "eckerle4", "mgh09"}) {
    std::istringstream in(test::slurp(test::source_dir() / "tests/fit/nist" / (std::string(name) + ".txt")));
    int parameter = 0;
    for (std::string line; std::getline(in, line);) {
      std::istringstream words(line);
      std::string kind;
      double start = 0.0;
      Estimate e;
      if (words >> kind >> start >> start >> e.value >> e.deviation && kind == "b")
        expect_same(name + std::string(" b") + std::to_string(++parameter), e.value, e.deviation);
    }
    EXPECT_GE(parameter, 2) << name;
  }
}

TEST_F(Lmfit, AgreesOnAScan) {
  FitSettings settings;
  settings.components = EffectSet{Effect::dd, Effect::udf};
  const FitResult r = fit(read_scan(test::source_dir() / "data/ground_glass_41.csv"), settings);
  int compared = 0;
  for (const FittedParameter& p : r.parameters) {
    if (!p.u) continue;
    ASSERT_TRUE(p.u_classical);
    const std::size_t channel = std::string("RGB").find(p.channel);
    expect_same("scan " + p.name + (p.channel.empty() ? "" : std::to_string(channel)), *p.value, *p.u_classical);
    ++compared;
  }
  EXPECT_EQ(compared, 7);
}

}  // namespace
}  // namespace goniofit
