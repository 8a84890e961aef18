#pragma once
// Whether a fit's lobes are in its scan, or only in its noise.
//
// Shape parameters say how a lobe looks; where no lobe stands clear of the noise they say nothing, though a search
// finds some value and the residuals some uncertainty for it. A lobe's coefficient over its own standard uncertainty
// does not tell: under noise alone the search picks the shape that makes it large. What tells is what leaving all lobes
// out costs in chi-square, readings divided by the standard deviation of their noise, the other coefficients solved
// again: with C channels chi-square of C degrees of freedom under noise alone (or of one, for the channel that loses
// most, C times), and what halves the loss itself is no noise either. The level is that of four standard
// deviations, 6.3e-5: the search tries some fifty slopes, of which about twenty are independent, so noise passes once
// in a thousand scans, and five standard deviations in one channel of a hundred do.

#include <cstddef>
#include <vector>

#include "linear_parts.h"
#include "model.h"
#include "polish.h"
#include "problem.h"
#include "whitening.h"

namespace goniofit {

inline constexpr double lobe_level = 6.3e-5;

/// Whether all columns of a coefficient read the shape. (Grooves are no lobe: without their facets' slope they still
/// have their albedo.)
[[nodiscard]] bool is_lobe(const Basis& basis, std::size_t coefficient);

struct LobeTest {
  double chi2 = 0.0;  ///< what leaving the lobes out costs
  double p = 0.0;
  bool significant = true;
};
/// Significant without a test where no lobe has a free shape, or the settings demand one.
[[nodiscard]] LobeTest test_lobes(const Problem& problem, const FitPoint& point, const LinearSums& sums);

/// Probability that noise alone makes as much of coh as the material has, sigma being free; 0 where there is nothing to
/// test, or without coh the loss would be twice what it is.
[[nodiscard]] double noise_makes_coherence(const LinearParts& parts, const NoiseModel& noise, double loss,
                                           const Material& material);

/// Bounds of a problem narrowed to 0 for some coefficients, until the end of its life.
class HeldAtZero {
 public:
  explicit HeldAtZero(Problem& problem) : problem_(problem) {
    for (const ProblemChannel& c : problem.channels) bounds_.push_back({c.lower, c.upper});
  }
  HeldAtZero(const HeldAtZero&) = delete;
  HeldAtZero& operator=(const HeldAtZero&) = delete;
  ~HeldAtZero() {
    for (std::size_t c = 0; c < bounds_.size(); ++c) {
      problem_.channels[c].lower = bounds_[c].lower;
      problem_.channels[c].upper = bounds_[c].upper;
    }
  }
  void hold(std::size_t channel, std::size_t coefficient) {
    const auto j = static_cast<Eigen::Index>(coefficient);
    problem_.channels[channel].lower[j] = problem_.channels[channel].upper[j] = 0.0;
  }

 private:
  struct Bounds {
    SmallVector lower, upper;
  };
  Problem& problem_;
  std::vector<Bounds> bounds_;
};

/// The minimum without lobes, from the one with them.
[[nodiscard]] Polished without_lobes(Problem& problem, Model& model, const Polished& with);

}  // namespace goniofit
