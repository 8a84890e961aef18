#pragma once
// What the models are made of, as `goniofit models` tells it: effects, tiers, parameters with bounds and units.

#include <limits>
#include <string>
#include <vector>

namespace goniofit::cli {

struct EffectEntry {
  std::string name, coefficient, formula, meaning;
};
struct TierEntry {
  std::string name, meaning;
  bool is_default = false;
};
struct TermEntry {
  std::string name;
  std::vector<TierEntry> tiers;
};
struct ParameterEntry {
  std::string name, unit, scope;  ///< scope: shared or channel
  double min = 0.0;
  double max = std::numeric_limits<double>::infinity();  ///< infinity: no bound
  std::string meaning;
};

struct PeerEntry {
  std::string name, meaning, paper;
  std::vector<ParameterEntry> parameters;  ///< shared ones, then those of a channel
  bool reads_fresnel = false;              ///< whether n and kappa, or f0, are read
};

[[nodiscard]] std::vector<EffectEntry> effect_catalogue();
[[nodiscard]] std::vector<TermEntry> term_catalogue();
[[nodiscard]] std::vector<ParameterEntry> parameter_catalogue();
[[nodiscard]] std::vector<PeerEntry> peer_entries();

}  // namespace goniofit::cli
