#include "fit/thinning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace goniofit {

namespace {

constexpr std::size_t most_of_a_stratum = 384;
constexpr double own_part = 1.0 / 8000.0;  // of the squared signal: so many readings at most have it
constexpr std::size_t mirror_steps = 40, grazing_steps = 3;

// ln tan²θ_b from 10⁻⁸ on in steps of 0.6: a lobe that is some tenths wide in ln slope changes over one.
std::size_t stratum_of(const PairBatch& pairs, std::size_t i) {
  const double from_mirror = (std::log(std::max(pairs.tan2_b[i], 1e-8)) + 18.42) / 0.6;
  const auto step = static_cast<std::size_t>(std::clamp(from_mirror, 0.0, static_cast<double>(mirror_steps - 1)));
  const double least = std::min(pairs.cos_i[i], pairs.cos_r[i]);
  const std::size_t grazing = least < 0.2 ? 2 : least < 0.5 ? 1 : 0;
  return step * grazing_steps + grazing;
}

double signal2(const Problem& problem, std::size_t row) {
  const auto i = static_cast<Eigen::Index>(row);
  double sum = 0.0;
  for (const ProblemChannel& c : problem.channels) {
    const double own = problem.weight[i] * c.value[i] * (c.emphasis.size() > 0 ? c.emphasis[i] : 1.0);
    sum += own * own;
  }
  return sum;
}

// Members of one stratum in the scan's order. The k-th of `most` is drawn from the k-th part of them, at a place in it
// that no regular grid of directions shares.
class Draw {
 public:
  explicit Draw(std::size_t members) : members_(members), drawn_(std::min(members, most_of_a_stratum)) {}

  /// Whether the next member is drawn.
  bool take() noexcept {
    const bool taken = next_ < drawn_ && seen_ >= place(next_);
    ++seen_;
    next_ += taken ? 1 : 0;
    return taken;
  }
  [[nodiscard]] double factor() const noexcept {
    return std::sqrt(static_cast<double>(members_) / static_cast<double>(drawn_));
  }

 private:
  [[nodiscard]] std::size_t place(std::size_t k) const noexcept {
    if (drawn_ == members_) return k;
    constexpr double golden = 0.6180339887498949;
    const double within = std::fmod(static_cast<double>(k) * golden, 1.0);
    const double at = (static_cast<double>(k) + within) * static_cast<double>(members_) / static_cast<double>(drawn_);
    return static_cast<std::size_t>(at);
  }

  std::size_t members_, drawn_, seen_ = 0, next_ = 0;
};

}  // namespace

RowSelection searched_rows(const Problem& problem) {
  if (problem.readings() <= most_searched || !problem.quadratic()) return {};
  constexpr std::uint8_t own = mirror_steps * grazing_steps;
  std::vector<std::uint8_t> stratum(problem.readings());
  std::array<std::size_t, own> members{};
  std::size_t reading = 0;
  problem.for_each_pairs([&](const PairBatch& run) {
    for (std::size_t i = 0; i < run.size() && reading < stratum.size(); ++i, ++reading) {
      const bool rules = signal2(problem, reading) > own_part * problem.total;
      stratum[reading] = rules ? own : static_cast<std::uint8_t>(stratum_of(run, i));
      if (!rules) ++members[stratum[reading]];
    }
  });
  std::vector<Draw> draws;
  for (const std::size_t count : members) draws.emplace_back(count);
  RowSelection out;
  const auto add = [&out](std::size_t row, double factor) {
    out.rows.push_back(row);
    out.factor.push_back(factor);
  };
  for (std::size_t i = 0; i < stratum.size(); ++i) {
    if (stratum[i] == own) {
      add(i, 1.0);
    } else if (Draw& draw = draws[stratum[i]]; draw.take()) {
      add(i, draw.factor());
    }
  }
  for (std::size_t row = problem.readings(); row < problem.samples(); ++row) add(row, 1.0);
  return out;
}

}  // namespace goniofit
