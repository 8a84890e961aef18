#include "cost/pareto.h"

#include <algorithm>

namespace goniofit {

std::vector<bool> pareto_front(std::span<const CostAndError> points) {
  const auto beats = [](const CostAndError& a, const CostAndError& b) {
    return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
  };
  std::vector<bool> front;
  front.reserve(points.size());
  for (const CostAndError& point : points) {
    front.push_back(std::none_of(points.begin(), points.end(), [&](const CostAndError& p) { return beats(p, point); }));
  }
  return front;
}

}  // namespace goniofit
