#include "fit/search.h"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "fit/profile.h"

namespace goniofit {

namespace {

std::vector<double> grid(double lower, double upper, double step) {
  const int intervals = std::max(1, static_cast<int>(std::ceil((upper - lower) / step)));
  std::vector<double> points;
  for (int i = 0; i <= intervals; ++i) points.push_back(lower + (upper - lower) * i / intervals);
  return points;
}

// Where an axis is searched: values of z, or of its difference from another axis.
struct Axis {
  std::vector<double> points;
  std::ptrdiff_t relative_to = -1;  ///< among the free axes

  /// How far the neighbours of a point are.
  [[nodiscard]] double reach(std::size_t i) const noexcept {
    const double below = i > 0 ? points[i] - points[i - 1] : 0.0;
    const double above = i + 1 < points.size() ? points[i + 1] - points[i] : 0.0;
    return std::max({below, above, 0.1});
  }
};

// What a search may cost. Models of many shape parameters name probes, so that few come near it.
constexpr std::size_t most_cells = 20000;

class Search {
 public:
  Search(const Problem& problem, RowSelection selection)
      : problem_(problem), thinned_(!selection.all()), profile_(problem, std::move(selection)) {
    double coarser = 1.0;
    do {
      axes_.clear();
      for (std::size_t a = 0; a < static_cast<std::size_t>(problem.shape.free); ++a) axes_.push_back(axis(a, coarser));
      coarser *= 1.25;
    } while (cells() > most_cells);
  }
  [[nodiscard]] SearchOutcome run(std::size_t most);

 private:
  [[nodiscard]] Axis axis(std::size_t a, double coarser) const;
  [[nodiscard]] std::size_t cells() const noexcept;
  [[nodiscard]] bool is_length(std::size_t a) const noexcept {
    const auto parameters = static_cast<int>(problem_.basis->shape_parameters().size());
    return problem_.basis->has_length() && problem_.shape.row[a] == parameters - 1;
  }
  [[nodiscard]] std::vector<double> length_grid(double lower, double upper, double step) const;
  [[nodiscard]] std::vector<double> probes_of(const ShapeParameter& p, double lower, double upper) const;
  [[nodiscard]] std::vector<double> place(const std::vector<std::size_t>& index) const;
  void evaluate_grid();
  [[nodiscard]] bool lowest(std::size_t cell) const;
  [[nodiscard]] std::vector<std::size_t> index_of(std::size_t cell) const;
  void refine_along(std::size_t axis, double reach, std::vector<double>& z);

