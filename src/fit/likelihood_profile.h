#pragma once
// Profile-likelihood intervals: what the data say of one parameter once all others have made the best of each of its
// values. Unlike value ± k u they know bounds, asymmetry, and that a parameter may be open on one side.
//
// The statistic. Let l(p) be the least loss over all other parameters with p held, p̂ the fitted value. Were the loss
// a sum of squares over known variances, l(p) - l(p̂) would be twice a log-likelihood ratio, chi-square of one degree of
// freedom at the true p. The published loss is not: its weights are not the noise's, so near the minimum
//
//   l(p) - l(p̂) ≈ ½ l″(p̂) (p - p̂)²   with   (p - p̂)²/u² ~ chi-square(1),
//
// where u is the standard uncertainty that the fit states, right for the noise that there is (the sandwich's). The
// vertical adjustment of Chandler & Bate (Biometrika 94, 2007, 167-183) makes the two agree:
//
//   Δ(p) = c [l(p) - l(p̂)],   c = 2 / (l″(p̂) u²),
//
// so that Δ ≈ (p - p̂)²/u² about the minimum while the loss alone decides the shape beyond. With weights 1/u_i² and the
// uncertainty that follows from them l″ = 2/u² and c = 1: the plain likelihood ratio. l″ is measured on the profile
// itself, at a tenth of u on either side; next to a bound it is the linear model's, 2/u² with the unscaled u. A
// parameter on its bound takes u as if it were free, and one that has none takes c = 1/s², s² the residual variance.
//
// The interval is where Δ <= k², k the coverage factor of the parameter's U = k u (1.96, or Student's where few
// readings leave u itself uncertain: then Δ is F(1, ν)). A bound that comes first is its end. Where p̂ is at or near a
// bound that interval is one-sided and covers 95 to 97.5 %, since the likelihood ratio is against the best p allowed.
//
// Each held fit starts from its neighbours on the profile. Where that fails, where the loss falls on the way out, or
// where a search with a shape parameter held finds less than the outermost fit, that side is searched point by point.

#include <optional>
#include <string>
#include <vector>

#include "../brdf/material.h"

namespace goniofit {

class Problem;
struct FitPoint;
struct FittedParameter;

struct ProfilePoint {
  double value = 0.0;
  double loss = 0.0;
  double delta = 0.0;  ///< Δ, at least 0; (value - estimate)²/u² where the profile is a parabola
};

enum class ProfileEnd : std::uint8_t {
  crossed,  ///< Δ reaches k² there
  bound,    ///< the estimate is on its bound, which is the end
  open      ///< the bound, or as far as was looked, comes before Δ reaches k²
};

struct LikelihoodProfile {
  std::string name, channel;  ///< as in FittedParameter
  std::string unit;
  double value = 0.0;         ///< of the least loss
  std::optional<double> u{};  ///< standard uncertainty, as the fit states it
  bool determined = true;     ///< the fit states a value
  double coverage_factor = 1.96;
  double scale = 0.0;                       ///< c
  std::vector<ProfilePoint> points{};       ///< by value, the estimate among them
  std::optional<Interval> interval_by_u{};  ///< of 95 %, within the bounds
  std::optional<Interval> interval_68{}, interval_95{};
  ProfileEnd lower_end = ProfileEnd::crossed, upper_end = ProfileEnd::crossed;  ///< of 95 %
  bool searched = false;                                                        ///< a side was searched point by point
  bool two_dips = false;  ///< Δ falls again on the way out: the interval holds both dips
  bool exact = false;     ///< the loss about the minimum is round-off: no profile, and no intervals
  /// A lower loss than the fit's was met: the fit has failed, and there are no intervals.
  std::optional<ProfilePoint> lower_loss{};

  /// Largest relative deviation of the limits of 95 % from value ± k u; of crossed ones.
  [[nodiscard]] double asymmetry() const;
  /// "one-sided" (a bound of its own is an end), "open above", "not parabolic": in words; empty where the interval is
  /// as good as value ± k u.
  [[nodiscard]] std::string remark() const;
  /// "slope", "R.k_dd".
  [[nodiscard]] std::string key() const { return channel.empty() ? name : channel + "." + name; }
};

/// Throws Error (bad_input) naming the parameters that there are, where one of `names` is none that the problem leaves
/// free. A name without channel stands for that coefficient of every channel.
void check_profile_names(const Problem& problem, const std::vector<std::string>& names);

/// Profiles of the parameters named, all for none, in the report's order; names that the problem does not have are left
/// out. `best` is the fit and `rows` what it states; intervals are in the rows' units. The problem is as before
/// afterwards. Deterministic.
[[nodiscard]] std::vector<LikelihoodProfile> likelihood_profiles(Problem& problem, const FitPoint& best,
                                                                 const std::vector<FittedParameter>& rows,
                                                                 const std::vector<std::string>& names);

}  // namespace goniofit
