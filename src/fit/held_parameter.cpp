#include "fit/held_parameter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace goniofit {

namespace {

using Kind = ParameterChoice::Kind;

constexpr double infinity = std::numeric_limits<double>::infinity();

// Shape parameters and lengths in the order of the report.
class ShapeChoices {
 public:
  explicit ShapeChoices(const Problem& problem) : problem_(problem) {}
  [[nodiscard]] std::vector<ParameterChoice> all() const;

 private:
  [[nodiscard]] ParameterChoice of(const std::string& name, std::size_t parameter, double sign = 1.0) const {
    const auto row = static_cast<Eigen::Index>(parameter);
    const double origin = problem_.basis->shape_parameters()[parameter].origin;
    return {name,  "", Kind::shape, sign * problem_.shape.map.row(row).transpose(), sign * problem_.shape.offset[row],
            origin};
  }
  void add(std::vector<ParameterChoice>& to, ParameterChoice choice) const {
    if ((choice.gradient.array() != 0.0).any()) to.push_back(std::move(choice));
  }
  [[nodiscard]] std::optional<ParameterChoice> sigma() const;
  [[nodiscard]] ParameterChoice tau(const std::string& name, std::size_t slope) const;

  const Problem& problem_;
};

std::optional<ParameterChoice> ShapeChoices::sigma() const {
  if (const auto own = problem_.shape_index("sigma_um")) return of("sigma_um", *own);
  const auto slope = problem_.shape_index("slope");
  if (!slope) return std::nullopt;
  if (problem_.known_tau_um && !problem_.known_sigma_um) {
    ParameterChoice from_tau = of("sigma_um", *slope);
    from_tau.offset += std::log(*problem_.known_tau_um);
    return from_tau;
  }
  if (!problem_.known_sigma_um) return std::nullopt;
  return ParameterChoice{"sigma_um", "", Kind::shape, Eigen::VectorXd::Zero(problem_.shape.free),
                         std::log(*problem_.known_sigma_um)};
}

ParameterChoice ShapeChoices::tau(const std::string& name, std::size_t slope) const {
  ParameterChoice choice = of(name, slope, -1.0);
  const ParameterChoice sigma_choice = *sigma();
  choice.gradient += sigma_choice.gradient;
  choice.offset += sigma_choice.offset;
  return choice;
}

std::vector<ParameterChoice> ShapeChoices::all() const {
  std::vector<ParameterChoice> choices;
  const std::vector<ShapeParameter>& parameters = problem_.basis->shape_parameters();
  const bool surface = problem_.model == surface_model;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const bool beside_slopes = surface && parameters[i].name == "sigma_um";
    if (!beside_slopes) add(choices, of(parameters[i].name, i));
  }
  if (!surface || !sigma()) return choices;
  add(choices, *sigma());
  for (const auto& [length, slope] : {std::pair{"tau_um", "slope"}, std::pair{"tau_y_um", "slope_y"}}) {
    if (const auto index = problem_.shape_index(slope)) add(choices, tau(length, *index));
  }
  return choices;
}

}  // namespace

double ParameterChoice::value_of(double y) const { return kind == Kind::shape ? origin + std::exp(y) : y; }
double ParameterChoice::slope_at(double y) const { return kind == Kind::shape ? std::exp(y) : 1.0; }

std::vector<ParameterChoice> free_choices(const Problem& problem) {
  std::vector<ParameterChoice> choices = ShapeChoices(problem).all();
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    const ProblemChannel& channel = problem.channels[c];
    const auto add = [&](const std::string& name, Kind kind, Eigen::Index j) {
      choices.push_back({name, channel.name, kind, {}, 0.0, 0.0, c, j});
    };
    if (problem.free_optics != FreeOptics::none && channel.optics_lower < channel.optics_upper)
      add(problem.free_optics == FreeOptics::n ? "n" : "f0", Kind::optics, 0);
    for (Eigen::Index j = 0; j < channel.lower.size(); ++j) {
      if (channel.lower[j] < channel.upper[j])
        add(problem.basis->coefficients()[static_cast<std::size_t>(j)].name, Kind::coefficient, j);
    }
  }
  return choices;
}

HeldParameter::HeldParameter(Problem& problem, ParameterChoice choice)
    : problem_(problem), choice_(std::move(choice)), shape_(problem.shape), optics_groups_(problem.optics_groups) {
  if (choice_.kind == Kind::shape) {
    take_combination();
    return;
  }
  ProblemChannel& channel = problem_.channels[choice_.channel_index];
  channels_.push_back(channel);
  const bool optics = choice_.kind == Kind::optics;
  lower_ = optics ? channel.optics_lower : channel.lower[choice_.coefficient];
  upper_ = optics ? channel.optics_upper : channel.upper[choice_.coefficient];
  // A search takes the optics of a channel for those of its whole group.
  if (optics) channel.optics_group = problem_.optics_groups++;
}

