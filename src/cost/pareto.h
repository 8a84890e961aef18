#pragma once
// Which of many trade-offs are worth having.

#include <span>
#include <vector>

namespace goniofit {

struct CostAndError {
  double cost, error;
};

/// Whether no other point is at most as dear and at most as wrong, and better in one of both. Equal points share their
/// fate. O(n²): tables are short.
[[nodiscard]] std::vector<bool> pareto_front(std::span<const CostAndError> points);

}  // namespace goniofit