  const Problem& problem_;
  bool thinned_;
  Profile profile_;
  std::vector<Axis> axes_;
  std::vector<double> losses_;  ///< of the grid, the last axis fastest
};

std::vector<double> Search::probes_of(const ShapeParameter& p, double lower, double upper) const {
  std::vector<double> points;
  for (const double value : p.probes) {
    const double z = std::log(p.relative_to < 0 ? value - p.origin : value);
    if (p.relative_to >= 0 || (z >= lower && z <= upper)) points.push_back(z);
  }
  return points.empty() ? std::vector<double>{0.5 * (lower + upper)} : points;
}

// Where all readings read the length, each point costs as much as a new slope, and what lies far from the wavelengths
// is a limit that the nearest points stand for: no roughness, or geometrical optics. Else it costs next to nothing.
std::vector<double> Search::length_grid(double lower, double upper, double step) const {
  const bool cheap = !std::all_of(problem_.channels.begin(), problem_.channels.end(), [](const ProblemChannel& c) {
    return c.wavelength_um.has_value();
  }) || !problem_.basis->reads_length(problem_.pairs[0]);
  if (cheap) return grid(lower, upper, step);
  double shortest = problem_.wavelength(0);
  double longest = shortest;
  for (std::size_t c = 0; c < problem_.channels.size(); ++c) {
    shortest = std::min(shortest, problem_.wavelength(c));
    longest = std::max(longest, problem_.wavelength(c));
  }
  const double low = std::clamp(std::log(0.005 * shortest), lower, upper);
  const double high = std::clamp(std::log(4.0 * longest), lower, upper);
  return grid(low, high, 1.6 * step);
}

Axis Search::axis(std::size_t a, double coarser) const {
  const ShapeMap& shape = problem_.shape;
  const ShapeParameter& p = problem_.basis->shape_parameters()[static_cast<std::size_t>(shape.row[a])];
  const double step = coarser * p.step;
  const double coarse_beyond = std::log(p.coarse_beyond - p.origin);
  const double lower = shape.lower[a];
  const double upper = shape.upper[a];
  Axis out;
  const auto at = std::find(shape.row.begin(), shape.row.end(), static_cast<int>(p.relative_to));
  if (p.relative_to >= 0 && at != shape.row.end()) out.relative_to = at - shape.row.begin();
  const bool probes_apply = shape.free > 1 && !p.probes.empty() && (p.relative_to < 0 || out.relative_to >= 0);
  if (is_length(a)) {
    out.points = length_grid(lower, upper, step);
  } else if (probes_apply) {
    out.points = probes_of(p, lower, upper);
  } else if (lower >= coarse_beyond || upper <= coarse_beyond) {
    out.points = grid(lower, upper, lower >= coarse_beyond ? 2.0 * step : step);
  } else {
    out.points = grid(lower, coarse_beyond, step);
    const std::vector<double> beyond = grid(coarse_beyond, upper, 2.0 * step);
    out.points.insert(out.points.end(), beyond.begin() + 1, beyond.end());
  }
  return out;
}

std::size_t Search::cells() const noexcept {
  std::size_t product = 1;
  for (const Axis& axis : axes_) product *= axis.points.size();
  return product;
}

std::vector<std::size_t> Search::index_of(std::size_t cell) const {
  std::vector<std::size_t> index(axes_.size());
  for (std::size_t a = axes_.size(); a-- > 0;) {
    index[a] = cell % axes_[a].points.size();
    cell /= axes_[a].points.size();
  }
  return index;
}

std::vector<double> Search::place(const std::vector<std::size_t>& index) const {
  std::vector<double> z;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const Axis& axis = axes_[a];
    const double base = axis.relative_to < 0 ? 0.0 : z[static_cast<std::size_t>(axis.relative_to)];
    z.push_back(std::clamp(base + axis.points[index[a]], problem_.shape.lower[a], problem_.shape.upper[a]));
  }
  return z;
}

void Search::evaluate_grid() {
  losses_.reserve(cells());
  for (std::size_t cell = 0; cell < cells(); ++cell) losses_.push_back(profile_.loss(place(index_of(cell)).data()));
}

// No worse than its neighbours; of a plateau, the first point speaks. With a few axes the diagonals are neighbours too.
// With many they are hundreds, nearly every point has a better one, and coarse grids keep too few dips apart.
bool Search::lowest(std::size_t cell) const {
  const std::vector<std::size_t> index = index_of(cell);
  const bool diagonals = axes_.size() <= 3;
  std::vector<int> step(axes_.size(), -1);
  while (true) {
    std::size_t other = 0;
    bool inside = diagonals || std::count(step.begin(), step.end(), 0) + 1 >= static_cast<std::ptrdiff_t>(step.size());
    for (std::size_t a = 0; a < axes_.size() && inside; ++a) {
      const auto i = static_cast<std::ptrdiff_t>(index[a]) + step[a];
      inside = i >= 0 && i < static_cast<std::ptrdiff_t>(axes_[a].points.size());
      if (inside) other = other * axes_[a].points.size() + static_cast<std::size_t>(i);
    }
    if (inside && (losses_[other] < losses_[cell] || (other < cell && losses_[other] == losses_[cell]))) return false;
    std::size_t a = 0;
    while (a < step.size() && ++step[a] > 1) step[a++] = -1;
    if (a == step.size()) return true;
  }
}

// Brent's method along one coordinate.
void Search::refine_along(std::size_t a, double reach, std::vector<double>& z) {
  const ShapeMap& shape = problem_.shape;
  const double low = std::max(shape.lower[a], z[a] - reach);
  const double high = std::min(shape.upper[a], z[a] + reach);
  std::vector<double> trial = z;
  const auto along = [&](double x) {
    trial[a] = x;
    return profile_.loss(trial.data());
  };
  std::uintmax_t most = 8;  // the polish does the rest
  const auto [x, loss] = boost::math::tools::brent_find_minima(along, low, high, 10, most);
  if (loss < profile_.loss(z.data())) z[a] = x;
}

SearchOutcome Search::run(std::size_t most) {
  SearchOutcome outcome;
  evaluate_grid();
  std::vector<std::size_t> dips;
  for (std::size_t cell = 0; cell < losses_.size(); ++cell) {
    if (lowest(cell)) dips.push_back(cell);
  }
  std::stable_sort(dips.begin(), dips.end(), [this](std::size_t a, std::size_t b) { return losses_[a] < losses_[b]; });
  // A dip between grid points may be deeper than the points show: refine more than will be returned, and the more so
  // the coarser a grid of many axes has to be.
  const bool many = axes_.size() > 2;
  if (axes_.size() > 4) most *= 3;
  dips.resize(std::min(dips.size(), many ? 3 * most : most + 2));
  for (const std::size_t cell : dips) {
    const std::vector<std::size_t> index = index_of(cell);
    std::vector<double> z = place(index);
    for (std::size_t sweep = 0; sweep < std::min<std::size_t>(axes_.size(), 2); ++sweep) {
      for (std::size_t a = 0; a < axes_.size(); ++a) refine_along(a, axes_[a].reach(index[a]), z);
    }
    outcome.minima.push_back(profile_.point(z.data()));
  }
  auto& minima = outcome.minima;
  std::stable_sort(minima.begin(), minima.end(), [](const FitPoint& a, const FitPoint& b) { return a.loss < b.loss; });
  // Estimates of losses that are equal differ by some hundredths.
  const double limit = (many ? 2.0 : thinned_ ? 1.3 : 1.05) * minima.front().loss + 1e-12 * problem_.total;
  std::erase_if(minima, [limit](const FitPoint& p) { return p.loss > limit; });
  minima.resize(std::min(minima.size(), most));
  outcome.evaluations = profile_.evaluations();
  outcome.thinned = thinned_;
  return outcome;
}

SearchOutcome search_rows(const Problem& problem, RowSelection selection, std::size_t most) {
  if (problem.shape.free > 0) return Search(problem, std::move(selection)).run(most);
  const bool thinned = !selection.all();
  Profile profile(problem, std::move(selection));
  SearchOutcome outcome;
  outcome.minima.push_back(profile.point(nullptr));
  outcome.evaluations = profile.evaluations();
  outcome.thinned = thinned;
  return outcome;
}

std::vector<std::size_t> first_numbers(std::size_t count) {
  std::vector<std::size_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  return numbers;
}

}  // namespace

SearchOutcome search(const Problem& problem, std::size_t most, bool all_readings) {
  if (!problem.by_parts()) {
    const bool all = all_readings || problem.shape.free == 0;
    return search_rows(problem, all ? RowSelection{} : searched_rows(problem), most);
  }
  // All readings in one piece: it is seldom that some of them do not tell, and then the answer is worth the memory.
  if (all_readings) return search_rows(problem.part(first_numbers(problem.readings())), {}, most);
  const RowSelection& drawn = problem.drawn;
  return search_rows(problem.part(drawn.rows), {first_numbers(drawn.rows.size()), drawn.factor}, most);
}

}  // namespace goniofit
