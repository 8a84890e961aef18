#pragma once
// In-plane BRDF against theta_r: measured dots and fitted curves per incidence angle, one panel a channel, as the
// paper's figures 12, 15 and 17. Drawn by gnuplot.

#include <cstdint>
#include <filesystem>

#include "../brdf/material.h"
#include "../scan/scan.h"

namespace goniofit {

enum class PlotAxis : std::uint8_t { automatic, linear, log };

struct PlotOptions {
  PlotAxis axis = PlotAxis::automatic;  ///< automatic: log where the in-plane readings span more than a factor 30
  std::size_t max_panels = 6;           ///< more channels than this: evenly chosen ones, and the subtitle says so
  std::size_t max_incidences = 8;
};

/// What plot_fit will refuse, to be known before a long fit: throws Error (bad_input) for an extension that is neither
/// .svg nor .png and for a scan without readings near the plane of incidence.
void check_plot(const std::filesystem::path& path, const Scan& scan, const PlotOptions& options = {});

/// Writes `path` as SVG or PNG by its extension. `material` has the scan's channels. Readings out of the plane of
/// incidence are not drawn; where a scan has none in it, those nearest to it are, and the subtitle says so. Throws
/// Error: system where gnuplot is missing or fails, bad_input for another extension, other channels or a scan without
/// readings near the plane of incidence.
void plot_fit(const std::filesystem::path& path, const Scan& scan, const Material& material,
              const PlotOptions& options = {});

}  // namespace goniofit
