#include "cli/render_comparison.h"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cost/timing.h"
#include "report/number_text.h"

namespace goniofit::cli {

namespace {

constexpr std::size_t rounds = 3;

Spread spread_of(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {median_of(values), *least, *most};
}

Spread ratio_of(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / b[i]);
  return spread_of(ratios);
}

std::string spread_text(const Spread& s, const char* unit) {
  return fmt::format("{:.3g}{} ({:.3g} to {:.3g})", s.median, unit, s.min, s.max);
}

nlohmann::ordered_json spread_json(const Spread& s) { return {{"median", s.median}, {"min", s.min}, {"max", s.max}}; }

nlohmann::ordered_json difference_json(const PictureDifference& d) {
  return {{"rms_relative", d.rms_relative},
          {"max_relative", d.max_relative},
          {"mean_relative", d.mean_relative},
          {"lit", d.lit}};
}

}  // namespace

RenderComparison compare_renders(const Scene& scene, const ScenePlan& plan, std::size_t threads,
                                 const std::function<void(const std::string&)>& tell) {
  struct Way {
    const char* name;
    Scene scene;
    std::vector<RenderMaterial> materials;
    std::vector<double> seconds{};
    Rendering last{};
  };
  std::array<Way, 3> ways{Way{"by the plan", planned_scene(scene, plan), plan.planned},
                          Way{"with all effects", scene, plan.exact},
                          Way{"as published", scene, published_materials(scene)}};
  for (std::size_t round = 0; round < rounds; ++round) {
    for (Way& way : ways) {
      tell(fmt::format("round {} of {}: {}", round + 1, rounds, way.name));
      way.last = render(way.scene, way.materials, {.threads = threads});
      way.seconds.push_back(way.last.preparation_s + way.last.seconds);
    }
  }
  auto& [planned, exact, published] = ways;
  RenderComparison c;
  c.difference = picture_difference(exact.last.picture, planned.last.picture);
  c.published = picture_difference(exact.last.picture, published.last.picture);
  c.seconds = spread_of(planned.seconds);
  c.exact_seconds = spread_of(exact.seconds);
  c.published_seconds = spread_of(published.seconds);
  c.exact_ratio = ratio_of(exact.seconds, planned.seconds);
  c.published_ratio = ratio_of(published.seconds, planned.seconds);
  c.picture = std::move(planned.last.picture);
  c.work = planned.last.work;
  return c;
}

std::string comparison_text(const RenderComparison& c) {
  return fmt::format(
      "measured over {} rounds in turn:\n"
      "  by the plan           {}\n"
      "  all effects, exact    {}, {} as long; the plan's picture differs by {} RMS of lit values, {} at most, {} of "
      "all light\n"
      "  Li & Torrance's terms {}, {} as long; its picture differs by {} RMS, {} at most, {} of all light\n",
      rounds, spread_text(c.seconds, " s"), spread_text(c.exact_seconds, " s"), spread_text(c.exact_ratio, " x"),
      percent_text(c.difference.rms_relative), percent_text(c.difference.max_relative),
      percent_text(c.difference.mean_relative), spread_text(c.published_seconds, " s"),
      spread_text(c.published_ratio, " x"), percent_text(c.published.rms_relative),
      percent_text(c.published.max_relative), percent_text(c.published.mean_relative));
}

std::string comparison_json(const RenderComparison& c) {
  const nlohmann::ordered_json out{{"rounds", rounds},
                                   {"seconds", spread_json(c.seconds)},
                                   {"all_effects_seconds", spread_json(c.exact_seconds)},
                                   {"published_seconds", spread_json(c.published_seconds)},
                                   {"all_effects_ratio", spread_json(c.exact_ratio)},
                                   {"published_ratio", spread_json(c.published_ratio)},
                                   {"difference", difference_json(c.difference)},
                                   {"published_difference", difference_json(c.published)}};
  return out.dump(2);
}

}  // namespace goniofit::cli
