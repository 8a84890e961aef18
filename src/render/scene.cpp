#include "render/scene.h"

#include <algorithm>

#include "support/error.h"

namespace goniofit {

namespace {

bool all_zero(const Spectrum& spectrum) {
  return std::all_of(spectrum.begin(), spectrum.end(), [](double v) { return v == 0.0; });
}

const Spectrum& spectrum_of(const Light& light) {
  if (const auto* point = std::get_if<PointLight>(&light)) return point->intensity;
  if (const auto* sun = std::get_if<DirectionalLight>(&light)) return sun->irradiance;
  if (const auto* area = std::get_if<AreaLight>(&light)) return area->radiance;
  return std::get<EnvironmentLight>(light).radiance;
}

}  // namespace

bool mirror_shows(const Light& light) noexcept {
  if (const auto* point = std::get_if<PointLight>(&light)) return point->radius > 0.0;
  if (const auto* sun = std::get_if<DirectionalLight>(&light)) return sun->diameter_deg > 0.0;
  return true;
}

bool is_dark(const Light& light) noexcept {
  if (all_zero(spectrum_of(light))) return true;
  const auto* sky = std::get_if<EnvironmentLight>(&light);
  return sky != nullptr && sky->map && all_zero(sky->map->values);
}

std::vector<RenderMaterial> given_materials(const Scene& scene) {
  std::vector<RenderMaterial> materials;
  for (const SceneMaterial& m : scene.materials) materials.push_back({.material = m.material});
  return materials;
}

}  // namespace goniofit
