#include "fit/selection.h"

#include <algorithm>
#include <string>
#include <utility>

#include "fit/selection_bands.h"
#include "fit/selection_choice.h"
#include "fit/selection_guard.h"
#include "fit/selection_noise.h"

namespace goniofit {

namespace {

constexpr std::size_t most_channels = 6;

// chi² of one channel.
double chi2_of(const Candidate& c, const Eigen::VectorXd& variance, std::size_t channel) {
  const auto n = static_cast<Eigen::Index>(c.problem->samples());
  const auto at = static_cast<Eigen::Index>(channel) * n;
  return (predict(c).residual.segment(at, n).array().square() / variance.segment(at, n).array()).sum();
}

// The channels where the sets that contain the choice find an effect standing that it lacks, by the fits to all
// channels, each with the chi² to show for it.
std::vector<std::size_t> overlooked_channels(const Scan& scan, const FitSettings& settings, const Choice& choice) {
  const EffectSet chosen = choice.selection.chosen();
  const auto larger = std::max_element(choice.fitted.begin(), choice.fitted.end(), [&](const auto& a, const auto& b) {
    const auto key = [&](const Candidate& c) {
      return contains(c.row.components, chosen) ? c.problem->basis->columns().size() : 0;
    };
    return key(a) < key(b);
  });
  std::vector<std::size_t> found;
  if (larger->row.components == chosen) return found;
  Candidate most = fit_candidate(scan, settings, larger->row.components);
  Candidate own = fit_candidate(scan, settings, chosen, &most);
  const Eigen::VectorXd variance = variance_at(most, choice.selection.noise, choice.selection.u_scale);
  fit_weighted(most, variance);
  fit_weighted(own, variance);
  const StandingEffects standing(most);
  for (std::size_t c = 0; c < scan.channels.size(); ++c) {
    const bool stands = std::any_of(all_effects.begin(), all_effects.end(), [&](Effect e) {
      return !chosen.has(e) && most.row.components.has(e) && standing.stands(e, c);
    });
    // two for each parameter that the channel has more, as the AICc counts them
    const auto more =
        static_cast<double>(most.problem->basis->coefficients().size() - own.problem->basis->coefficients().size());
    if (stands && chi2_of(own, variance, c) - chi2_of(most, variance, c) > 2.0 * more) found.push_back(c);
  }
  return found;
}

}  // namespace

EffectSet Selection::chosen() const { return rows.front().components; }

Selection select_components(const Scan& scan, const FitSettings& settings) {
  std::vector<std::size_t> channels = telling_channels(scan, most_channels);
  while (true) {
    Choice choice = choose_components(with_channels(scan, channels), with_channels(settings, scan, channels));
    if (channels.size() == scan.channels.size()) return std::move(choice.selection);
    for (const std::size_t c : channels) choice.selection.channels.push_back(scan.channels[c].name);
    // A channel that shows an effect which these do not joins them.
    const std::vector<std::size_t> overlooked = overlooked_channels(scan, settings, choice);
    const auto added = std::find_if(overlooked.begin(), overlooked.end(), [&](std::size_t c) {
      return std::find(channels.begin(), channels.end(), c) == channels.end();
    });
    if (added == overlooked.end()) return std::move(choice.selection);
    channels.insert(std::lower_bound(channels.begin(), channels.end(), *added), *added);
  }
}

}  // namespace goniofit
