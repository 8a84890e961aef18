#include "render/light_sampler.h"

#include <algorithm>
#include <cmath>

#include "brdf/sampling_lobes.h"
#include "geometry/angles.h"

namespace goniofit {

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

struct AreaPoint {
  Vec3 position, normal;
  double area;
};

AreaPoint point_on(const Rectangle& r, const std::array<double, 2>& u) noexcept {
  const Vec3 across = cross(r.u, r.v);
  const double quarter = length(across);
  return {r.center + (2.0 * u[0] - 1.0) * r.u + (2.0 * u[1] - 1.0) * r.v, (1.0 / quarter) * across, 4.0 * quarter};
}

AreaPoint point_on(const Disc& d, const std::array<double, 2>& u) noexcept {
  const Frame frame = Frame::about(normalised(d.normal), {1.0, 0.0, 0.0});
  const double r = d.radius * std::sqrt(u[0]), phi = 2.0 * pi * u[1];
  return {d.center + frame.to_world(r * std::cos(phi), r * std::sin(phi), 0.0), frame.z, pi * d.radius * d.radius};
}

// Solid angle of the cone in which a sphere at `distance` is seen, without the cancellation of 1 - cos.
double sphere_solid_angle(const Sphere& s, double distance) noexcept {
  const double sin2 = s.radius * s.radius / (distance * distance);
  return 2.0 * pi * sin2 / (1.0 + std::sqrt(1.0 - sin2));
}

std::optional<LightSample> sample_sphere(const Sphere& s, const double* spectrum, const Vec3& point,
                                         const std::array<double, 2>& u) noexcept {
  const Vec3 to = s.center - point;
  const double distance = length(to);
  if (!(distance > s.radius)) return std::nullopt;
  const double solid_angle = sphere_solid_angle(s, distance);
  const double one_minus_cos = u[0] * solid_angle / (2.0 * pi);
  const double sin_theta = std::sqrt(std::max(0.0, one_minus_cos * (2.0 - one_minus_cos)));
  const Frame frame = Frame::about((1.0 / distance) * to, {1.0, 0.0, 0.0});
  const double phi = 2.0 * pi * u[1];
  const Vec3 direction =
      normalised(frame.to_world(sin_theta * std::cos(phi), sin_theta * std::sin(phi), 1.0 - one_minus_cos));
  // The ray ends before the whole sphere: near its rim single precision cannot say where it is met.
  return LightSample{direction, distance - s.radius, solid_angle, 1.0 / solid_angle, spectrum};
}

}  // namespace

LightSampler::LightSampler(const Light& light, std::size_t channels)
    : point_(std::get_if<PointLight>(&light)),
      sun_(std::get_if<DirectionalLight>(&light)),
      area_(std::get_if<AreaLight>(&light)),
      sky_(std::get_if<EnvironmentLight>(&light)),
      channels_(channels) {
  if (sky_ != nullptr && sky_->map) tabulate(*sky_->map);
}

void LightSampler::tabulate(const EnvironmentMap& map) {
  scaled_.resize(map.values.size());
  for (std::size_t i = 0; i < scaled_.size(); ++i) scaled_[i] = map.values[i] * sky_->radiance[i % channels_];
  double sum = 0.0;
  for (std::size_t row = 0; row < map.height; ++row) {
    // Solid angle of a cell; a part of it alone makes that no dark cell is without chance (values between drawn and run
    // into must agree, not be large).
    const double top = std::cos(pi * static_cast<double>(row) / static_cast<double>(map.height));
    const double bottom = std::cos(pi * static_cast<double>(row + 1) / static_cast<double>(map.height));
    double in_row = 0.0;
    for (std::size_t column = 0; column < map.width; ++column) {
      double mean = 0.0;
      for (std::size_t c = 0; c < channels_; ++c) mean += scaled_[(row * map.width + column) * channels_ + c];
      cells_.push_back(in_row += (top - bottom) * mean);
    }
    rows_.push_back(sum += in_row);
  }
}

