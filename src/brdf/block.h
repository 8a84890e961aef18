#pragma once
// What the kernels of a compiled material work on: up to 256 pairs at a time, so that everything between two loops
// stays in the first-level cache. Each loop does one thing for one tier; a material runs the loops that its effects
// need and no others.

#include <array>
#include <cstddef>
#include <cstdint>

#include "../geometry/pair.h"

namespace goniofit::block {

inline constexpr std::size_t size = 256;

/// Longer than a block by one vector: arrays of a power of two would lie at the same place of a page, and each load
/// wait for the store before it.
template <class Real>
using Array = std::array<Real, size + 16>;

/// The arrays of BasicPairBatch that kernels read, by the names they have there.
enum class Field : std::uint8_t {
  cos_i,
  cos_r,
  one_minus_cos_i,
  one_minus_cos_r,
  log_one_minus_cos_i,
  log_one_minus_cos_r,
  s_z,
  s_h2,
  cos_h,
  one_minus_cos_h,
  tan2_b,
  mirror_distance2,
  tan2_f,
  tan2_f_swapped,
  dot_h,
  s_x2,
  s_y2,
  cos2_phi_i,
  sin2_phi_i,
  cos2_phi_r,
  sin2_phi_r,
  forward
};
inline constexpr std::size_t field_count = 22;

class Fields {
 public:
  constexpr Fields() = default;
  constexpr Fields(std::initializer_list<Field> fields) {
    for (const Field f : fields) bits_ |= mask(f);
  }
  [[nodiscard]] constexpr bool has(Field f) const noexcept { return (bits_ & mask(f)) != 0; }
  [[nodiscard]] constexpr bool any_of(Fields other) const noexcept { return (bits_ & other.bits_) != 0; }
  constexpr Fields& operator|=(Fields other) noexcept {
    bits_ |= other.bits_;
    return *this;
  }

 private:
  [[nodiscard]] static constexpr std::uint32_t mask(Field f) noexcept { return 1U << static_cast<unsigned>(f); }
  std::uint32_t bits_ = 0;
};

/// Where each field of the block's pairs lies: in the caller's batch, or computed here. A field that nobody asked for
/// may be null.
template <class Real>
struct Geometry {
  std::array<const Real*, field_count> field{};

  [[nodiscard]] [[gnu::always_inline]] const Real* operator[](Field f) const noexcept {
    return field[static_cast<std::size_t>(f)];
  }
};

/// Results of the loops.
template <class Real>
struct alignas(64) Terms {
  Array<Real> shadowing;                ///< S / (cos_i cos_r)
  Array<Real> growth;                   ///< -2 ln(sigma_e/sigma)
  Array<Real> inverse_m_e2;             ///< (tau/sigma_e)²
  Array<Real> dd, fs;                   ///< shape factors
  Array<Real> fresnel;                  ///< F(u)
  Array<Real> transmission;             ///< T(cos_i) T(cos_r)
  Array<Real> direct, interreflection;  ///< of rough
  Array<Real> log_g, x, log_w;          ///< of wave optics
};

}  // namespace goniofit::block
