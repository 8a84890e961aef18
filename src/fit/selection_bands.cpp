#include "fit/selection_bands.h"

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace goniofit {

namespace {

// As many values as there are channels, or not one a channel: that one value may be meant, or that it is an error, the
// problem finds.
std::vector<double> picked(const std::vector<double>& values, std::size_t all,
                           const std::vector<std::size_t>& channels) {
  if (values.size() != all) return values;
  std::vector<double> some;
  for (const std::size_t c : channels) some.push_back(values[c]);
  return some;
}

}  // namespace

std::vector<std::size_t> telling_channels(const Scan& scan, std::size_t most) {
  std::vector<std::size_t> chosen(scan.channels.size());
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  if (chosen.size() <= most) return chosen;
  const auto n = static_cast<Eigen::Index>(scan.size());
  Eigen::MatrixXd values(n, static_cast<Eigen::Index>(scan.channels.size()));
  for (Eigen::Index c = 0; c < values.cols(); ++c) {
    values.col(c) = Eigen::Map<const Eigen::VectorXd>(scan.channels[static_cast<std::size_t>(c)].values.data(), n);
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const double mean = values.row(i).cwiseAbs().mean();
    if (mean > 0.0) values.row(i) /= mean;
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(values);
  chosen.clear();
  for (std::size_t k = 0; k < most; ++k) {
    chosen.push_back(static_cast<std::size_t>(qr.colsPermutation().indices()[static_cast<Eigen::Index>(k)]));
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

Scan with_channels(const Scan& scan, const std::vector<std::size_t>& channels) {
  Scan some = scan;
  some.channels.clear();
  for (const std::size_t c : channels) some.channels.push_back(scan.channels[c]);
  return some;
}

FitSettings with_channels(const FitSettings& settings, const Scan& scan, const std::vector<std::size_t>& channels) {
  FitSettings some = settings;
  some.n = picked(settings.n, scan.channels.size(), channels);
  some.kappa = picked(settings.kappa, scan.channels.size(), channels);
  some.f0 = picked(settings.f0, scan.channels.size(), channels);
  for (std::size_t c = 0; c < scan.channels.size(); ++c) {
    if (std::find(channels.begin(), channels.end(), c) != channels.end()) continue;
    std::erase_if(some.parameters,
                  [&](const auto& entry) { return entry.first.starts_with(scan.channels[c].name + "."); });
  }
  return some;
}

}  // namespace goniofit
