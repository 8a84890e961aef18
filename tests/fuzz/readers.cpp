#include "fuzz/readers.h"

#include <sys/mman.h>
#include <unistd.h>

#include <sstream>
#include <stdexcept>
#include <string>

#include "io/exr_table.h"
#include "io/material_io.h"
#include "io/optical_constants.h"
#include "io/recipe_io.h"
#include "io/reflectance_reader.h"
#include "io/scan_reader.h"
#include "render/exr_image.h"
#include "render/obj_reader.h"
#include "render/scene_reader.h"
#include "support/error.h"

namespace goniofit::fuzz {

namespace {

template <class Read>
void accept_errors(Read&& read) {
  try {
    read();
  } catch (const Error&) {
  }
}

void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

// A file in memory for readers that want a path.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view bytes) : fd_(::memfd_create("bytes", MFD_CLOEXEC)) {
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t n = ::write(fd_, bytes.data() + done, bytes.size() - done);
      require(n > 0, "no memory file");
      done += static_cast<std::size_t>(n);
    }
  }
  ~MemoryFile() { ::close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

std::string written(const Scan& scan) {
  std::ostringstream out;
  write_scan(out, scan, 17);
  return out.str();
}

}  // namespace

void scan(std::string_view bytes) {
  accept_errors([&] {
    // The first byte is the option too: both ways of dealing with unknown columns.
    const bool ignore = !bytes.empty() && bytes.front() == '#';
    std::istringstream in{std::string(bytes)};
    const Scan first = read_scan(in, "fuzz.csv", {.ignore_unknown_columns = ignore});
    require(first.size() > 0 && !first.channels.empty(), "a scan without content");
    const std::string text = written(first);
    std::istringstream again(text);
    require(written(read_scan(again, "fuzz.csv")) == text, "what was written is read back differently");
  });
}

void directions(std::string_view bytes) {
  accept_errors([&] {
    std::istringstream in{std::string(bytes)};
    const DirectionTable table = read_directions(in, "fuzz.csv");
    require(!table.lines.empty() && table.lines.size() == table.angles.size(), "lines and angles do not match");
  });
}

void reflectances(std::string_view bytes) {
  accept_errors([bytes] {
    std::istringstream in{std::string(bytes)};
    const ReflectanceReadings readings = read_reflectances(in, "fuzz.csv");
    require(readings.size() > 0 && !readings.channels.empty(), "nothing was read");
    for (const ReflectanceChannel& c : readings.channels) {
      require(c.values.size() == readings.size(), "a channel is short");
      require(c.u.empty() || c.u.size() == readings.size(), "uncertainties are missing");
    }
  });
}

void optical_constants(std::string_view bytes) {
  accept_errors([&] {
    std::istringstream in{std::string(bytes)};
    const OpticalConstants table = read_optical_constants(in, "fuzz.yml");
    const auto [n, kappa] = table.at(0.5 * (table.wavelength_um.front() + table.wavelength_um.back()));
    require(n > 0.0 && kappa >= 0.0, "optical constants out of range");
  });
}

void material(std::string_view bytes) {
  accept_errors([&] {
    const std::string text = to_json(parse_material(bytes, "fuzz.json"));
    require(to_json(parse_material(text, "fuzz.json")) == text, "what was written is read back differently");
  });
}

void recipe(std::string_view bytes) {
  accept_errors([&] { (void)parse_recipe(bytes, "fuzz.toml"); });
}

void exr_table(std::string_view bytes) {
  accept_errors([&] {
    const MemoryFile file(bytes);
    const BrdfTable table = read_exr(file.path());
    if (!table.channels.empty()) (void)table.value({30.0, 0.0, 40.0, 170.0}, 0);
  });
}

void scene(std::string_view bytes) {
  accept_errors([&] {
    const Scene scene = parse_scene(bytes, "fuzz.toml");
    require(!scene.objects.empty() && !scene.lights.empty(), "a scene without content");
    for (const Object& o : scene.objects) require(o.material < scene.materials.size(), "a material that is not there");
  });
}

void mesh(std::string_view bytes) {
  accept_errors([&] {
    std::istringstream in{std::string(bytes)};
    const Mesh mesh = read_obj(in, "fuzz.obj");
    require(!mesh.triangles.empty(), "a mesh without triangles");
    for (const MeshTriangle& t : mesh.triangles) {
      for (const std::uint32_t v : t.vertex) require(v < mesh.vertices.size(), "a vertex that is not there");
      if (!t.normal) continue;
      for (const std::uint32_t n : *t.normal) require(n < mesh.normals.size(), "a normal that is not there");
    }
    (void)is_closed(mesh);
  });
}

void exr_image(std::string_view bytes) {
  accept_errors([&] {
    const MemoryFile file(bytes);
    const ExrImage image = read_exr_image(file.path());
    require(!image.channels.empty() && image.values.size() == image.channels.size(), "channels without values");
    for (const auto& values : image.values) require(values.size() == image.width * image.height, "too few values");
  });
}

}  // namespace goniofit::fuzz
