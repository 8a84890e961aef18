#include "fit/material_point.h"

#include <algorithm>
#include <cmath>

namespace goniofit {

FitPoint point_of(const Problem& problem, const Material& material) {
  FitPoint point;
  Surface surface = material.surface;
  for (int z = 0; z < problem.shape.free; ++z) {
    const auto i = static_cast<std::size_t>(z);
    const ShapeParameter& p = problem.basis->shape_parameters()[static_cast<std::size_t>(problem.shape.row[i])];
    const double value = material.model == surface_model
                             ? surface.find(p.name)->value_or(1.0)
                             : material.parameters.at(p.name).value_or(std::clamp(1.0, p.lower, p.upper));
    point.z.push_back(std::clamp(std::log(value - p.origin), problem.shape.lower[i], problem.shape.upper[i]));
  }
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    const ProblemChannel& channel = problem.channels[c];
    SmallVector k(channel.lower.size());
    for (Eigen::Index j = 0; j < k.size(); ++j) {
      const std::string& name = problem.basis->coefficients()[static_cast<std::size_t>(j)].name;
      k[j] = std::clamp(material.channels[c].coefficient(name).value_or(0.0), channel.lower[j], channel.upper[j]);
    }
    point.coefficients.push_back(k);
    if (problem.free_optics == FreeOptics::f0) point.optics.push_back(material.channels[c].normal_reflectance());
    if (problem.free_optics == FreeOptics::n) point.optics.push_back(material.channels[c].n.value_or(1.5));
  }
  return point;
}

}  // namespace goniofit
