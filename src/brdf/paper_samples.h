#pragma once
// The four samples of Li & Torrance 2005, as its tables give them: what the program and its tests measure themselves by
// where no file is given.

#include <array>

#include "material.h"

namespace goniofit {

[[nodiscard]] Material garnet_red_paint_13();
[[nodiscard]] Material laser_paper_73();
/// Ground glass with an aluminium film.
[[nodiscard]] Material ground_glass_41();
/// A smooth surface with an aluminium film, at 0.55 um.
[[nodiscard]] Material smooth_aluminium_45();

[[nodiscard]] std::array<Material, 4> paper_samples();

/// A surface of that RMS height and correlation length.
[[nodiscard]] Surface rough_surface(double sigma_um, double tau_um);

}  // namespace goniofit
