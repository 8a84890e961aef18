#include "geometry/solid_angles.h"

#include <algorithm>
#include <array>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <utility>

namespace goniofit {

namespace {

namespace bg = boost::geometry;
namespace bgi = boost::geometry::index;
using Point = bg::model::point<double, 3, bg::cs::cartesian>;
using Tree = bgi::rtree<std::pair<Point, std::size_t>, bgi::quadratic<16>>;

Point point_of(const Direction& v) { return {v.x, v.y, v.z}; }

double triple(const Direction& a, const Direction& b, const Direction& c) noexcept {
  return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
}

using Polygon = std::vector<Direction>;  // corners; sides are great circles of less than half a turn

Direction between(const Direction& p, const Direction& q, double t) {
  const Direction v{p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)};
  const double length = std::hypot(v.x, v.y, v.z);
  return {v.x / length, v.y / length, v.z / length};
}

// What of a convex polygon is on the side of a great circle that `pole` is on.
Polygon part_beside(const Polygon& polygon, const Direction& pole) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Direction& p = polygon[i];
    const Direction& q = polygon[(i + 1) % polygon.size()];
    const double at_p = dot(pole, p);
    const double at_q = dot(pole, q);
    if (at_p >= 0.0) kept.push_back(p);
    if ((at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0)) kept.push_back(between(p, q, at_p / (at_p - at_q)));
  }
  return kept;
}

// By the triangles at its first corner; tan(half the area of one) after van Oosterom & Strackee 1983.
double area(const Polygon& polygon) {
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Direction& a = polygon.front();
    const Direction& b = polygon[i];
    const Direction& c = polygon[i + 1];
    sum += 2.0 * std::atan2(std::fabs(triple(a, b, c)), 1.0 + dot(a, b) + dot(b, c) + dot(c, a));
  }
  return sum;
}

// What is nearest to one direction: in four parts, a quarter of the hemisphere each, whose sides have two ends that
// are no antipodes.
class Cell {
 public:
  explicit Cell(const Direction& centre) : centre_(centre) {
    constexpr Direction up{0.0, 0.0, 1.0}, east{1.0, 0.0, 0.0}, north{0.0, 1.0, 0.0}, west{-1.0, 0.0, 0.0},
        south{0.0, -1.0, 0.0};
    parts_ = {{{up, east, north}, {up, north, west}, {up, west, south}, {up, south, east}}};
  }

  /// Keeps what is nearer to the cell's direction than to `other`.
  void cut_off(const Direction& other) {
    for (Polygon& part : parts_) {
      part = part_beside(part, {centre_.x - other.x, centre_.y - other.y, centre_.z - other.z});
    }
  }
  /// Angle from the direction to the farthest corner.
  [[nodiscard]] double reach() const {
    double least = 1.0;
    for (const Polygon& part : parts_) {
      for (const Direction& p : part) least = std::min(least, dot(centre_, p));
    }
    return std::acos(std::max(-1.0, least));
  }
  [[nodiscard]] double solid_angle() const {
    double sum = 0.0;
    for (const Polygon& part : parts_) sum += area(part);
    return sum;
  }

 private:
  Direction centre_;
  std::array<Polygon, 4> parts_;
};

double cell_size(const Tree& tree, const std::vector<Direction>& directions, const Direction& own) {
  Cell cell(own);
  double reach = cell.reach();
  for (auto it = tree.qbegin(bgi::nearest(point_of(own), static_cast<unsigned>(tree.size()))); it != tree.qend();
       ++it) {
    const Direction& other = directions[it->second];
    const double chord = std::hypot(own.x - other.x, own.y - other.y, own.z - other.z);
    if (chord == 0.0) continue;
    if (2.0 * std::asin(std::min(1.0, 0.5 * chord)) > 2.0 * reach)
      break;  // its bisector passes the cell by, and the rest's
    cell.cut_off(other);
    reach = cell.reach();
  }
  return cell.solid_angle();
}

}  // namespace

std::vector<double> solid_angles(const std::vector<Direction>& directions) {
  std::map<std::array<double, 3>, std::vector<std::size_t>> at;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    at[{directions[i].x, directions[i].y, directions[i].z}].push_back(i);
  }
  std::vector<Tree::value_type> entries;
  for (const auto& [xyz, same] : at) entries.emplace_back(point_of(directions[same.front()]), same.front());
  const Tree tree(entries);
  std::vector<double> out(directions.size());
  for (const auto& [xyz, same] : at) {
    const double own = cell_size(tree, directions, directions[same.front()]);
    for (const std::size_t i : same) out[i] = own / static_cast<double>(same.size());
  }
  return out;
}

std::vector<double> arc_lengths(const std::vector<double>& angles) {
  std::map<double, std::vector<std::size_t>> at;
  for (std::size_t i = 0; i < angles.size(); ++i) at[angles[i]].push_back(i);
  std::vector<double> out(angles.size(), 1.0);
  if (at.size() < 2) {
    for (double& value : out) value /= static_cast<double>(angles.size());
    return out;
  }
  for (auto it = at.begin(); it != at.end(); ++it) {
    const bool first = it == at.begin();
    const bool last = std::next(it) == at.end();
    const double below = first ? std::next(it)->first - it->first : it->first - std::prev(it)->first;
    const double above = last ? below : std::next(it)->first - it->first;
    for (const std::size_t i : it->second) out[i] = 0.5 * (below + above) / static_cast<double>(it->second.size());
  }
  return out;
}

}  // namespace goniofit
