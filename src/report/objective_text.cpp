#include "report/objective_text.h"

#include <fmt/format.h>

#include "fit/loss.h"

namespace goniofit {

namespace {

std::string squares_text(Loss loss) {
  switch (loss) {
    case Loss::inverse_variance:
      return "((f_model − f_measured)/u)²";
    case Loss::relative:
      return fmt::format("((f_model − f_measured)/max(|f_measured|, {:g} sr⁻¹))²", relative_floor);
    case Loss::log1p:
      return "(ln(1 + f_model) − ln(1 + f_measured))²";
    case Loss::cube_root:
      return "(∛f_model − ∛f_measured)²";
    case Loss::cosine_l2:
      break;
  }
  return "(f_model − f_measured)²";
}

}  // namespace

bool is_published(const FitResult& result) {
  return result.objective.loss == Loss::cosine_l2 && result.objective.robust == RobustKernel::none &&
         result.weight == Weight::cosine && result.reflectances == 0;
}

std::string objective_text(const FitResult& result) {
  std::string text = "Σ ";
  if (has_cosine(result.weight)) text += "cos θᵢ ";
  if (has_solid_angle(result.weight)) text += "ΔΩ ";
  text += squares_text(result.objective.loss) + ", over samples and channels";
  if (result.objective.robust != RobustKernel::none) {
    text += fmt::format("; larger residuals than {:.3g} count for less ({})", result.objective.robust_scale,
                        name_of(result.objective.robust));
  }
  return text;
}

std::string samples_text(const FitResult& result, const Scan& scan) {
  const Exclusions& out = result.left_out;
  std::string text = fmt::format("{} of {} used", result.samples, scan.size());
  if (out.at_90 > 0) text += fmt::format("; {} left out at θ = 90°", out.at_90);
  if (out.beyond_max_theta > 0)
    text += fmt::format("; {} left out beyond the largest θ asked for", out.beyond_max_theta);
  if (out.retro_cone > 0) text += fmt::format("; {} left out about the retro direction", out.retro_cone);
  if (out.saturated_values > 0) text += fmt::format("; {} saturated values left out", out.saturated_values);
  if (out.clamped_values > 0) text += fmt::format("; {} values of 0 left out", out.clamped_values);
  if (result.reflectances > 0) text += fmt::format("; {} reflectances beside them", result.reflectances);
  return text;
}

}  // namespace goniofit
