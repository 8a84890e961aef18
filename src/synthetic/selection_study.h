#pragma once
// Does "auto" find the effects that a scan was made of? Random materials of every sensible set, and what is chosen.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "../brdf/material.h"
#include "verify.h"

namespace goniofit {

/// The set that a scan was made of, and the one chosen for it.
struct SelectionTrial {
  EffectSet truth, chosen;
  std::size_t draws = 0;  ///< materials drawn until one's effects all stood at five of their uncertainties
  std::string material;   ///< its parameters, in words
  std::optional<double> score_difference{};  ///< of the truth's score of left-out readings to the choice's, if any
  [[nodiscard]] bool right() const noexcept { return truth == chosen; }
  /// An effect of the truth is not among those chosen.
  [[nodiscard]] bool left_out() const noexcept;
};

struct SelectionStudy {
  std::vector<SelectionTrial> trials;
  std::size_t sets = 0;  ///< different truths among the trials
  [[nodiscard]] std::size_t right() const noexcept;
  [[nodiscard]] std::size_t left_out() const noexcept;
  /// At least 95 % right, and no effect ever left out.
  [[nodiscard]] bool passed() const noexcept;
};

/// `scans` scans with 2 % noise, the sets in turn: those of a dielectric and those of a metal that
/// sensible_components() allows with a mirror direction and wavelengths, both samplings, one channel and three. Random
/// materials are drawn until each effect stands at five of its standard uncertainties or more in the fit with the true
/// set: its coefficient in some channel, of coh sigma, of rough its slope as well. Threads across scans; the same for
/// any number of them. Throws Error (failed_result) where a set gives no such material in a hundred draws.
[[nodiscard]] SelectionStudy verify_selection(std::size_t scans, std::uint64_t seed, const Progress& progress = {});

}  // namespace goniofit
