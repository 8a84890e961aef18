#include "fit/likelihood_profile.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

#include "fit/fit.h"
#include "fit/held_parameter.h"
#include "fit/polish.h"
#include "fit/solve.h"
#include "support/error.h"

namespace goniofit {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Held fits to this part of the loss: differences of it are what counts, and there are thousands of readings.
constexpr double held_accuracy = 1e-13;
/// Differences of Δ that are of no account.
constexpr double negligible_delta = 1e-3;
constexpr double beyond_limit = 1.25;  ///< how far out a profile goes, in roots of Δ
constexpr int most_steps = 24;

// One parameter's profile in the making.
class ProfileWalk {
 public:
  ProfileWalk(Problem& problem, const FitPoint& best, ParameterChoice choice, const FittedParameter* row);
  [[nodiscard]] LikelihoodProfile run();

 private:
  enum class Side : std::uint8_t { below, above };
  [[nodiscard]] static double sign_of(Side side) { return side == Side::above ? 1.0 : -1.0; }
  [[nodiscard]] double bound_of(Side side) const { return side == Side::above ? held_.upper() : held_.lower(); }
  [[nodiscard]] bool is_on(Side side, double y) const { return side == Side::above ? y > y0_ : y < y0_; }
  [[nodiscard]] bool at_bound(Side side) const {
    return std::fabs(bound_of(side) - y0_) <= 1e-12 * (1.0 + std::fabs(y0_));
  }

  void describe(const FittedParameter* row);
  void choose_scale();
  [[nodiscard]] std::optional<double> measured_curvature(double step);
  [[nodiscard]] double root_delta(double y, bool by_search);
  [[nodiscard]] const FitPoint& fit_at(double y, bool by_search);
  [[nodiscard]] FitPoint start_at(double y) const;
  void note_lower_loss(double y, const FitPoint& point);

  void cover(Side side);
  /// Returns false where the loss falls on the way out.
  [[nodiscard]] bool walk(Side side, bool by_search);
  void forget(Side side);
  [[nodiscard]] bool search_agrees(Side side);
  struct Limit {
    double y;
    ProfileEnd end;
  };
  [[nodiscard]] Limit limit(Side side, double root);
  void add_intervals();
  void add_points();