// y = offset + g · z replaces the first z that it reads: z_a = (y - offset - g_b z_b) / g_a.
void HeldParameter::take_combination() {
  const Eigen::VectorXd& g = choice_.gradient;
  place_ = 0;
  while (g[place_] == 0.0) ++place_;
  for (Eigen::Index b = place_ + 1; b < g.size(); ++b) {
    if (g[b] != 0.0) partner_ = b;
  }
  ShapeMap& shape = problem_.shape;
  shape.offset -= shape_.map.col(place_) * (choice_.offset / g[place_]);
  shape.map.col(place_) /= g[place_];
  if (partner_ >= 0) shape.map.col(partner_) -= shape_.map.col(place_) * (g[partner_] / g[place_]);
  lower_ = upper_ = choice_.offset;
  for (Eigen::Index a = 0; a < g.size(); ++a) {
    const auto i = static_cast<std::size_t>(a);
    if (g[a] == 0.0) continue;
    lower_ += std::min(g[a] * shape_.lower[i], g[a] * shape_.upper[i]);
    upper_ += std::max(g[a] * shape_.lower[i], g[a] * shape_.upper[i]);
  }
  set_bounds(lower_, upper_);
}

HeldParameter::~HeldParameter() {
  problem_.shape = shape_;
  problem_.optics_groups = optics_groups_;
  if (!channels_.empty()) problem_.channels[choice_.channel_index] = std::move(channels_.front());
}

double HeldParameter::coordinate(const FitPoint& point) const {
  if (choice_.kind == Kind::optics) return point.optics[choice_.channel_index];
  if (choice_.kind == Kind::coefficient) return point.coefficients[choice_.channel_index][choice_.coefficient];
  return point.z[static_cast<std::size_t>(place_)];
}

FitPoint HeldParameter::enter(FitPoint point) const {
  if (choice_.kind != Kind::shape) return point;
  double y = choice_.offset;
  for (Eigen::Index a = 0; a < choice_.gradient.size(); ++a)
    y += choice_.gradient[a] * point.z[static_cast<std::size_t>(a)];
  point.z[static_cast<std::size_t>(place_)] = std::clamp(y, lower_, upper_);
  return point;
}

void HeldParameter::set_bounds(double lower, double upper) {
  if (choice_.kind == Kind::shape) {
    const auto a = static_cast<std::size_t>(place_);
    problem_.shape.lower[a] = lower;
    problem_.shape.upper[a] = upper;
    return;
  }
  ProblemChannel& channel = problem_.channels[choice_.channel_index];
  const bool optics = choice_.kind == Kind::optics;
  (optics ? channel.optics_lower : channel.lower[choice_.coefficient]) = lower;
  (optics ? channel.optics_upper : channel.upper[choice_.coefficient]) = upper;
}

void HeldParameter::hold(double y, FitPoint& point) {
  set_bounds(y, y);
  if (choice_.kind == Kind::optics) point.optics[choice_.channel_index] = y;
  if (choice_.kind == Kind::coefficient) point.coefficients[choice_.channel_index][choice_.coefficient] = y;
  if (choice_.kind == Kind::shape) point.z[static_cast<std::size_t>(place_)] = y;
  if (partner_ >= 0) {
    // What keeps the z that y stands for within its own bounds.
    const auto a = static_cast<std::size_t>(place_);
    const auto b = static_cast<std::size_t>(partner_);
    const double g_a = choice_.gradient[place_];
    const double g_b = choice_.gradient[partner_];
    const double one = (y - choice_.offset - g_a * shape_.lower[a]) / g_b;
    const double other = (y - choice_.offset - g_a * shape_.upper[a]) / g_b;
    problem_.shape.lower[b] = std::max(shape_.lower[b], std::min(one, other));
    problem_.shape.upper[b] = std::max(problem_.shape.lower[b], std::min(shape_.upper[b], std::max(one, other)));
  }
  for (std::size_t z = 0; z < point.z.size(); ++z)
    point.z[z] = std::clamp(point.z[z], problem_.shape.lower[z], problem_.shape.upper[z]);
  for (std::size_t c = 0; c < point.coefficients.size(); ++c) {
    const ProblemChannel& channel = problem_.channels[c];
    point.coefficients[c] = point.coefficients[c].cwiseMax(channel.lower).cwiseMin(channel.upper);
    if (!point.optics.empty())
      point.optics[c] = std::clamp(point.optics[c], channel.optics_lower, channel.optics_upper);
  }
}

ParameterUncertainty HeldParameter::unbounded_uncertainty(const FitPoint& point) {
  set_bounds(-infinity, infinity);
  const Uncertainties u = uncertainties(problem_, point, linearise(problem_, point));
  set_bounds(lower_, upper_);
  if (choice_.kind == Kind::shape) return u.shape[static_cast<std::size_t>(place_)];
  if (choice_.kind == Kind::optics) return u.optics[choice_.channel_index];
  return u.coefficients[choice_.channel_index][static_cast<std::size_t>(choice_.coefficient)];
}

}  // namespace goniofit
