#pragma once
// Intervals of an estimate that is normal about the truth, also where the truth has a bound.

#include "../brdf/material.h"

namespace goniofit {

/// The probability of one and of about two standard uncertainties: what "68 %" and "95 %" stand for.
inline constexpr double probability_68 = 0.6826894921370859, probability_95 = 0.95;

/// Half-width of the central interval of that probability in standard uncertainties: Student's t of `freedom` degrees
/// of freedom, the normal distribution's where they are infinite. Not fewer than one is taken.
[[nodiscard]] double coverage_factor(double probability, double freedom);

/// The unified interval of Feldman & Cousins (Phys. Rev. D 57, 3873, 1998): every mean within the bounds that accepts
/// `estimate`, values being accepted in the order of their likelihood over that of the best mean within the bounds. It
/// has its probability for every such mean, those on the bound included; it passes by itself from one-sided to central,
/// and is never empty. `estimate` is the unconstrained one, which may lie beyond a bound; `u` > 0 its standard
/// deviation; bounds may be infinite. The nearer bound orders the values, the other cuts the interval off: exact where
/// they are six u apart.
[[nodiscard]] Interval unified_interval(double estimate, double u, double lower, double upper, double probability);

}  // namespace goniofit