  Problem& problem_;
  HeldParameter held_;
  FitPoint best_;
  double y0_, loss_;
  double step_ = 0.0;  ///< u in y, or a guess
  ParameterUncertainty linear_;
  std::map<double, FitPoint> points_;  ///< by y
  bool searched_below_ = false, searched_above_ = false;
  LikelihoodProfile out_;
};

ProfileWalk::ProfileWalk(Problem& problem, const FitPoint& best, ParameterChoice choice, const FittedParameter* row)
    : problem_(problem),
      held_(problem, std::move(choice)),
      best_(held_.enter(best)),
      y0_(held_.coordinate(best_)),
      loss_(best.loss) {
  points_[y0_] = best_;
  linear_ = held_.unbounded_uncertainty(best_);
  describe(row);
}

void ProfileWalk::describe(const FittedParameter* row) {
  const ParameterChoice& choice = held_.choice();
  out_.name = choice.name;
  out_.channel = choice.channel;
  out_.value = choice.value_of(y0_);
  if (row == nullptr) return;
  out_.unit = row->unit;
  out_.u = row->u;
  out_.determined = row->value.has_value();
  out_.value = row->value.value_or(out_.value);
  out_.coverage_factor = row->coverage_factor.value_or(out_.coverage_factor);
  out_.interval_by_u = row->interval_95;
  if (out_.interval_by_u || !row->u) return;
  const double reach = out_.coverage_factor * *row->u;
  out_.interval_by_u = Interval{std::max(row->lower, out_.value - reach), std::min(row->upper, out_.value + reach)};
}

// Half of the second derivative of the loss: its gain one `step` away, in units of that step's square.
std::optional<double> ProfileWalk::measured_curvature(double step) {
  if (y0_ - step < held_.lower() || y0_ + step > held_.upper()) return std::nullopt;
  const double above = fit_at(y0_ + step, false).loss;
  const double below = fit_at(y0_ - step, false).loss;
  const double gain = 0.5 * (above + below) - loss_;
  if (gain <= 1e-20 * problem_.total) return 0.0;
  return gain / (step * step);
}

void ProfileWalk::choose_scale() {
  const double stated = out_.u ? *out_.u / held_.choice().slope_at(y0_) : linear_.u;
  const double residuals = static_cast<double>(problem_.samples() * problem_.channels.size());
  if (!(stated > 0.0) || !std::isfinite(stated)) {
    step_ = held_.choice().kind == ParameterChoice::Kind::shape ? 0.1 : 0.05 * (1.0 + std::fabs(y0_));
    out_.scale = loss_ > 1e-20 * problem_.total ? residuals / loss_ : 0.0;
    out_.exact = out_.scale == 0.0;
    return;
  }
  step_ = stated;
  const std::optional<double> measured = out_.u ? measured_curvature(0.1 * stated) : std::nullopt;
  const double half = measured.value_or(1.0 / (linear_.u_unscaled * linear_.u_unscaled));
  out_.exact = !(half > 0.0) || !std::isfinite(half) || loss_ + half * stated * stated <= 1e-18 * problem_.total;
  out_.scale = out_.exact ? 0.0 : 1.0 / (half * stated * stated);
}

// Where the two nearest points say that the others will be.
FitPoint ProfileWalk::start_at(double y) const {
  auto after = points_.lower_bound(y);
  if (points_.size() == 1) return best_;
  if (after == points_.end()) --after;
  if (after == points_.begin()) ++after;
  const auto before = std::prev(after);
  const FitPoint& a = before->second;
  const FitPoint& b = after->second;
  const double t = (y - before->first) / (after->first - before->first);
  FitPoint start = b;
  for (std::size_t z = 0; z < start.z.size(); ++z) start.z[z] = a.z[z] + t * (b.z[z] - a.z[z]);
  for (std::size_t c = 0; c < start.coefficients.size(); ++c)
    start.coefficients[c] = a.coefficients[c] + t * (b.coefficients[c] - a.coefficients[c]);
  for (std::size_t c = 0; c < start.optics.size(); ++c) start.optics[c] = a.optics[c] + t * (b.optics[c] - a.optics[c]);
  return start;
}

const FitPoint& ProfileWalk::fit_at(double y, bool by_search) {
  if (const auto known = points_.find(y); known != points_.end()) return known->second;
  FitPoint start = start_at(y);
  held_.hold(y, start);
  Polished fitted = polish(problem_, start, held_accuracy);
  if (by_search || !fitted.converged) {
    out_.searched = true;
    Solved solved = solve(problem_, held_accuracy);
    if (solved.best.point.loss < fitted.point.loss) fitted = std::move(solved.best);
  }
  note_lower_loss(y, fitted.point);
  return points_[y] = std::move(fitted.point);
}

void ProfileWalk::note_lower_loss(double y, const FitPoint& point) {
  const bool counts = out_.scale > 0.0 && (loss_ - point.loss) * out_.scale > negligible_delta &&
                      loss_ - point.loss > 1e-18 * problem_.total;
  if (!counts || (out_.lower_loss && out_.lower_loss->loss <= point.loss)) return;
  out_.lower_loss = ProfilePoint{held_.choice().value_of(y), point.loss, 0.0};
}

double ProfileWalk::root_delta(double y, bool by_search) {
  return std::sqrt(std::max(0.0, (fit_at(y, by_search).loss - loss_) * out_.scale));
}

void ProfileWalk::forget(Side side) {
  std::erase_if(points_, [&](const auto& at) { return is_on(side, at.first); });
}

// Out to a bit beyond the limit, at steps that a parabola would need three of.
bool ProfileWalk::walk(Side side, bool by_search) {
  const double bound = bound_of(side);
  const double room = std::fabs(bound - y0_);
  const double unit = std::isfinite(room) ? std::min(step_, room / 3.0) : step_;
  const double k = out_.coverage_factor;
  double reach = 1.0;
  double before = 0.0;
  bool rising = true;
  for (int i = 0; i < most_steps; ++i) {
    const bool last = reach * unit >= room * (1.0 - 1e-9);
    const double y = last ? bound : y0_ + sign_of(side) * reach * unit;
    const double root = root_delta(y, by_search);
    if (root < before - std::max(negligible_delta, 0.01 * before)) rising = false;
    if (!rising && !by_search) return false;
    if (last || root >= 0.98 * beyond_limit * k) break;
    before = root;
    reach = i == 0 ? k : i == 1 ? beyond_limit * k : 1.6 * reach;
  }
  return rising;
}

// One full search with a shape parameter held as far out as the walk came. (Of a coefficient it would cost as much as
// the fit, for each of each channel.)
bool ProfileWalk::search_agrees(Side side) {
  if (held_.choice().kind != ParameterChoice::Kind::shape || points_.size() < 2) return true;
  const auto& [y, point] = side == Side::above ? *points_.rbegin() : *points_.begin();
  FitPoint start = point;
  held_.hold(y, start);
  const Solved solved = solve(problem_, held_accuracy);
  return (point.loss - solved.best.point.loss) * out_.scale <=
         negligible_delta * (1.0 + point.loss * out_.scale * 1e-6);
}

void ProfileWalk::cover(Side side) {
  if (at_bound(side)) return;
  if (walk(side, false) && search_agrees(side)) return;
  forget(side);
  (side == Side::above ? searched_above_ : searched_below_) = true;
  if (!walk(side, true)) out_.two_dips = true;
}

// The outermost place where the root of Δ reaches `root`.
ProfileWalk::Limit ProfileWalk::limit(Side side, double root) {
  // What nothing determines may have been left anywhere, on a bound too.
  if (at_bound(side)) return {bound_of(side), out_.determined ? ProfileEnd::bound : ProfileEnd::open};
  const bool by_search = side == Side::above ? searched_above_ : searched_below_;
  std::vector<double> ys{y0_};
  for (const auto& [y, point] : points_) {
    if (is_on(side, y)) ys.push_back(y);
  }
  std::sort(ys.begin(), ys.end(), [this](double a, double b) { return std::fabs(a - y0_) < std::fabs(b - y0_); });
  const auto excess = [&](double y) { return root_delta(y, by_search) - root; };
  if (excess(ys.back()) < 0.0) {
    const bool endless = std::isinf(bound_of(side));
    return {endless ? sign_of(side) * infinity : ys.back(), ProfileEnd::open};
  }
  std::size_t inside = ys.size() - 1;
  while (excess(ys[inside]) >= 0.0) --inside;
  const double a = std::min(ys[inside], ys[inside + 1]);
  const double b = std::max(ys[inside], ys[inside + 1]);
  std::uintmax_t most = 12;
  const auto close = [this](double low, double high) {
    return high - low <= 3e-4 * std::min(std::fabs(low - y0_), std::fabs(high - y0_));
  };
  const auto [low, high] = boost::math::tools::toms748_solve(excess, a, b, excess(a), excess(b), close, most);
  return {std::fabs(excess(low)) < std::fabs(excess(high)) ? low : high, ProfileEnd::crossed};
}

void ProfileWalk::add_intervals() {
  const double k = out_.coverage_factor;
  // k of 68.27 %: 1 for the normal distribution. Student's differs from it by less in the middle than in the tail, and
  // where that counts (few degrees of freedom) by about a third as much.
  const double k_68 = 1.0 + (k / 1.959964 - 1.0) / 3.0;
  const ParameterChoice& choice = held_.choice();
  const auto interval = [&](double root) {
    const Limit below = limit(Side::below, root);
    const Limit above = limit(Side::above, root);
    out_.lower_end = below.end;
    out_.upper_end = above.end;
    return Interval{choice.value_of(below.y), choice.value_of(above.y)};
  };
  Interval inner = interval(k_68);
  const Interval outer = interval(k);
  if (out_.lower_loss) return;
  out_.interval_68 = inner;
  out_.interval_95 = outer;
}

void ProfileWalk::add_points() {
  for (const auto& [y, point] : points_) {
    const double delta = std::max(0.0, (point.loss - loss_) * out_.scale);
    out_.points.push_back({held_.choice().value_of(y), point.loss, delta});
  }
}

LikelihoodProfile ProfileWalk::run() {
  choose_scale();
  if (!out_.exact) {
    cover(Side::below);
    cover(Side::above);
    add_intervals();
  }
  add_points();
  return std::move(out_);
}

bool is_named(const ParameterChoice& choice, const std::string& name) {
  return choice.key() == name || choice.name == name;
}

bool is_chosen(const ParameterChoice& choice, const std::vector<std::string>& names) {
  return names.empty() ||
         std::any_of(names.begin(), names.end(), [&](const std::string& name) { return is_named(choice, name); });
}

}  // namespace

