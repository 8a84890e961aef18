#include "cli/value_warnings.h"

#include <cstddef>
#include <iostream>

#include <fmt/format.h>

#include "geometry/pair.h"
#include "report/text_table.h"

namespace goniofit::cli {

void warn_of_values(const Evaluator& evaluator, const std::vector<AnglePair>& directions, const std::string& source) {
  std::size_t saturated = 0;
  std::size_t cut = 0;
  for (const AnglePair& angles : directions) {
    const Pair pair = make_pair(angles);
    if (evaluator.cut_at_zero(pair)) ++cut;
    for (std::size_t c = 0; c < evaluator.channels(); ++c) {
      if (evaluator.value(pair, c) >= saturation) ++saturated;
    }
  }
  const auto warn = [&](std::size_t count, const std::string& what) {
    if (count > 0) std::cerr << fmt::format("{}: warning: {} {}\n", printable(source), count, what);
  };
  warn(saturated, "values exceed 1e300 and stand as that: the lobe of so smooth a surface is a mirror's");
  warn(cut,
       "directions where the functional form of rough is negative: it was cut at zero; forms rough integral has no "
       "such directions");
}

}  // namespace goniofit::cli
