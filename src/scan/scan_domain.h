#pragma once
// The domain that a scan covers.

#include "../geometry/domain.h"
#include "scan.h"

namespace goniofit {

/// From its least to its largest incidence angle below 90°, up to its largest theta_r; the wavelengths of its channels
/// (none unless every channel has one) and its solid angle. Throws Error (bad_input) for a scan without readings below
/// 90°.
[[nodiscard]] Domain domain_of(const Scan& scan);

}  // namespace goniofit
