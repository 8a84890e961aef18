#pragma once
// The random numbers of a render: a function of what they are for alone, so that neither threads nor what other paths
// did change them. Over the samples of a pixel each pair is a (0, 2)-sequence: Sobol's first two dimensions, scrambled
// after Owen by the hashes of Burley, "Practical hash-based Owen scrambling", JCGT 9 (4), 2020.

#include <array>
#include <cstdint>

namespace goniofit {

namespace pixel_samples {

[[nodiscard]] constexpr std::uint64_t mixed(std::uint64_t x) noexcept {  // SplitMix64's finaliser
  x ^= x >> 30U;
  x *= 0xbf58476d1ce4e5b9U;
  x ^= x >> 27U;
  x *= 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}
[[nodiscard]] constexpr std::uint64_t combined(std::uint64_t seed, std::uint64_t with) noexcept {
  return mixed(seed + 0x9e3779b97f4a7c15U * (with + 1));
}

[[nodiscard]] constexpr std::uint32_t reversed(std::uint32_t x) noexcept {
  x = __builtin_bswap32(x);
  x = ((x & 0x0f0f0f0fU) << 4U) | ((x >> 4U) & 0x0f0f0f0fU);
  x = ((x & 0x33333333U) << 2U) | ((x >> 2U) & 0x33333333U);
  return ((x & 0x55555555U) << 1U) | ((x >> 1U) & 0x55555555U);
}

/// Each bit of the result is flipped by what lies above it in `x`, read from the top: Laine & Karras' hash, run
/// backwards.
[[nodiscard]] constexpr std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) noexcept {
  x = reversed(x);
  x += seed;
  x ^= x * 0x6c50b47cU;
  x ^= x * 0xb82f1e52U;
  x ^= x * 0xc7afe638U;
  x ^= x * 0x8d22f6e6U;
  return reversed(x);
}

/// Sobol's second dimension: its matrix is Pascal's triangle modulo 2, whose entry (i, j) is 1 where the bits of i are
/// among those of j (Lucas), so that the product is five steps of a sum over supersets.
[[nodiscard]] constexpr std::uint32_t sobol_second(std::uint32_t n) noexcept {
  n ^= (n & 0xaaaaaaaaU) >> 1U;
  n ^= (n & 0xccccccccU) >> 2U;
  n ^= (n & 0xf0f0f0f0U) >> 4U;
  n ^= (n & 0xff00ff00U) >> 8U;
  n ^= (n & 0xffff0000U) >> 16U;
  return reversed(n);
}

/// In [0, 1).
[[nodiscard]] constexpr double unit(std::uint32_t x) noexcept { return static_cast<double>(x) * 0x1p-32; }

}  // namespace pixel_samples

/// Two numbers in [0, 1): point `sample` of the sequence that `key` names.
[[nodiscard]] constexpr std::array<double, 2> sample_pair(std::uint64_t key, std::uint32_t sample) noexcept {
  using namespace pixel_samples;
  const std::uint64_t hash = mixed(key);
  const auto order = static_cast<std::uint32_t>(mixed(hash + 1));
  const std::uint32_t n = scrambled(sample, order);
  return {unit(scrambled(reversed(n), static_cast<std::uint32_t>(hash))),
          unit(scrambled(sobol_second(n), static_cast<std::uint32_t>(hash >> 32U)))};
}

}  // namespace goniofit
