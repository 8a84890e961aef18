#pragma once
// The pairs of one block at a time, from either kind of batch, as the fields that a program reads.

#include <algorithm>
#include <array>

#include "../geometry/direction_batch.h"
#include "block_loops.h"

namespace goniofit::batch {

template <class Real>
using FieldArrays = std::array<block::Array<Real>, block::field_count>;

/// Loops run over whole vectors only, the last pair repeated where a batch ends within one: what is left over would be
/// computed by other instructions, and differ in its last digit.
[[nodiscard]] constexpr std::size_t whole_vectors(std::size_t n) noexcept {
  constexpr std::size_t lanes = 16;
  return (n + lanes - 1) / lanes * lanes;
}

/// A batch of pairs: its own arrays where the precision is the same (`room` is not used), else rounded copies.
template <class Real, class In>
class PairSource {
 public:
  PairSource(const BasicPairBatch<In>& pairs, block::Fields fields, InstructionSet /*set*/)
      : pairs_(pairs),
        fields_(fields),
        arrays_{&pairs.cos_i,
                &pairs.cos_r,
                &pairs.one_minus_cos_i,
                &pairs.one_minus_cos_r,
                &pairs.log_one_minus_cos_i,
                &pairs.log_one_minus_cos_r,
                &pairs.s_z,
                &pairs.s_h2,
                &pairs.cos_h,
                &pairs.one_minus_cos_h,
                &pairs.tan2_b,
                &pairs.mirror_distance2,
                &pairs.tan2_f,
                &pairs.tan2_f_swapped,
                &pairs.dot_h,
                &pairs.s_x2,
                &pairs.s_y2,
                &pairs.cos2_phi_i,
                &pairs.sin2_phi_i,
                &pairs.cos2_phi_r,
                &pairs.sin2_phi_r,
                &pairs.forward} {}

  [[nodiscard]] std::size_t size() const noexcept { return pairs_.size(); }
  [[nodiscard]] Pair pair(std::size_t i) const noexcept { return pairs_.template as<double>(i); }

  /// g for whole_vectors(n) pairs from `first` on.
  /// g for whole_vectors(n) pairs from `first` on.
  void prepare(std::size_t first, std::size_t n, FieldArrays<Real>& room, block::Geometry<Real>& g) const {
    for (std::size_t f = 0; f < block::field_count; ++f) {
      if (!fields_.has(static_cast<block::Field>(f))) continue;
      const In* const from = arrays_[f]->data() + first;
      if constexpr (std::is_same_v<Real, In>) {
        if (whole_vectors(n) == n) {
          g.field[f] = from;
          continue;
        }
      }
      constexpr In most = static_cast<In>(std::numeric_limits<Real>::max());
      for (std::size_t k = 0; k < n; ++k) room[f][k] = static_cast<Real>(from[k] < most ? from[k] : most);
      for (std::size_t k = n; k < whole_vectors(n); ++k) room[f][k] = room[f][n - 1];
      g.field[f] = room[f].data();
    }
  }

 private:
  const BasicPairBatch<In>& pairs_;
  block::Fields fields_;
  std::array<const std::vector<In>*, block::field_count> arrays_;
};

/// A batch of unit vectors: the geometry is computed.
template <class Real, class In>
class DirectionSource {
 public:
  DirectionSource(const BasicDirectionBatch<In>& d, block::Fields fields, InstructionSet set)
      : d_(d), loops_(block::preparations<Real, In>(fields, set)) {}

  [[nodiscard]] std::size_t size() const noexcept { return d_.size(); }
  [[nodiscard]] Pair pair(std::size_t i) const noexcept {
    return make_pair(Direction{d_.l_x[i], d_.l_y[i], d_.l_z[i]}, Direction{d_.v_x[i], d_.v_y[i], d_.v_z[i]});
  }

  /// g for whole_vectors(n) pairs from `first` on.
  void prepare(std::size_t first, std::size_t n, FieldArrays<Real>& room, block::Geometry<Real>& g) const {
    const std::array<const std::vector<In>*, 6> from{&d_.l_x, &d_.l_y, &d_.l_z, &d_.v_x, &d_.v_y, &d_.v_z};
    std::array<block::Array<In>, 6> padded;
    block::PrepareArguments<Real, In> a{{}, {}, whole_vectors(n)};
    for (std::size_t j = 0; j < from.size(); ++j) {
      a.direction[j] = from[j]->data() + first;
      if (a.n == n) continue;
      std::copy_n(a.direction[j], n, padded[j].begin());
      std::fill(padded[j].begin() + static_cast<std::ptrdiff_t>(n), padded[j].end(), padded[j][n - 1]);
      a.direction[j] = padded[j].data();
    }
    for (std::size_t f = 0; f < block::field_count; ++f) {
      a.field[f] = room[f].data();
      g.field[f] = room[f].data();
    }
    for (const auto loop : loops_) loop(a);
  }

 private:
  const BasicDirectionBatch<In>& d_;
  std::vector<block::Loop<block::PrepareArguments<Real, In>>> loops_;
};

}  // namespace goniofit::batch
