#pragma once
// The noise of a scan from the residuals of a fit: variance = additive² + (relative f)².

#include <Eigen/Core>
#include <vector>

#include "settings.h"

namespace goniofit {

/// `f` and `residual` of the same length, 1/sr. Robust: medians of the residuals' size over classes of equal numbers of
/// readings, sorted by f, and through these the line of the variance over f², each class with the same relative
/// error. Neither part is ever less than 1e-6 of f (of its root mean square): what a fit of noise-free values leaves is
/// round-off. Zeros of no readings.
[[nodiscard]] Noise estimate_noise(const Eigen::Ref<const Eigen::VectorXd>& f,
                                   const Eigen::Ref<const Eigen::VectorXd>& residual);

/// Standard deviation of normal deviates about 0, from the median of their size: outliers do not count.
[[nodiscard]] double robust_spread(const Eigen::VectorXd& deviates);

}  // namespace goniofit
