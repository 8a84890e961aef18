#pragma once
// What the plots of the page draw: readings, fitted values beside them, curves and lobes. Private to the page.

#include <nlohmann/json_fwd.hpp>

#include "../fit/fit.h"
#include "../scan/scan.h"

namespace goniofit {

/// {"channels", "readings", "curves", "maps", "lobes", "residual"}; arrays of numbers are 32-bit floats in base64 (see
/// digest.h). Of many readings and channels an even part, small enough for a page to hold; "note" says so then.
/// `result.material` has the scan's channels.
[[nodiscard]] nlohmann::ordered_json page_plots(const FitResult& result, const Scan& scan);

}  // namespace goniofit
