#pragma once
// Derivatives by central differences, and what rounding the inputs alone does to a whole model.

#include <cmath>
#include <limits>

#include "models.h"

namespace goniofit::truth {

/// (f(+h) - f(-h)) / 2h at h = 1e-30: the error h² f''' is below 1e-40 of f', rounding at 100 digits below 1e-60. f
/// takes the step.
template <class F>
[[nodiscard]] Hundred central_difference(const F& f) {
  const Hundred h("1e-30");
  return (f(h) - f(Hundred(-h))) / (2 * h);
}

/// d value(q) / d ln(q.*member).
template <class F>
[[nodiscard]] Hundred log_derivative(const Quantities<Hundred>& at, Hundred Quantities<Hundred>::*member,
                                     const F& value) {
  return central_difference([&](const Hundred& step) {
    Quantities<Hundred> q = at;
    q.*member *= exp(step);
    return value(q);
  });
}

[[nodiscard]] inline double half_ulp(double x) {
  return (std::nextafter(std::fabs(x), std::numeric_limits<double>::infinity()) - std::fabs(x)) / 2;
}

/// How far ln f moves when inputs move by half an ulp, either way, summed over the inputs. The change itself rather
/// than a derivative times the change: at the mirror of a smooth surface the derivative is 0 and a half ulp leaves the
/// lobe.
template <class LogF>
class Conditioning {
 public:
  Conditioning(const Inputs& inputs, const LogF& log_f) : at_(inputs), log_f_(log_f), base_(log_f(at_)) {}

  void add(double value, Hundred Quantities<Hundred>::*member) {
    if (value == 0) return;
    const Hundred change(half_ulp(value));
    const Hundred up = abs(moved(member, change));
    const Hundred down = abs(moved(member, Hundred(-change)));
    total_ += up > down ? up : down;
  }
  [[nodiscard]] const Hundred& total() const { return total_; }

 private:
  [[nodiscard]] Hundred moved(Hundred Quantities<Hundred>::*member, const Hundred& change) const {
    Quantities<Hundred> q = at_;
    q.*member += change;
    return log_f_(q) - base_;
  }

  Quantities<Hundred> at_;
  const LogF& log_f_;
  Hundred base_;
  Hundred total_ = 0;
};

/// The four angles and the slope.
template <class LogF>
[[nodiscard]] Conditioning<LogF> conditioning(const Inputs& a, const LogF& log_f) {
  Conditioning<LogF> c(a, log_f);
  c.add(a.theta_i, &Quantities<Hundred>::theta_i);
  c.add(a.phi_i, &Quantities<Hundred>::phi_i);
  c.add(a.theta_r, &Quantities<Hundred>::theta_r);
  c.add(a.phi_r, &Quantities<Hundred>::phi_r);
  c.add(a.slope, &Quantities<Hundred>::slope);
  return c;
}

}  // namespace goniofit::truth
