#pragma once
// Radiances of channels as linear RGB of sRGB's primaries, and that as what a screen shows.

#include <array>
#include <optional>
#include <vector>

#include "../io/png_file.h"
#include "renderer.h"

namespace goniofit {

/// Weights of each channel in R, G and B: rgb = sum of weights[c] times radiance.
///
/// Channels named R, G, B (in any case), and three at .65, .55 and .45 um, are R, G and B themselves. Others with
/// wavelengths are integrated against the CIE 1931 observer by the analytic fit of Wyman, Sloan & Shirley ("Simple
/// analytic approximations to the CIE XYZ color matching functions", JCGT 2 (2), 2013), each standing for the
/// wavelengths nearer to it than to others; the whole is scaled so that a flat spectrum is white (1, 1, 1). A single
/// channel, and those of which neither is known, are a grey: their mean.
[[nodiscard]] std::vector<std::array<double, 3>> rgb_weights(const std::vector<SceneChannel>& channels);

/// Linear, [3 * pixel + channel]; a colour beyond the screen's has a component below 0.
[[nodiscard]] std::vector<double> linear_rgb(const Picture& picture);

/// Stops at which the 99th percentile of the lit pixels' luminance becomes 0.8; 0 for a black picture.
[[nodiscard]] double automatic_exposure(const std::vector<double>& rgb);

/// 2^stops times as bright, linear up to 0.75, from there bent towards white, then sRGB's curve.
[[nodiscard]] RgbPicture for_screen(const Picture& picture, const std::vector<double>& rgb, double stops);

}  // namespace goniofit
