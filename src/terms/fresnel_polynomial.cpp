#include "terms/fresnel_polynomial.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "terms/chebyshev_fit.h"
#include "terms/fresnel.h"

namespace goniofit {
namespace {

template <std::size_t length>
FresnelPolynomial fit_of_length(double n, double kappa) {
  FresnelPolynomial p;
  p.length = length;
  const auto c = chebyshev::fit_line<length>([&](double t) {
    const double u = 0.5 * (1.0 + t);
    return fresnel_exact(n, kappa, u, 1.0 - u);
  });
  std::copy(c.begin(), c.end(), p.coefficients.begin());
  // Ten places between extremes of the error.
  constexpr std::size_t steps = 10 * length;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(steps);
    const double exact = fresnel_exact(n, kappa, u, 1.0 - u);
    const double error = std::fabs(fresnel_polynomial<length>(p.coefficients.data(), u) / exact - 1.0);
    p.error = error <= p.error ? p.error : error;
  }
  return p;
}

}  // namespace

FresnelPolynomial fit_fresnel(double n, double kappa, double tolerance) {
  FresnelPolynomial found;
  const auto try_length = [&]<std::size_t length>() {
    found = fit_of_length<length>(n, kappa);
    return found.error <= tolerance;
  };
  const bool reached = [&]<std::size_t... i>(std::index_sequence<i...>) {
    return (try_length.template operator()<FresnelPolynomial::lengths[i]>() || ...);
  }
  (std::make_index_sequence<FresnelPolynomial::lengths.size()>());
  return reached ? found : FresnelPolynomial{};
}

}  // namespace goniofit
