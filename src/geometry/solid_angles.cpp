#include "geometry/solid_angles.h"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <utility>

#include "geometry/angles.h"

namespace goniofit {

namespace {

namespace bg = boost::geometry;
namespace bgi = boost::geometry::index;
using Point = bg::model::d2::point_xy<double>;
using Entry = std::pair<Point, std::size_t>;

// The hemisphere becomes the disc of radius sqrt 2, of the same area.
Point projected(const Direction& v) noexcept {
  const double scale = std::sqrt(2.0 / (1.0 + v.z));
  return {scale * v.x, scale * v.y};
}

// A polygon of the disc's own area.
std::vector<Point> disc() {
  constexpr int corners = 360;
  const double radius = std::sqrt(2.0 * pi / (0.5 * corners * std::sin(2.0 * pi / corners)));
  std::vector<Point> polygon;
  for (int i = 0; i < corners; ++i) {
    polygon.emplace_back(radius * std::cos(2.0 * pi * i / corners), radius * std::sin(2.0 * pi * i / corners));
  }
  return polygon;
}

// What of the convex polygon is nearer to a than to b.
std::vector<Point> nearer(const std::vector<Point>& polygon, const Point& a, const Point& b) {
  const double nx = b.x() - a.x();
  const double ny = b.y() - a.y();
  const double middle = 0.5 * (nx * (a.x() + b.x()) + ny * (a.y() + b.y()));
  const auto beyond = [&](const Point& p) { return nx * p.x() + ny * p.y() - middle; };
  std::vector<Point> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& p = polygon[i];
    const Point& q = polygon[(i + 1) % polygon.size()];
    const double dp = beyond(p);
    const double dq = beyond(q);
    if (dp <= 0.0) out.push_back(p);
    if ((dp < 0.0) != (dq < 0.0) && dp != dq) {
      const double t = dp / (dp - dq);
      out.emplace_back(p.x() + t * (q.x() - p.x()), p.y() + t * (q.y() - p.y()));
    }
  }
  return out;
}

double area(const std::vector<Point>& polygon) noexcept {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& p = polygon[i];
    const Point& q = polygon[(i + 1) % polygon.size()];
    twice += p.x() * q.y() - q.x() * p.y();
  }
  return 0.5 * std::fabs(twice);
}

double cell_area(const bgi::rtree<Entry, bgi::quadratic<16>>& tree, const Point& at, std::vector<Point> cell) {
  double reach = 4.0;  // of the farthest corner
  for (auto it = tree.qbegin(bgi::nearest(at, static_cast<unsigned>(tree.size()))); it != tree.qend(); ++it) {
    const double distance = bg::distance(at, it->first);
    if (distance == 0.0) continue;
    if (distance > 2.0 * reach) break;  // its bisector passes the cell by, and so do all that follow
    cell = nearer(cell, at, it->first);
    reach = 0.0;
    for (const Point& corner : cell) reach = std::max(reach, bg::distance(at, corner));
  }
  return area(cell);
}

}  // namespace

std::vector<double> solid_angles(const std::vector<Direction>& directions) {
  std::map<std::pair<double, double>, std::vector<std::size_t>> at;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Point p = projected(directions[i]);
    at[{p.x(), p.y()}].push_back(i);
  }
  std::vector<Entry> entries;
  for (const auto& [xy, same] : at) entries.emplace_back(Point(xy.first, xy.second), same.front());
  const bgi::rtree<Entry, bgi::quadratic<16>> tree(entries);
  const std::vector<Point> whole = disc();
  std::vector<double> out(directions.size());
  for (const auto& [xy, same] : at) {
    const double own = cell_area(tree, Point(xy.first, xy.second), whole);
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
