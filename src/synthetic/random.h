#pragma once
// Random numbers that are a function of what they are for (seed, row, channel ...), never of the order in which they
// are drawn. The standard library's distributions differ between implementations, so the few that are needed stand
// here.

#include <cmath>
#include <cstdint>
#include <string_view>

#include "../geometry/angles.h"

namespace goniofit {

/// The finaliser of SplitMix64 (Steele, Lea & Flood 2014): a bijection of 64-bit words in which every input bit flips
/// every output bit with probability close to one half.
[[nodiscard]] constexpr std::uint64_t mix_bits(std::uint64_t x) noexcept {
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}

/// 2^64 / golden ratio: SplitMix64's step.
inline constexpr std::uint64_t golden_step = 0x9e3779b97f4a7c15ULL;

/// A key made of a key and one more coordinate; the order of the coordinates matters.
[[nodiscard]] constexpr std::uint64_t subkey(std::uint64_t key, std::uint64_t coordinate) noexcept {
  return mix_bits(mix_bits(key + golden_step) ^ (coordinate * golden_step));
}

/// FNV-1a.
[[nodiscard]] constexpr std::uint64_t subkey(std::uint64_t key, std::string_view name) noexcept {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return subkey(key, hash);
}

/// The stream that belongs to a key: SplitMix64 started there.
class RandomStream {
 public:
  explicit constexpr RandomStream(std::uint64_t key) noexcept : state_(key) {}

  [[nodiscard]] constexpr std::uint64_t bits() noexcept { return mix_bits(state_ += golden_step); }

  /// Uniform in the open interval (0, 1): the centres of 2^52 equal cells, so that a logarithm is always finite.
  [[nodiscard]] constexpr double uniform() noexcept { return (static_cast<double>(bits() >> 12U) + 0.5) * 0x1p-52; }
  [[nodiscard]] constexpr double uniform(double low, double high) noexcept { return low + (high - low) * uniform(); }
  [[nodiscard]] double log_uniform(double low, double high) noexcept {
    return low * std::exp(std::log(high / low) * uniform());
  }

  /// Standard normal (Box & Muller 1958; one of the pair, so that each call consumes exactly two words).
  [[nodiscard]] double gaussian() noexcept {
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    return radius * cos_deg(360.0 * uniform());
  }

 private:
  std::uint64_t state_;
};

}  // namespace goniofit
