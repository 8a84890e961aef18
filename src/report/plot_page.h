#pragma once
// A page of panels for gnuplot, placed in pixels.

#include <cstddef>
#include <string>

namespace goniofit {

struct PlotPage {
  bool png = false;  ///< the same layout at a finer scale; else SVG
  double width = 0.0, height = 0.0;

  /// A font of so many pixels.
  [[nodiscard]] std::string font(double pixels) const;
  [[nodiscard]] std::string terminal() const;
  /// Where a panel lies: of its upper left corner from the page's, and its size.
  [[nodiscard]] std::string margins(double x, double y, double panel_width, double panel_height) const;
  /// A label fixed to the page; `more` are gnuplot's options.
  [[nodiscard]] std::string label(int tag, const std::string& text, double x, double y, const std::string& more) const;
};

/// Panels in rows below each other.
struct PanelGrid {
  std::size_t panels, columns;
  double panel_width, panel_height, gap_x, gap_y;
  double left, top, right, bottom;  ///< around all of them

  [[nodiscard]] std::size_t rows() const { return (panels + columns - 1) / columns; }
  [[nodiscard]] double x(std::size_t panel) const;
  [[nodiscard]] double y(std::size_t panel) const;
  [[nodiscard]] PlotPage page(bool png) const;
};

}  // namespace goniofit
