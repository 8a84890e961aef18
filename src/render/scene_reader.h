#pragma once
// Scenes as TOML. Every path is relative to the scene's file.
//
//   [camera]
//   position = [0, -6, 2]             # needed
//   look_at = [0, 0, 1]               # needed
//   up = [0, 0, 1]
//   fov_deg = 40                      # of the image's height
//
//   [image]                           # all optional
//   width = 512
//   height = 512
//   samples = 16                      # a pixel
//   max_bounces = 3                   # 1: direct light alone
//   indirect = 1                      # part of the samples that follow diffuse light to other surfaces, above 0 to 1
//   path_limit = 10                   # largest radiance that one path brings from another surface (none): no sparks,
//                                     #   at the price of caustics
//   seed = 1
//   exposure = "auto"                 # or stops: the PNG shows 2^stops times the radiance
//
//   [plan]                            # optional
//   tolerance = 0.01                  # of the image
//
//   [materials.paint]
//   file = "../fits/garnet_red_paint_13.json"
//   [materials.floor]
//   reflectance = 0.5                 # Lambert's law; one number, or one a channel
//
//   [[objects]]                       # at least one
//   type = "sphere"                   # center, radius
//                                     # "plane": point, normal, half_size (a square; else infinite)
//                                     # "cylinder": base, top, radius, caps = true
//                                     # "mesh": file (OBJ), scale = 1, rotate = [x, y, z] (degrees about the axes, in
//                                     #   this order), translate
//   material = "paint"
//   tangent = [1, 0, 0]               # of anisotropic materials: where their azimuth is 0
//   brushed_deg = 0                   # turned about the normal
//
//   [[lights]]                        # at least one that shines
//   type = "point"                    # position, intensity (W/sr), radius = 0
//                                     # "directional": direction (of travel), irradiance (W/m²), diameter_deg = 0
//                                     # "area": radiance (W/(m² sr)), shape = "rectangle" (center, u, v: half its
//                                     sides, #   shining towards u x v), "disc" (center, normal, radius) or "sphere"
//                                     (center, #   radius) # "environment": radiance, or file = "sky.exr" (latitude,
//                                     longitude), scale = 1, #   rotation_deg = 0
//
// Spectra (intensity, irradiance, radiance, reflectance, scale) are one number, or one a channel of the materials,
// which all have the same channels; R, G, B where the scene has no material from a file.

#include <filesystem>
#include <string>
#include <string_view>

#include "scene.h"

namespace goniofit {

/// Reads and validates, materials, meshes and maps included. Throws Error (bad_input) as "FILE: /objects/0/radius: what
/// is wrong, what was expected"; for what other files hold, as their readers do.
[[nodiscard]] Scene read_scene(const std::filesystem::path& path);
/// `source` is the path that messages name and others are relative to.
[[nodiscard]] Scene parse_scene(std::string_view toml, const std::filesystem::path& source);

}  // namespace goniofit
