// Whole models: the paper's table 4.

#include <string>

#include "cost/fitted_models.h"
#include "cost/tradeoff_parts.h"

namespace goniofit::tradeoff {

namespace {

constexpr double loose = 1e-4;

EvaluationCandidate with_terms(std::string name, const Material& m, const Terms& terms, const TradeoffSettings& s) {
  EvaluationCandidate c{.name = std::move(name), .material = m, .compile = {.instructions = s.instructions}};
  c.material.terms = terms;
  return c;
}

// The same kernel with terms good to 1e-4, and both in single precision.
void add_variants(std::vector<EvaluationCandidate>& to, const EvaluationCandidate& c) {
  EvaluationCandidate variant = c;
  variant.name = c.name + ", terms to 1e-4";
  variant.compile.tolerance = loose;
  to.push_back(variant);
  variant.name = c.name + ", float, terms to 1e-4";
  variant.arithmetic = Arithmetic::batch_float;
  to.push_back(variant);
  variant.name = c.name + ", float";
  variant.compile.tolerance = 0.0;
  to.push_back(variant);
}

void add_scalar(std::vector<EvaluationCandidate>& to, EvaluationCandidate c) {
  c.name += ", one by one";
  c.arithmetic = Arithmetic::scalar;
  to.push_back(std::move(c));
}

}  // namespace

Rows model_rows(const Material& material, const TradeoffSettings& s, const Note& note) {
  const Reference reference = reference_of(material, WaveOptics::series);
  const Reference fast = reference_of(material, WaveOptics::fast);
  Table table{
      .group = TradeoffGroup::model, .material = material.name, .reference = reference.name, .all_channels = true};
  std::vector<EvaluationCandidate>& list = table.candidates;
  const EvaluationCandidate lt = with_terms("li-torrance", material, published_terms(material), s);
  list = {lt};
  add_variants(list, lt);
  EvaluationCandidate shortcut = lt;
  shortcut.name += ", S = 1 shortcut";
  shortcut.compile.shadowing_shortcut = true;
  list.push_back(shortcut);
  add_scalar(list, lt);
  const bool wave_optics = reference.material.terms.distribution == DistributionTier::he_torrance_series;
  const EvaluationCandidate he =
      with_terms(wave_optics ? "he-torrance" : "exact terms", material, fast.material.terms, s);
  list.push_back(he);
  add_variants(list, he);
  add_scalar(list, he);
  const EvaluationCandidate exact = with_terms("he-torrance-series", material, reference.material.terms, s);
  if (wave_optics) list.push_back(exact);

  const Scan scan = reference_scan(fast.material, s.seed + 1);
  for (const std::string& peer : s.peers.value_or(peers_for(material))) {
    note(material.name + ", fitting " + peer);
    list.push_back(fitted_peer(peer, scan, fast.material));
    list.back().compile.instructions = s.instructions;
  }
  note(material.name);
  return measured(table, exact, error_samples(fast.material, {}, s.errors), s);
}

}  // namespace goniofit::tradeoff
