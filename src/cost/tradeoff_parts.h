#pragma once
// The tables that a trade-off is made of. Private to it.

#include <functional>
#include <string>
#include <vector>

#include "candidate.h"
#include "reference.h"
#include "tradeoff.h"

namespace goniofit::tradeoff {

using Rows = std::vector<TradeoffRow>;
using Note = std::function<void(const std::string& what)>;

/// One table: candidates that are compared with each other.
struct Table {
  TradeoffGroup group{};
  std::string material, reference;
  std::size_t baseline = 0;  ///< the candidate that ratios are over
  std::vector<EvaluationCandidate> candidates{};
  bool all_channels = false;  ///< also the time of all channels together
};

/// Times the candidates in turn, and measures each against `exact`.
[[nodiscard]] Rows measured(const Table& table, const EvaluationCandidate& exact, const ErrorSamples& samples,
                            const TradeoffSettings& settings);
/// Errors of them all left at 0.
[[nodiscard]] Rows timed(const Table& table, const TradeoffSettings& settings);
void mark_pareto(Rows& rows);

[[nodiscard]] Rows model_rows(const Material& material, const TradeoffSettings& settings, const Note& note);
/// Of one of the four terms.
[[nodiscard]] Rows term_rows(TradeoffGroup group, const Material& material, const TradeoffSettings& settings);
[[nodiscard]] Rows oren_nayar_rows(const Material& material, const TradeoffSettings& settings);
[[nodiscard]] Rows effect_rows(const Material& material, const TradeoffSettings& settings);
[[nodiscard]] Rows fit_rows(const Material& material, const TradeoffSettings& settings, const Note& note);

}  // namespace goniofit::tradeoff
