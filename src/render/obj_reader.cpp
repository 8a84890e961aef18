#include "render/obj_reader.h"

#include <charconv>
#include <limits>
#include <string_view>
#include <unordered_map>

#include "geometry/angles.h"
#include "io/line_reader.h"
#include "io/number.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace {

constexpr std::size_t most_elements = std::size_t{1} << 26U;

// The words of one line, between blanks.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::string_view blanks = " \t";
  for (std::size_t begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(blanks, end);
  }
  return words;
}

// Twice the area, over the square of the longest side, below which three corners are one line: rounding of coordinates
// would decide where such a face looks.
bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr double least = 1e-10;
  const double longest2 = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
  return !(length(cross(b - a, c - a)) > least * longest2);
}

class ObjReader {
 public:
  ObjReader(std::istream& in, const std::string& source) : lines_(in, source) {}

  Mesh read() {
    std::string_view line;
    while (lines_.next(line)) {
      const std::vector<std::string_view> words = words_of(line.substr(0, line.find('#')));
      if (!words.empty()) record(words);
    }
    if (mesh_.triangles.empty()) throw input_error(lines_.source(), 0, "", "has no faces, expected at least one");
    return std::move(mesh_);
  }

 private:
  struct Corner {
    std::uint32_t vertex;
    std::optional<std::uint32_t> normal;
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw input_error(lines_.source(), lines_.number(), "", what);
  }

  void record(const std::vector<std::string_view>& words) {
    const std::string_view kind = words.front();
    if (kind == "v") {
      // Beyond the third number stand a weight or a colour.
      mesh_.vertices.push_back(vector(words, 8));
    } else if (kind == "vn") {
      const Vec3 normal = vector(words, 4);
      if (!(length(normal) > 0.0)) fail("the normal is zero, expected a direction");
      mesh_.normals.push_back(normalised(normal));
    } else if (kind == "f") {
      face(words);
    } else if (!passed_over(kind)) {
      fail(in_quotes(kind) + " is no record of an OBJ file, expected v, vn or f");
    }
    if (std::max({mesh_.vertices.size(), mesh_.normals.size(), mesh_.triangles.size()}) > most_elements) {
      fail("more than " + std::to_string(most_elements) + " vertices or triangles, expected fewer");
    }
  }

  static bool passed_over(std::string_view kind) {
    constexpr std::array<std::string_view, 11> others{"vt",     "vp", "g", "o",      "s", "usemtl",
                                                      "mtllib", "l",  "p", "usemap", "mg"};
    return std::find(others.begin(), others.end(), kind) != others.end();
  }

  Vec3 vector(const std::vector<std::string_view>& words, std::size_t most_words) const {
    if (words.size() < 4 || words.size() > most_words) {
      fail(in_quotes(words.front()) + " has " + std::to_string(words.size() - 1) + " numbers, expected three");
    }
    std::array<double, 3> numbers{};
    for (std::size_t i = 0; i < 3; ++i) {
      const ParsedNumber parsed = parse_number(words[i + 1]);
      if (parsed.fault != NumberFault::none) fail(describe(parsed.fault, words[i + 1], "a number"));
      if (std::fabs(parsed.value) > 1e15) fail(in_quotes(words[i + 1]) + " is too large; expected at most 1e15");
      numbers[i] = parsed.value;
    }
    return {numbers[0], numbers[1], numbers[2]};
  }

  // From 1, or backwards from the last one read, -1.
  std::uint32_t index(std::string_view text, std::size_t count, const char* of_what) const {
    long long value = 0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc() || end != text.data() + text.size()) {
      fail(in_quotes(text) + " is not an index, expected a whole number");
    }
    const auto size = static_cast<long long>(count);
    if (value == 0 || value > size || value < -size) {
      fail("there is no " + std::string(of_what) + " " + std::to_string(value) + ", expected 1 to " +
           std::to_string(count));
    }
    return static_cast<std::uint32_t>(value > 0 ? value - 1 : size + value);
  }

  // "7", "7/2", "7//3" or "7/2/3": vertex, texture, normal.
  Corner corner(std::string_view text) const {
    const std::size_t first = text.find('/');
    Corner result{index(text.substr(0, first), mesh_.vertices.size(), "vertex"), std::nullopt};
    if (first == std::string_view::npos) return result;
    const std::size_t second = text.find('/', first + 1);
    if (second != std::string_view::npos) {
      result.normal = index(text.substr(second + 1), mesh_.normals.size(), "normal");
    }
    return result;
  }

  void face(const std::vector<std::string_view>& words) {
    if (words.size() < 4)
      fail("the face has " + std::to_string(words.size() - 1) + " corners, expected at least three");
    const Corner first = corner(words[1]);
    Corner previous = corner(words[2]);
    for (std::size_t i = 3; i < words.size(); ++i) {
      const Corner next = corner(words[i]);
      add(first, previous, next);
      previous = next;
    }
  }

  void add(const Corner& a, const Corner& b, const Corner& c) {
    if (is_degenerate(mesh_.vertices[a.vertex], mesh_.vertices[b.vertex], mesh_.vertices[c.vertex])) {
      fail("the face is degenerate: its corners lie on one line, expected a triangle with an area");
    }
    MeshTriangle triangle{{a.vertex, b.vertex, c.vertex}, std::nullopt};
    if (a.normal && b.normal && c.normal) triangle.normal = {*a.normal, *b.normal, *c.normal};
    mesh_.triangles.push_back(triangle);
  }

  LineReader lines_;
  Mesh mesh_;
};

Vec3 rotated(const Vec3& v, const Vec3& degrees) {
  const double cx = std::cos(radians(degrees.x)), sx = std::sin(radians(degrees.x));
  const double cy = std::cos(radians(degrees.y)), sy = std::sin(radians(degrees.y));
  const double cz = std::cos(radians(degrees.z)), sz = std::sin(radians(degrees.z));
  const Vec3 a{v.x, cx * v.y - sx * v.z, sx * v.y + cx * v.z};
  const Vec3 b{cy * a.x + sy * a.z, a.y, cy * a.z - sy * a.x};
  return {cz * b.x - sz * b.y, sz * b.x + cz * b.y, b.z};
}

}  // namespace

Mesh read_obj(std::istream& in, const std::string& source) { return ObjReader(in, source).read(); }

Mesh read_obj(const std::filesystem::path& path) {
  std::ifstream in = open_input(path);
  Mesh mesh = read_obj(in, path.string());
  mesh.file = path;
  return mesh;
}

void place(Mesh& mesh, const MeshPlacement& placement) {
  for (Vec3& v : mesh.vertices) v = rotated(placement.scale * v, placement.rotate_deg) + placement.translate;
  for (Vec3& n : mesh.normals) n = rotated(n, placement.rotate_deg);
}

bool is_closed(const Mesh& mesh) {
  std::unordered_map<std::uint64_t, int> faces_at;  // by edge, its lower vertex first
  for (const MeshTriangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(t.vertex[i], t.vertex[(i + 1) % 3]);
      ++faces_at[(std::uint64_t{low} << 32U) | high];
    }
  }
  for (const auto& [edge, faces] : faces_at) {
    if (faces != 2) return false;
  }
  return true;
}

}  // namespace goniofit
