#include "scan/clipping.h"

#include <algorithm>

namespace goniofit {

Clipping clipping_of(std::span<const double> values) noexcept {
  Clipping out;
  if (values.empty()) return out;
  out.maximum = std::max(0.0, *std::max_element(values.begin(), values.end()));
  const auto zero = static_cast<std::size_t>(std::count(values.begin(), values.end(), 0.0));
  const auto at_maximum = static_cast<std::size_t>(std::count(values.begin(), values.end(), out.maximum));
  out.all_zero = zero == values.size();
  const std::size_t chance = std::max<std::size_t>(4, values.size() / 100);
  if (!out.all_zero && zero > chance) out.at_zero = zero;
  if (out.maximum > 0.0 && at_maximum > chance && at_maximum <= values.size() / 2) out.at_maximum = at_maximum;
  return out;
}

}  // namespace goniofit
