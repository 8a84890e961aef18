#include "fit/residual_tests.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <numeric>

#include "fit/order_statistics.h"

namespace goniofit {

void RunsTest::add_line(const std::vector<double>& residuals) {
  int last = 0;
  for (const double r : residuals) {
    const int sign = r > 0.0 ? 1 : r < 0.0 ? -1 : 0;
    if (sign == 0) continue;
    ++readings;
    if (last == 0) ++lines;
    if (sign != last) ++runs;
    last = sign;
  }
}

double RunsTest::p() const {
  const auto n = static_cast<double>(comparisons());
  const auto changes = static_cast<double>(runs - lines);
  // Binomial distribution function by the incomplete beta function.
  return changes >= n ? 1.0 : boost::math::ibeta(n - changes, changes + 1.0, 0.5);
}

ReducedChiSquare reduced_chi_square(double chi_square, std::size_t degrees_of_freedom) {
  const auto dof = static_cast<double>(degrees_of_freedom);
  const boost::math::chi_squared distribution(dof);
  return {chi_square / dof, degrees_of_freedom, boost::math::quantile(distribution, 0.025) / dof,
          boost::math::quantile(distribution, 0.975) / dof};
}

double median_of(std::vector<double>& values) { return value_at_rank(values, (values.size() - 1) / 2); }

}  // namespace goniofit