double LikelihoodProfile::asymmetry() const {
  if (!interval_95 || !u) return 0.0;
  const double reach = coverage_factor * *u;
  double worst = 0.0;
  if (lower_end == ProfileEnd::crossed) worst = std::fabs((value - interval_95->lower) / reach - 1.0);
  if (upper_end == ProfileEnd::crossed) worst = std::max(worst, std::fabs((interval_95->upper - value) / reach - 1.0));
  return worst;
}

std::string LikelihoodProfile::remark() const {
  if (lower_loss) return "a lower loss was met: the fit has failed";
  if (exact) return "no noise to speak of: no profile";
  const bool below = lower_end == ProfileEnd::open;
  const bool above = upper_end == ProfileEnd::open;
  if (below && above) return "open on both sides: not determined";
  std::string text;
  const auto add = [&text](const char* words) { text += (text.empty() ? "" : ", ") + std::string(words); };
  // The bounds of a coefficient are what it can be; those of a shape parameter only how far was looked.
  const bool own_bounds = !channel.empty();
  const bool on_bound = lower_end == ProfileEnd::bound || upper_end == ProfileEnd::bound;
  if (on_bound || (own_bounds && (below || above))) add("one-sided");
  if (below && !own_bounds) add("open below");
  if (above && (!own_bounds || on_bound)) add("open above");
  if (two_dips) add("two dips");
  if (asymmetry() > 0.1) add("not parabolic");
  return text;
}

