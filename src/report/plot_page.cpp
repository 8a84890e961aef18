#include "report/plot_page.h"

#include <fmt/format.h>

#include "report/gnuplot.h"

namespace goniofit {

namespace {
constexpr double plain_font = 13.0, png_scale = 1.75;
}

std::string PlotPage::font(double pixels) const {
  return fmt::format("sans-serif,{:.4g}", pixels * (png ? 0.75 : 1.0));  // pngcairo counts points, svg pixels
}

std::string PlotPage::terminal() const {
  const std::string start = "set encoding utf8\nset terminal ";
  if (!png) {
    return start + fmt::format("svg size {:.0f},{:.0f} font '{}' background '#FFFFFF' enhanced\n", width, height,
                               font(plain_font));
  }
  return start + fmt::format(
                     "pngcairo size {:.0f},{:.0f} font '{}' fontscale {} linewidth {} pointscale {} background "
                     "'#FFFFFF' enhanced\n",
                     png_scale * width, png_scale * height, font(plain_font), png_scale, png_scale, png_scale);
}

std::string PlotPage::margins(double x, double y, double panel_width, double panel_height) const {
  return fmt::format(
      "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\nset tmargin at screen {:.5f}\nset bmargin at screen "
      "{:.5f}\n",
      x / width, (x + panel_width) / width, 1.0 - y / height, 1.0 - (y + panel_height) / height);
}

std::string PlotPage::label(int tag, const std::string& text, double x, double y, const std::string& more) const {
  return fmt::format("set label {} {} at screen {:.5f},{:.5f} noenhanced {}\n", tag, gnuplot_quoted(text), x / width,
                     1.0 - y / height, more);
}

double PanelGrid::x(std::size_t panel) const {
  return left + static_cast<double>(panel % columns) * (panel_width + gap_x);
}

double PanelGrid::y(std::size_t panel) const {
  return top + static_cast<double>(panel / columns) * (panel_height + gap_y);
}

PlotPage PanelGrid::page(bool png) const {
  const auto across = static_cast<double>(columns);
  const auto down = static_cast<double>(rows());
  return {png, left + across * panel_width + (across - 1.0) * gap_x + right,
          top + down * panel_height + (down - 1.0) * gap_y + bottom};
}

}  // namespace goniofit
