#include "cost/model_error.h"

#include <algorithm>
#include <cmath>

namespace goniofit {

namespace {

// A quotient of two sums over the same random directions, and the standard error of it.
class Quotient {
 public:
  void add(double difference, double reference) noexcept {
    difference_ += difference;
    reference_ += reference;
    dd_ += difference * difference;
    dr_ += difference * reference;
    rr_ += reference * reference;
  }
  // What is known exactly, times the number of directions drawn.
  void add_exact(double difference, double reference) noexcept {
    difference_ += difference;
    reference_ += reference;
  }
  [[nodiscard]] double difference() const noexcept { return difference_; }
  [[nodiscard]] double reference() const noexcept { return reference_; }
  [[nodiscard]] double value() const noexcept {
    if (reference_ > 0.0) return difference_ / reference_;
    return difference_ > 0.0 ? 1.0 : 0.0;
  }
  /// Of the linearised quotient: sum (difference - q reference)² / (sum reference)².
  [[nodiscard]] double standard_error() const noexcept {
    if (!(reference_ > 0.0)) return 0.0;
    const double q = value();
    return std::sqrt(std::max(0.0, dd_ - 2.0 * q * dr_ + q * q * rr_)) / reference_;
  }

 private:
  double difference_ = 0.0, reference_ = 0.0, dd_ = 0.0, dr_ = 0.0, rr_ = 0.0;
};

struct Relative {
  double squares = 0.0, largest = 0.0;
  std::size_t count = 0;
  void add(double difference, double reference) noexcept {
    const double r = std::fabs(difference) / std::max(reference, least_f);
    squares += r * r;
    largest = std::max(largest, r);
    ++count;
  }
};

}  // namespace

ModelError model_error(const ErrorSamples& s, const ModelValues& reference, const ModelValues& candidate,
                       std::span<const std::size_t> channels) {
  ModelError e;
  Relative relative;
  double difference_sum = 0.0;
  double reference_sum = 0.0;
  const std::size_t n = s.directions.size();
  const std::size_t incidences = s.mirrors.size();
  for (std::size_t c = 0; c < reference.channels; ++c) {
    if (!channels.empty() && std::find(channels.begin(), channels.end(), c) == channels.end()) continue;
    for (std::size_t i = 0; i < incidences; ++i) {
      Quotient q;
      for (std::size_t k = s.first[i]; k < s.first[i + 1]; ++k) {
        const double f = reference.f[c * n + k];
        const double d = candidate.f[c * n + k] - f;
        q.add(s.weights[k] * std::fabs(d), s.weights[k] * f);
        relative.add(d, f);
      }
      if (s.theta_i_deg[i] <= s.theta_r_max_deg) {
        const std::size_t m = c * incidences + i;
        const double energy = reference.mirror_energy[m];
        const double energy_difference = candidate.mirror_energy[m] - energy;
        q.add_exact(s.drawn * std::fabs(energy_difference), s.drawn * energy);
        const double per_energy = 1.0 / (s.mirrors.l_z[i] * s.solid_angle_sr);
        relative.add(candidate.mirror[m] - reference.mirror[m] + energy_difference * per_energy,
                     reference.mirror[m] + energy * per_energy);
      }
      difference_sum += q.difference();
      reference_sum += q.reference();
      e.worst_l1_bound = std::max(e.worst_l1_bound, q.value() + 3.0 * q.standard_error());
      if (q.value() > e.worst_l1) {
        e.worst_l1 = q.value();
        e.worst_theta_i_deg = s.theta_i_deg[i];
      }
    }
  }
  e.l1 = reference_sum > 0.0 ? difference_sum / reference_sum : 0.0;
  e.rms_relative = relative.count > 0 ? std::sqrt(relative.squares / static_cast<double>(relative.count)) : 0.0;
  e.max_relative = relative.largest;
  return e;
}

}  // namespace goniofit