void check_profile_names(const Problem& problem, const std::vector<std::string>& names) {
  const std::vector<ParameterChoice> choices = free_choices(problem);
  for (const std::string& name : names) {
    if (std::any_of(choices.begin(), choices.end(), [&](const auto& choice) { return is_named(choice, name); }))
      continue;
    std::vector<std::string> known;
    for (const ParameterChoice& choice : choices) {
      if (std::find(known.begin(), known.end(), choice.name) == known.end()) known.push_back(choice.name);
    }
    std::string list;
    for (const std::string& one : known) list += (list.empty() ? "" : ", ") + one;
    throw usage_error("profile: " + name + " is no parameter that this fit leaves free, expected some of " + list +
                      " or CHANNEL.name");
  }
}

std::vector<LikelihoodProfile> likelihood_profiles(Problem& problem, const FitPoint& best,
                                                   const std::vector<FittedParameter>& rows,
                                                   const std::vector<std::string>& names) {
  std::vector<LikelihoodProfile> profiles;
  for (const ParameterChoice& choice : free_choices(problem)) {
    if (!is_chosen(choice, names)) continue;
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const FittedParameter& p) {
      return p.name == choice.name && p.channel == choice.channel;
    });
    profiles.push_back(ProfileWalk(problem, best, choice, row == rows.end() ? nullptr : &*row).run());
  }
  return profiles;
}

}  // namespace goniofit
