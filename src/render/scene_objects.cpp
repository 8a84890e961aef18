// The [[objects]] of a scene.

#include <algorithm>

#include "render/obj_reader.h"
#include "render/scene_parts.h"
#include "support/text.h"

namespace goniofit::scene_parts {

namespace {

Range sizes() { return {0.0, 1e15, false, true, "a number above 0 and up to 1e15"}; }

Shape read_sphere(const TomlValue& table) {
  table.expect_keys({"type", "material", "tangent", "brushed_deg", "center", "radius"});
  return Sphere{required_vec3(table, "center"), required_number(table, "radius", sizes())};
}

Shape read_plane(const TomlValue& table) {
  table.expect_keys({"type", "material", "tangent", "brushed_deg", "point", "normal", "half_size"});
  Plane plane{required_vec3(table, "point"), required_vec3(table, "normal"), std::nullopt};
  if (const auto size = table.find("half_size")) plane.half_size = goniofit::read_number(*size, sizes());
  return plane;
}

Shape read_cylinder(const TomlValue& table) {
  table.expect_keys({"type", "material", "tangent", "brushed_deg", "base", "top", "radius", "caps"});
  Cylinder cylinder{required_vec3(table, "base"), required_vec3(table, "top"),
                    required_number(table, "radius", sizes()), true};
  if (const auto caps = table.find("caps")) cylinder.caps = caps->boolean();
  return cylinder;
}

Shape read_mesh(const TomlValue& table, const Scene& scene) {
  table.expect_keys({"type", "material", "tangent", "brushed_deg", "file", "scale", "rotate", "translate"});
  Mesh mesh = read_obj(read_path(scene, required(table, "file", "the path of an OBJ file")));
  MeshPlacement placement;
  scene_parts::read_number(table, "scale", sizes(), placement.scale);
  read_vec3(table, "rotate", placement.rotate_deg);
  read_vec3(table, "translate", placement.translate);
  place(mesh, placement);
  return mesh;
}

Shape read_shape(const TomlValue& table, const Scene& scene) {
  const TomlValue type = required(table, "type", "sphere, plane, cylinder or mesh");
  const std::string& name = type.text();
  if (name == "sphere") return read_sphere(table);
  if (name == "plane") return read_plane(table);
  if (name == "cylinder") return read_cylinder(table);
  if (name == "mesh") return read_mesh(table, scene);
  type.fail(in_quotes(name) + " is not known, expected sphere, plane, cylinder or mesh");
}

std::size_t material_of(const TomlValue& table, const Scene& scene) {
  const TomlValue value = required(table, "material", "the name of a material");
  std::vector<std::string> names;
  for (const SceneMaterial& material : scene.materials) names.push_back(material.name);
  const auto found = std::find(names.begin(), names.end(), value.text());
  if (found == names.end()) value.fail(in_quotes(value.text()) + " is no material, expected " + alternatives(names));
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace

void read_object(const TomlValue& table, Scene& scene) {
  if (!table.is_table()) table.fail_type("a table");
  Object object{read_shape(table, scene), material_of(table, scene)};
  read_vec3(table, "tangent", object.tangent);
  scene_parts::read_number(table, "brushed_deg", Range::closed(-360.0, 360.0), object.brushed_deg);
  scene.objects.push_back(std::move(object));
}

}  // namespace goniofit::scene_parts
