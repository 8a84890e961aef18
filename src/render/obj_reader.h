#pragma once
// Triangle meshes as Wavefront OBJ: of its records v, vn and f are read, polygons as fans about their first corner;
// what groups, names or colours is passed over.

#include <filesystem>
#include <istream>
#include <string>

#include "scene.h"

namespace goniofit {

/// Throws Error (bad_input) as "FILE:LINE: ..." for records that are none of OBJ's, numbers that are not finite,
/// indices of nothing, faces of no area, and no face at all.
[[nodiscard]] Mesh read_obj(const std::filesystem::path& path);
[[nodiscard]] Mesh read_obj(std::istream& in, const std::string& source);

/// What a scene does to a mesh: scale, then degrees about x, y and z in this order, then translate.
struct MeshPlacement {
  double scale = 1.0;
  Vec3 rotate_deg{};
  Vec3 translate{};
};
void place(Mesh& mesh, const MeshPlacement& placement);

/// Whether each edge belongs to exactly two triangles: the mesh has an inside.
[[nodiscard]] bool is_closed(const Mesh& mesh);

}  // namespace goniofit