bool LightSampler::is_delta() const noexcept { return point_ != nullptr || sun_ != nullptr; }

std::size_t LightSampler::cell_of(const Vec3& direction) const noexcept {
  const EnvironmentMap& map = *sky_->map;
  const auto clamped = [](double part, std::size_t count) {
    const double at = std::floor(part * static_cast<double>(count));
    return std::min(static_cast<std::size_t>(std::max(at, 0.0)), count - 1);
  };
  const double theta = std::atan2(std::hypot(direction.x, direction.y), direction.z);
  double turn = (std::atan2(direction.y, direction.x) - radians(sky_->rotation_deg)) / (2.0 * pi);
  turn -= std::floor(turn);
  return clamped(theta / pi, map.height) * map.width + clamped(turn, map.width);
}

double LightSampler::cell_pdf(std::size_t cell) const noexcept {
  const EnvironmentMap& map = *sky_->map;
  const std::size_t row = cell / map.width;
  if (!(rows_.back() > 0.0)) return 0.0;
  const double before = cell % map.width == 0 ? 0.0 : cells_[cell - 1];
  const double top = std::cos(pi * static_cast<double>(row) / static_cast<double>(map.height));
  const double bottom = std::cos(pi * static_cast<double>(row + 1) / static_cast<double>(map.height));
  const double solid_angle = (top - bottom) * 2.0 * pi / static_cast<double>(map.width);
  return (cells_[cell] - before) / rows_.back() / solid_angle;
}

std::optional<LightSample> LightSampler::sample_sky(const Vec3& normal, const std::array<double, 2>& u) const noexcept {
  if (!sky_->map) {
    const Direction d = CosineLobe::draw(u[0], u[1]);
    const double pdf = CosineLobe::density(d);
    if (!(pdf > 0.0)) return std::nullopt;
    const Vec3 direction = Frame::about(normal, {1.0, 0.0, 0.0}).to_world(d.x, d.y, d.z);
    return LightSample{direction, endless, 1.0 / pdf, pdf, sky_->radiance.data()};
  }
  const EnvironmentMap& map = *sky_->map;
  // The row, then the column, of whose cumulative interval u is; what is left of u says where in it.
  const auto place_in = [](const double* begin, std::size_t count, double& u_left) {
    const double target = u_left * begin[count - 1];
    const auto at = static_cast<std::size_t>(std::upper_bound(begin, begin + count - 1, target) - begin);
    const double before = at == 0 ? 0.0 : begin[at - 1];
    const double width = begin[at] - before;
    u_left = width > 0.0 ? std::clamp((target - before) / width, 0.0, 1.0) : 0.5;
    return at;
  };
  if (!(rows_.back() > 0.0)) return std::nullopt;
  double v0 = u[0], v1 = u[1];
  const std::size_t row = place_in(rows_.data(), map.height, v0);
  const std::size_t column = place_in(cells_.data() + row * map.width, map.width, v1);
  const std::size_t cell = row * map.width + column;
  const double top = std::cos(pi * static_cast<double>(row) / static_cast<double>(map.height));
  const double bottom = std::cos(pi * static_cast<double>(row + 1) / static_cast<double>(map.height));
  const double z = top + v0 * (bottom - top);
  const double phi =
      2.0 * pi * (static_cast<double>(column) + v1) / static_cast<double>(map.width) + radians(sky_->rotation_deg);
  const double rho = std::sqrt(std::max(0.0, 1.0 - z * z));
  const double pdf = cell_pdf(cell);
  if (!(pdf > 0.0)) return std::nullopt;
  return LightSample{
      {rho * std::cos(phi), rho * std::sin(phi), z}, endless, 1.0 / pdf, pdf, &scaled_[cell * channels_]};
}

