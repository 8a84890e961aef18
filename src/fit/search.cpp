#include "fit/search.h"

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>

#include "fit/profile.h"

namespace goniofit {

namespace {

// Steps of the logarithm. A lobe's width enters as a Gaussian of 1/slope: its dip in the profile is as wide as that,
// some tenths, however narrow the lobe. Beyond a slope of a half the lobe fills the hemisphere and changes little.
// sigma enters coh through exp(-g), g ~ sigma², which is smoother.
constexpr double slope_step = 0.17;
constexpr double sigma_step = 0.25;
const double rough = std::log(0.5);
constexpr double rough_step = 0.34;

std::vector<double> grid(double lower, double upper, double step) {
  const int intervals = std::max(1, static_cast<int>(std::ceil((upper - lower) / step)));
  std::vector<double> points;
  for (int i = 0; i <= intervals; ++i) points.push_back(lower + (upper - lower) * i / intervals);
  return points;
}

std::vector<double> slope_grid(double lower, double upper) {
  if (lower >= rough || upper <= rough) return grid(lower, upper, lower >= rough ? rough_step : slope_step);
  std::vector<double> points = grid(lower, rough, slope_step);
  const std::vector<double> beyond = grid(rough, upper, rough_step);
  points.insert(points.end(), beyond.begin() + 1, beyond.end());
  return points;
}

struct Cell {
  std::vector<double> z;
  double loss;
};

// Grid points no worse than their neighbours, best first.
std::vector<Cell> local_minima(const std::vector<double>& outer, const std::vector<double>& inner,
                               const std::vector<double>& losses) {
  const auto rows = static_cast<std::ptrdiff_t>(outer.size());
  const auto columns = static_cast<std::ptrdiff_t>(std::max<std::size_t>(1, inner.size()));
  const auto at = [&](std::ptrdiff_t i, std::ptrdiff_t j) { return losses[static_cast<std::size_t>(i * columns + j)]; };
  std::vector<Cell> cells;
  for (std::ptrdiff_t i = 0; i < rows; ++i) {
    for (std::ptrdiff_t j = 0; j < columns; ++j) {
      bool lowest = true;
      for (std::ptrdiff_t di = -1; di <= 1; ++di) {
        for (std::ptrdiff_t dj = -1; dj <= 1; ++dj) {
          const bool inside = i + di >= 0 && i + di < rows && j + dj >= 0 && j + dj < columns;
          // Of a plateau, the first point speaks.
          if (inside &&
              (at(i + di, j + dj) < at(i, j) || ((di < 0 || (di == 0 && dj < 0)) && at(i + di, j + dj) == at(i, j)))) {
            lowest = false;
          }
        }
      }
      if (!lowest) continue;
      std::vector<double> z{outer[static_cast<std::size_t>(i)]};
      if (!inner.empty()) z.push_back(inner[static_cast<std::size_t>(j)]);
      cells.push_back({std::move(z), at(i, j)});
    }
  }
  std::stable_sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.loss < b.loss; });
  return cells;
}

double step_at(const ShapeMap& shape, std::size_t axis, double z) {
  if (axis > 0 || !shape.outer_moves_slope) return sigma_step;
  return z < rough ? slope_step : rough_step;
}

// Brent's method along one coordinate, within a step of the grid point on both sides.
void refine_along(Profile& profile, const ShapeMap& shape, std::size_t axis, double step, std::vector<double>& z) {
  const double low = std::max(shape.lower[axis], z[axis] - step);
  const double high = std::min(shape.upper[axis], z[axis] + step);
  std::vector<double> trial = z;
  const auto along = [&](double x) {
    trial[axis] = x;
    return profile.loss(trial.data());
  };
  std::uintmax_t most = 8;  // the polish does the rest
  const auto [x, loss] = boost::math::tools::brent_find_minima(along, low, high, 10, most);
  if (loss < profile.loss(z.data())) z[axis] = x;
}

}  // namespace

SearchOutcome search(const Problem& problem, std::size_t most) {
  Profile profile(problem);
  SearchOutcome outcome;
  const ShapeMap& shape = problem.shape;
  if (shape.free == 0) {
    outcome.minima.push_back(profile.point(nullptr));
    outcome.evaluations = profile.evaluations();
    return outcome;
  }
  const std::vector<double> outer = shape.outer_moves_slope ? slope_grid(shape.lower[0], shape.upper[0])
                                                            : grid(shape.lower[0], shape.upper[0], sigma_step);
  const std::vector<double> inner =
      shape.free > 1 ? grid(shape.lower[1], shape.upper[1], sigma_step) : std::vector<double>{};
  std::vector<double> losses;
  for (const double a : outer) {
    if (inner.empty()) losses.push_back(profile.loss(&a));
    for (const double b : inner) {
      const std::array z{a, b};
      losses.push_back(profile.loss(z.data()));
    }
  }
  std::vector<Cell> cells = local_minima(outer, inner, losses);
  // A dip between grid points may be deeper than the points show: refine more than will be returned.
  cells.resize(std::min(cells.size(), most + 2));
  for (Cell& cell : cells) {
    for (int sweep = 0; sweep < shape.free; ++sweep) {
      for (std::size_t axis = 0; axis < cell.z.size(); ++axis)
        refine_along(profile, shape, axis, step_at(shape, axis, cell.z[axis]), cell.z);
    }
    outcome.minima.push_back(profile.point(cell.z.data()));
  }
  auto& minima = outcome.minima;
  std::stable_sort(minima.begin(), minima.end(), [](const FitPoint& a, const FitPoint& b) { return a.loss < b.loss; });
  const double limit = 1.05 * minima.front().loss + 1e-12 * problem.total;
  std::erase_if(minima, [limit](const FitPoint& p) { return p.loss > limit; });
  minima.resize(std::min(minima.size(), most));
  outcome.evaluations = profile.evaluations();
  return outcome;
}

}  // namespace goniofit
