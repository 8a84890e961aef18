#pragma once
// Of a scan with many channels, those that tell most.

#include <cstddef>
#include <vector>

#include "../scan/scan.h"
#include "settings.h"

namespace goniofit {

/// At most `most` channels, in the scan's order: the first pivots of a QR decomposition with column pivoting over the
/// readings, each divided by its mean over the channels. What the others show is then most nearly a mixture of what
/// these do.
[[nodiscard]] std::vector<std::size_t> telling_channels(const Scan& scan, std::size_t most);

/// The scan's channels of these indices, and the settings that go with them.
[[nodiscard]] Scan with_channels(const Scan& scan, const std::vector<std::size_t>& channels);
[[nodiscard]] FitSettings with_channels(const FitSettings& settings, const Scan& scan,
                                        const std::vector<std::size_t>& channels);

}  // namespace goniofit
