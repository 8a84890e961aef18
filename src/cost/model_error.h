#pragma once
// How far a model is off another one.

#include <cstddef>
#include <span>

#include "candidate.h"

namespace goniofit {

/// A relative error divides by no less than this: below it nobody sees f.
inline constexpr double least_f = 1e-3;  // 1/sr

struct ModelError {
  /// Integral of |Δf| cos theta_r over that of f cos theta_r, incidences and channels together; the coherent part adds
  /// by its energy.
  double l1 = 0.0;
  /// The same of the incidence and channel where it is largest; and with three standard errors of its estimate.
  double worst_l1 = 0.0, worst_l1_bound = 0.0;
  double worst_theta_i_deg = 0.0;
  /// |Δf| / max(f, least_f), over the directions drawn and the mirror directions, coh with its height there.
  double rms_relative = 0.0, max_relative = 0.0;
};

/// Both of the same channels at `samples`; those listed count (all: empty). A reference that reflects nothing at some
/// incidence has an error of 0 there if the other does neither, else of 1.
[[nodiscard]] ModelError model_error(const ErrorSamples& samples, const ModelValues& reference,
                                     const ModelValues& candidate, std::span<const std::size_t> channels = {});

}  // namespace goniofit
