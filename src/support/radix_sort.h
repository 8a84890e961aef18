#pragma once
// Stable sort of rows by unsigned keys, in time proportional to their number: least significant digit first.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace goniofit {

struct KeyedRow {
  std::uint64_t key;
  std::size_t row;
};

/// The order of numbers that are not negative, as a key.
[[nodiscard]] inline std::uint64_t key_of_size(double value) noexcept { return std::bit_cast<std::uint64_t>(value); }

/// By the key's bits from `first_bit` on; rows of which these are equal keep their order.
inline void radix_sort(std::vector<KeyedRow>& rows, unsigned first_bit = 0) {
  constexpr unsigned bits = 11;
  const unsigned digits = (64 - first_bit + bits - 1) / bits;
  constexpr std::size_t buckets = std::size_t{1} << bits;
  const auto digit = [first_bit](std::uint64_t key, unsigned d) {
    return (key >> (first_bit + d * bits)) & (buckets - 1);
  };
  std::vector<std::array<std::size_t, buckets>> counts(digits);
  for (const KeyedRow& r : rows) {
    for (unsigned d = 0; d < digits; ++d) ++counts[d][digit(r.key, d)];
  }
  std::vector<KeyedRow> sorted(rows.size());
  for (unsigned d = 0; d < digits; ++d) {
    std::array<std::size_t, buckets>& places = counts[d];
    if (rows.empty() || places[digit(rows.front().key, d)] == rows.size()) continue;  // all alike in this digit
    std::size_t place = 0;
    for (std::size_t& p : places) place += std::exchange(p, place);
    for (const KeyedRow& r : rows) sorted[places[digit(r.key, d)]++] = r;
    rows.swap(sorted);
  }
}

}  // namespace goniofit
