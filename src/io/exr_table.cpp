#include "io/exr_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "brdf/azimuths.h"
#include "brdf/evaluator.h"
#include "geometry/angles.h"
#include "geometry/samplings.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace {

constexpr double last_incidence_deg = 85.0;
constexpr double measured_to_deg = 80.0;

// Two neighbours on an axis and the way from the first to the second.
struct Span {
  std::size_t first, second;
  double t;
};

// `coordinate` in [0, 1] across `size` cells.
Span cells_around(double coordinate, std::size_t size) {
  const auto last = static_cast<double>(size - 1);
  const double x = std::clamp(coordinate * static_cast<double>(size) - 0.5, 0.0, last);
  const auto first = static_cast<std::size_t>(std::min(std::floor(x), last - 1.0));
  return {first, first + 1, x - static_cast<double>(first)};
}

Span incidences_around(const std::vector<double>& theta_i_deg, double theta) {
  if (theta <= theta_i_deg.front()) return {0, 0, 0.0};
  if (theta >= theta_i_deg.back()) return {theta_i_deg.size() - 1, theta_i_deg.size() - 1, 0.0};
  const auto above = std::upper_bound(theta_i_deg.begin(), theta_i_deg.end(), theta);
  const auto second = static_cast<std::size_t>(above - theta_i_deg.begin());
  const double below = theta_i_deg[second - 1];
  return {second - 1, second, (theta - below) / (theta_i_deg[second] - below)};
}

double bilinear(const std::vector<float>& image, std::size_t size, const Span& column, const Span& row) {
  const auto at = [&](std::size_t r, std::size_t c) { return static_cast<double>(image[r * size + c]); };
  const double low = std::lerp(at(row.first, column.first), at(row.first, column.second), column.t);
  const double high = std::lerp(at(row.second, column.first), at(row.second, column.second), column.t);
  return std::lerp(low, high, row.t);
}

std::vector<double> incidence_angles(double step_deg) {
  if (!(step_deg >= 0.1 && step_deg <= last_incidence_deg)) {
    throw usage_error("incidence step of " + shortest(step_deg) + " degrees, expected 0.1 to 85");
  }
  std::vector<double> angles;
  // A step of 0.1 shall not lose 85 to rounding.
  for (int k = 0; k * step_deg <= last_incidence_deg * (1.0 + 1e-12); ++k) angles.push_back(k * step_deg);
  return angles;
}

Material without_coherent(Material material) {
  material.components.erase(Effect::coh);
  if (material.model == surface_model && material.components.empty()) {
    throw usage_error("a material of coh alone has nothing to tabulate: its cone is narrower than a cell");
  }
  return material;
}

float as_float(double value) {
  return static_cast<float>(std::min(value, static_cast<double>(std::numeric_limits<float>::max())));
}

// One image a channel.
std::vector<std::vector<float>> evaluate_hemisphere(const Evaluator& evaluator, double theta_i_deg,
                                                    const std::vector<HemispherePoint>& cells) {
  std::vector<std::vector<float>> images(evaluator.channels(), std::vector<float>(cells.size()));
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    const Pair pair = make_pair({theta_i_deg, 0.0, cells[cell].theta_deg, cells[cell].phi_deg});
    for (std::size_t c = 0; c < images.size(); ++c) images[c][cell] = as_float(evaluator.value(pair, c));
  }
  return images;
}

// In [0, 1): the standard's own distributions differ between libraries.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

AnglePair random_pair(std::mt19937_64& random) {
  const double theta_i = measured_to_deg * uniform(random);
  const double cos_r = std::lerp(cos_deg(measured_to_deg), 1.0, uniform(random));
  return {theta_i, 360.0 * uniform(random), degrees(std::acos(cos_r)), 360.0 * uniform(random)};
}

// largest[incidence][channel] over the directions that the errors are measured at.
std::vector<std::vector<double>> largest_values(const BrdfTable& table, const std::vector<HemispherePoint>& cells) {
  std::vector<std::vector<double>> largest;
  for (const auto& images : table.values) {
    std::vector<double>& by_channel = largest.emplace_back();
    for (const std::vector<float>& image : images) {
      double most = 0.0;
      for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        if (cells[cell].theta_deg <= measured_to_deg) most = std::max(most, static_cast<double>(image[cell]));
      }
      by_channel.push_back(most);
    }
  }
  return largest;
}

void measure_interpolation(BrdfTable& table, const Evaluator& evaluator, const std::vector<HemispherePoint>& cells) {
  constexpr int directions = 20000;
  constexpr double faint = 1e-3;  // 1/sr; relative errors of less say nothing
  const std::vector<std::vector<double>> largest = largest_values(table, cells);
  std::mt19937_64 random(20240229);
  double squares = 0.0;
  for (int i = 0; i < directions; ++i) {
    const AnglePair angles = random_pair(random);
    const Pair pair = make_pair(angles);
    const Span incidence = incidences_around(table.theta_i_deg, angles.theta_i_deg);
    for (std::size_t c = 0; c < table.channels.size(); ++c) {
      const double exact = evaluator.value(pair, c);
      const double difference = std::fabs(table.value(angles, c) - exact);
      const double relative = difference / std::max(exact, faint);
      squares += relative * relative;
      const double scale = std::max(largest[incidence.first][c], largest[incidence.second][c]);
      if (scale > 0.0) table.interpolation_max = std::max(table.interpolation_max, difference / scale);
    }
  }
  table.interpolation_rms = std::sqrt(squares / static_cast<double>(directions * table.channels.size()));
}

}  // namespace

double BrdfTable::value(const AnglePair& angles, std::size_t channel) const {
  if (!(angles.theta_i_deg < 90.0) || !(angles.theta_r_deg < 90.0)) return 0.0;
  const SquarePoint point = hemisphere_to_square({angles.theta_r_deg, wrap_deg(angles.phi_r_deg - angles.phi_i_deg)});
  const Span column = cells_around(point.u, size);
  const Span row = cells_around(point.v, size);
  const Span incidence = incidences_around(theta_i_deg, angles.theta_i_deg);
  const double first = bilinear(values[incidence.first][channel], size, column, row);
  if (incidence.first == incidence.second) return first;
  return std::lerp(first, bilinear(values[incidence.second][channel], size, column, row), incidence.t);
}

BrdfTable tabulate(const Material& material, const ExrTableOptions& options) {
  if (options.size < 2 || options.size > largest_table_size) {
    throw usage_error("table of " + std::to_string(options.size) + " cells a side, expected 2 to " +
                      std::to_string(largest_table_size));
  }
  const Evaluator evaluator(without_coherent(material));
  if (is_anisotropic(evaluator)) {
    throw usage_error("an anisotropic material cannot be tabulated: the table has one azimuth of incidence");
  }
  BrdfTable table;
  table.name = material.name;
  table.size = options.size;
  table.theta_i_deg = incidence_angles(options.incidence_step_deg);
  for (const MaterialChannel& channel : material.channels) table.channels.push_back(channel.name);
  if (options.size * options.size * table.theta_i_deg.size() * table.channels.size() > most_table_values) {
    throw usage_error("the table would take more than 1 GiB, expected fewer cells or incidence angles");
  }
  const std::vector<HemispherePoint> cells = square_cell_centres(options.size);
  for (const double theta_i : table.theta_i_deg) table.values.push_back(evaluate_hemisphere(evaluator, theta_i, cells));
  measure_interpolation(table, evaluator, cells);
  return table;
}

}  // namespace goniofit
