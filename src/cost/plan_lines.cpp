#include "cost/plan_lines.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace goniofit {

namespace {

std::string percent(double part) {
  const double p = 100.0 * std::fabs(part);
  return p >= 10.0 ? fmt::format("{:.0f} %", p) : p >= 0.095 ? fmt::format("{:.1f} %", p) : fmt::format("{:.1g} %", p);
}

// Below this a difference in time is the machine's.
constexpr double noise = 0.005;

std::string saving(double saves, bool done) {
  if (std::fabs(saves) < noise) return done ? "saves no time" : "save no time";
  const std::string verb = saves > 0.0 ? "save" : "cost";
  return verb + (done ? "s " : " ") + percent(saves);
}

class Lines {
 public:
  Lines(PlanSearch& search, const PlanChoice& chosen) : search_(search), chosen_(chosen) {}

  void effects() {
    const EffectSet all = search_.reference().effects;
    for (const Effect e : all_effects) {
      if (!all.has(e)) continue;
      const bool kept = chosen_.effects.has(e);
      PlanChoice other = chosen_;
      PlanChoice simplified = kept ? chosen_ : search_.reference();
      simplified.effects.erase(e);
      kept ? other.effects.erase(e) : other.effects.insert(e);
      if (other.effects.empty()) continue;
      const std::string* reason = search_.reason_to_keep(e);
      add({std::string(name_of(e)),
           kept ? "kept" : "left out",
           {},
           !kept,
           worst(simplified),
           0.0,
           reason != nullptr ? *reason : std::string()},
          fill(other));
    }
  }

  // A term by its tiers, the reference's first: where the plan has a cheaper one, what it is instead of; where it has
  // the reference's, the cheaper one that errs least.
  template <class Tier>
  void term(const char* subject, const std::vector<Tier>& tiers, Tier Terms::*member) {
    const Tier tier = chosen_.terms.*member;
    const auto with = [&](PlanChoice c, Tier t) {
      c.terms.*member = t;
      return c;
    };
    const std::string choice(name_of(tier));
    if (tier != tiers.front()) {
      add({subject, choice, std::string(name_of(tiers.front())), true, worst(with(search_.reference(), tier)), 0.0},
          with(chosen_, tiers.front()));
      return;
    }
    const PlanAlternative* best = nullptr;
    std::vector<PlanAlternative> refused;
    for (std::size_t i = 1; i < tiers.size(); ++i) {
      const PlanChoice other = with(chosen_, tiers[i]);
      refused.push_back({{subject, choice, std::string(name_of(tiers[i])), false, worst(other), 0.0}, other});
    }
    for (const PlanAlternative& r : refused) {
      if (best == nullptr || r.line.change < best->line.change) best = &r;
    }
    if (best != nullptr) add(best->line, best->other);
  }

  void rough() {
    if (!chosen_.effects.has(Effect::rough)) return;
    const std::vector<RoughForm>& forms = search_.rough();
    if (chosen_.rough == forms.front()) return;
    PlanChoice simplified = search_.reference();
    simplified.rough = chosen_.rough;
    PlanChoice other = chosen_;
    other.rough = forms.front();
    add({"rough", std::string(name_of(chosen_.rough)), std::string(name_of(forms.front())), true, worst(simplified),
         0.0},
        other);
  }

  [[nodiscard]] std::vector<PlanAlternative> take() { return std::move(lines_); }

 private:
  [[nodiscard]] double worst(const PlanChoice& c) { return search_.error(search_.canonical(c)).worst_l1; }
  // An effect that comes back reads terms that nothing else read: the reference's.
  [[nodiscard]] PlanChoice fill(PlanChoice c) const {
    const Terms& exact = search_.reference().terms;
    if (!reads_fresnel(chosen_.effects)) c.terms.fresnel = exact.fresnel;
    if (!reads_shadowing(chosen_.effects)) c.terms.shadowing = exact.shadowing;
    if (!reads_effective_roughness(chosen_.effects)) c.terms.effective_roughness = exact.effective_roughness;
    if (!reads_distribution(chosen_.effects)) c.terms.distribution = exact.distribution;
    return c;
  }
  void add(PlanLine line, const PlanChoice& other) { lines_.push_back({std::move(line), search_.canonical(other)}); }

  PlanSearch& search_;
  PlanChoice chosen_;
  std::vector<PlanAlternative> lines_;
};

}  // namespace

std::string PlanLine::text() const {
  if (choice == "left out") return subject + " left out: changes " + percent(change) + ", " + saving(saves, true);
  if (choice == "kept" && !because.empty()) return subject + " kept: " + because;
  if (choice == "kept") {
    return subject + " kept: leaving it out would change " + percent(change) + " and " + saving(saves, false);
  }
  if (simplified) {
    const std::string what =
        choice == "none" ? subject + " left out" : subject + " " + choice + " instead of " + instead;
    return what + ": changes " + percent(change) + ", " + saving(saves, true);
  }
  const std::string other = instead == "none" ? "leaving it out" : instead;
  return subject + " " + choice + " kept: " + other + " would change " + percent(change) + " and " +
         saving(saves, false);
}

std::vector<PlanAlternative> plan_alternatives(PlanSearch& search, const PlanChoice& chosen) {
  Lines lines(search, chosen);
  lines.effects();
  if (reads_fresnel(chosen.effects)) lines.term("fresnel", search.fresnel(), &Terms::fresnel);
  if (reads_shadowing(chosen.effects)) lines.term("shadowing", search.shadowing(), &Terms::shadowing);
  if (reads_effective_roughness(chosen.effects)) {
    lines.term("effective_roughness", search.roughness(), &Terms::effective_roughness);
  }
  if (reads_distribution(chosen.effects)) lines.term("distribution", search.distribution(), &Terms::distribution);
  lines.rough();
  return lines.take();
}

}  // namespace goniofit
