#include "report/lobe_grid.h"

#include <algorithm>
#include <cmath>

#include "geometry/angles.h"

namespace goniofit {
namespace {

// Between two ends at most `step` apart; about one place by width * sinh(u), u uniform.
std::vector<double> nodes(double first, double last, double step, double about, double width, int closer) {
  std::vector<double> out;
  const auto count = static_cast<int>(std::ceil((last - first) / step));
  for (int i = 0; i <= count; ++i) out.push_back(first + (last - first) * i / count);
  const double end = std::asinh(2.0 * step / width);
  for (int i = -closer; i <= closer; ++i) {
    const double node = about + width * std::sinh(end * i / closer);
    if (node > first && node < last) out.push_back(node);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

LobeGrid lobe_grid(double theta_i_deg, double width_deg, bool whole) {
  constexpr double step_deg = 5.0, horizon_deg = 89.5;
  const double width = std::clamp(width_deg, 0.3, 20.0);
  // Near the normal the same width is a larger part of a turn.
  const double turn = std::min(60.0, width / std::max(0.05, sin_deg(theta_i_deg)));
  LobeGrid grid{nodes(0.0, horizon_deg, step_deg, theta_i_deg, width, 9),
                nodes(0.0, 180.0, 2.0 * step_deg, 180.0, turn, 7)};
  for (std::size_t i = grid.phi_deg.size() - 1; whole && i-- > 0;) grid.phi_deg.push_back(360.0 - grid.phi_deg[i]);
  return grid;
}

}  // namespace goniofit