std::optional<LightSample> LightSampler::sample_area(const Vec3& point, const std::array<double, 2>& u) const noexcept {
  const double* const spectrum = area_->radiance.data();
  if (const auto* sphere = std::get_if<Sphere>(&area_->shape)) return sample_sphere(*sphere, spectrum, point, u);
  const auto* rectangle = std::get_if<Rectangle>(&area_->shape);
  const AreaPoint on = rectangle != nullptr ? point_on(*rectangle, u) : point_on(std::get<Disc>(area_->shape), u);
  const Vec3 to = on.position - point;
  const double distance = length(to);
  const double cos_light = -dot(to, on.normal) / distance;
  if (!(cos_light > 0.0)) return std::nullopt;
  const double solid_angle = on.area * cos_light / (distance * distance);
  return LightSample{(1.0 / distance) * to, distance, solid_angle, 1.0 / solid_angle, spectrum};
}

std::optional<LightSample> LightSampler::sample(const Vec3& point, const Vec3& normal,
                                                const std::array<double, 2>& u) const noexcept {
  if (point_ != nullptr) return sample_of(*point_, point);
  if (sun_ != nullptr) return LightSample{-normalised(sun_->direction), endless, 1.0, 0.0, sun_->irradiance.data()};
  return area_ != nullptr ? sample_area(point, u) : sample_sky(normal, u);
}

LightSampler::Emission LightSampler::emission(const Ray& ray, double distance, const Vec3& normal) const noexcept {
  if (sky_ != nullptr) {
    if (!sky_->map) return {1.0, std::max(0.0, dot(ray.direction, normal)) / pi, sky_->radiance.data()};
    const std::size_t cell = cell_of(ray.direction);
    return {1.0, cell_pdf(cell), &scaled_[cell * channels_]};
  }
  const double* const spectrum = area_->radiance.data();
  if (const auto* sphere = std::get_if<Sphere>(&area_->shape)) {
    const double from = length(sphere->center - ray.origin);
    if (!(from > sphere->radius)) return {0.0, 0.0, spectrum};
    return {1.0, 1.0 / sphere_solid_angle(*sphere, from), spectrum};
  }
  const auto* rectangle = std::get_if<Rectangle>(&area_->shape);
  const AreaPoint on = rectangle != nullptr ? point_on(*rectangle, {}) : point_on(std::get<Disc>(area_->shape), {});
  const double cos_light = -dot(ray.direction, on.normal);
  if (!(cos_light > 0.0)) return {0.0, 0.0, spectrum};
  return {1.0, distance * distance / (on.area * cos_light), spectrum};
}

std::optional<LightSampler::Emission> LightSampler::disc(const Ray& ray, double distance) const noexcept {
  if (point_ != nullptr && point_->radius > 0.0) {
    const Vec3 to = point_->position - ray.origin;
    const double along = dot(to, ray.direction);
    if (!(along > 0.0) || along > distance) return std::nullopt;
    const Vec3 off = to - along * ray.direction;
    if (dot(off, off) > point_->radius * point_->radius) return std::nullopt;
    return Emission{1.0 / (pi * point_->radius * point_->radius), 0.0, point_->intensity.data()};
  }
  if (sun_ != nullptr && sun_->diameter_deg > 0.0 && distance == endless) {
    const Vec3 off = cross(ray.direction, normalised(sun_->direction));
    const double sine = std::sin(radians(0.5 * sun_->diameter_deg));
    if (dot(ray.direction, sun_->direction) >= 0.0 || dot(off, off) > sine * sine) return std::nullopt;
    return Emission{1.0 / (pi * sine * sine), 0.0, sun_->irradiance.data()};
  }
  return std::nullopt;
}

LightSampler::DiscView LightSampler::disc_from(const Vec3& point) const noexcept {
  if (sun_ != nullptr) return {-normalised(sun_->direction), radians(0.5 * sun_->diameter_deg)};
  const Vec3 to = point_->position - point;
  const double distance = length(to);
  if (!(distance > point_->radius)) return {{0.0, 0.0, 1.0}, pi};  // it may be anywhere
  return {(1.0 / distance) * to, std::asin(point_->radius / distance)};
}

}  // namespace goniofit
