#pragma once
// What the parts of the scene reader share. Private to it.

#include <string>
#include <string_view>

#include "../io/recipe_parameters.h"
#include "../io/toml_value.h"
#include "scene.h"

namespace goniofit::scene_parts {

/// The member, or Error where it is absent.
[[nodiscard]] TomlValue required(const TomlValue& table, std::string_view key, const std::string& expected);
[[nodiscard]] Vec3 read_vec3(const TomlValue& value);
[[nodiscard]] Vec3 required_vec3(const TomlValue& table, std::string_view key);
void read_vec3(const TomlValue& table, std::string_view key, Vec3& result);
[[nodiscard]] double required_number(const TomlValue& table, std::string_view key, const Range& range);
void read_number(const TomlValue& table, std::string_view key, const Range& range, double& result);
/// One number for all channels, or one each; of at least 0.
[[nodiscard]] Spectrum read_spectrum(const TomlValue& value, std::size_t channels);
/// Beside the scene's file.
[[nodiscard]] std::filesystem::path read_path(const Scene& scene, const TomlValue& value);

/// Reads and adds. They need the scene's source, channels and materials.
void read_object(const TomlValue& table, Scene& scene);
void read_light(const TomlValue& table, Scene& scene);

/// The map in the scene's channels: those of its names (in any case), a spectral image's bands at its wavelengths, or
/// one channel for all. Throws Error (bad_input) for a map that has none of these, or negative values.
[[nodiscard]] EnvironmentMap read_environment_map(const std::filesystem::path& path,
                                                  const std::vector<SceneChannel>& channels);

}  // namespace goniofit::scene_parts
