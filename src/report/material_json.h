#pragma once
// Parts of a material as reports spell them in JSON: the names that material files use.

#include <nlohmann/json.hpp>

#include "../brdf/material.h"

namespace goniofit {

[[nodiscard]] inline nlohmann::ordered_json terms_json(const Terms& t) {
  return {{"fresnel", name_of(t.fresnel)},
          {"shadowing", name_of(t.shadowing)},
          {"effective_roughness", name_of(t.effective_roughness)},
          {"distribution", name_of(t.distribution)}};
}

}  // namespace goniofit
