#include "brdf/block_loops.h"
#include "geometry/direction.h"
#include "support/lane_math.h"
#include "support/vectorised.h"

// The formulas of make_pair(Direction, Direction), which says why they are these; branch-free.

namespace goniofit::block {

namespace {

template <class In>
constexpr In horizon = std::is_same_v<In, float> ? In(1e-18) : In(least_cosine);

template <class In>
struct Vectors {
  In l_x, l_y, l_z, v_x, v_y, v_z;

  [[gnu::always_inline]] static Vectors at(const std::array<const In*, 6>& d, std::size_t k) {
    return {d[0][k], d[1][k], off_the_horizon(d[2][k]), d[3][k], d[4][k], off_the_horizon(d[5][k])};
  }

 private:
  [[gnu::always_inline]] static In off_the_horizon(In z) {
    const In raised = z < horizon<In> ? horizon<In> : z;
    return z > In(0) ? raised : z;
  }
};

template <class In>
[[gnu::always_inline]] inline In square(In x) {
  return x * x;
}

template <class In>
[[gnu::always_inline]] inline In cosine_to_half(In h2, In z) {
  return lane::at_most(In(1), In(0.5) * std::sqrt(h2 + square(z)));
}
template <class In>
[[gnu::always_inline]] inline In difference2(const Vectors<In>& d) {
  return square(d.l_x - d.v_x) + square(d.l_y - d.v_y) + square(d.l_z - d.v_z);
}

template <class Real, class In, bool half>
struct Sum {
  using Arguments = PrepareArguments<Real, In>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    const auto direction = a.direction;
    Real* const cos_i = a[Field::cos_i];
    Real* const cos_r = a[Field::cos_r];
    Real* const s_z = a[Field::s_z];
    Real* const s_h2 = a[Field::s_h2];
    Real* const tan2_b = a[Field::tan2_b];
    [[maybe_unused]] Real* const cos_h = a[Field::cos_h];
    [[maybe_unused]] Real* const rest_h = a[Field::one_minus_cos_h];
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      const auto d = Vectors<In>::at(direction, k);
      const In z = d.l_z + d.v_z;
      const In h2 = square(d.l_x + d.v_x) + square(d.l_y + d.v_y);
      cos_i[k] = static_cast<Real>(d.l_z);
      cos_r[k] = static_cast<Real>(d.v_z);
      s_z[k] = static_cast<Real>(z);
      s_h2[k] = static_cast<Real>(h2);
      if constexpr (half) {
        const In u = cosine_to_half(h2, z);
        const In up_h = In(1) + u;
        const In over_all = In(1) / (up_h * square(z));
        tan2_b[k] = static_cast<Real>(h2 * up_h * over_all);
        cos_h[k] = static_cast<Real>(u);
        rest_h[k] = static_cast<Real>(difference2(d) * In(0.25) * square(z) * over_all);
      } else {
        tan2_b[k] = static_cast<Real>(h2 / square(z));
      }
    }
  }
};

// The same beside the zenith angles' parts: one quotient for all of a loop, since the divider
// is what they wait for; near the horizon 1 - z as it stands.
template <class Real, class In, bool logarithms, bool sums, bool half>
struct Zenith {
  using Arguments = PrepareArguments<Real, In>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    const auto direction = a.direction;
    Real* const cos_i = a[Field::cos_i];
    Real* const cos_r = a[Field::cos_r];
    [[maybe_unused]] Real* const s_z = a[Field::s_z];
    [[maybe_unused]] Real* const s_h2 = a[Field::s_h2];
    Real* const tan2_b = a[Field::tan2_b];
    Real* const rest_i = a[Field::one_minus_cos_i];
    Real* const rest_r = a[Field::one_minus_cos_r];
    Real* const log_i = a[Field::log_one_minus_cos_i];
    Real* const log_r = a[Field::log_one_minus_cos_r];
    [[maybe_unused]] Real* const cos_h = a[Field::cos_h];
    [[maybe_unused]] Real* const rest_h = a[Field::one_minus_cos_h];
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      const auto d = Vectors<In>::at(direction, k);
      const In z = d.l_z + d.v_z;
      const In h2 = square(d.l_x + d.v_x) + square(d.l_y + d.v_y);
      const In up_i = In(1) + d.l_z;
      const In up_r = In(1) + d.v_z;
      const In ups = up_i * up_r;
      const In u = half ? cosine_to_half(h2, z) : In(0);
      const In up_h = In(1) + u;
      const In over_all = In(1) / (ups * up_h * square(z));
      const In over_z2 = ups * up_h * over_all;
      const In near = up_h * square(z) * over_all;
      if constexpr (half) {
        cos_h[k] = static_cast<Real>(u);
        rest_h[k] = static_cast<Real>(difference2(d) * In(0.25) * ups * square(z) * over_all);
      }
      const In near_i = (square(d.l_x) + square(d.l_y)) * up_r * near;
      const In near_r = (square(d.v_x) + square(d.v_y)) * up_i * near;
      const In i = d.l_z > In(0.5) ? near_i : In(1) - d.l_z;
      const In r = d.v_z > In(0.5) ? near_r : In(1) - d.v_z;
      cos_i[k] = static_cast<Real>(d.l_z);
      cos_r[k] = static_cast<Real>(d.v_z);
      if constexpr (sums) {
        s_z[k] = static_cast<Real>(z);
        s_h2[k] = static_cast<Real>(h2);
      }
      tan2_b[k] = static_cast<Real>(h2 * over_z2);
      rest_i[k] = static_cast<Real>(i);
      rest_r[k] = static_cast<Real>(r);
    }
    // Loops of their own: in one body, a processor waits for the end of a long chain before it has room for the next.
    if constexpr (logarithms) {
      logarithm(rest_i, cos_i, log_i, n);
      logarithm(rest_r, cos_r, log_r, n);
    }
  }

 private:
  [[gnu::always_inline]] static void logarithm(const Real* rest, const Real* cos, Real* log, std::size_t n) {
    constexpr Real least = std::numeric_limits<Real>::min();
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      const Real of_rest = lane::log(rest[k], -cos[k]);
      log[k] = rest[k] >= least ? of_rest : Real(log_of_zero);
    }
  }
};

template <class Real, class In, bool both_orders>
struct Forward {
  using Arguments = PrepareArguments<Real, In>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    const auto direction = a.direction;
    Real* const tan2 = a[Field::tan2_f];
    [[maybe_unused]] Real* const swapped = a[Field::tan2_f_swapped];
    Real* const forward = a[Field::forward];
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      const auto d = Vectors<In>::at(direction, k);
      const In along = d.l_x * d.v_x + d.l_y * d.v_y;
      const In along2 = square(along);
      const In across2 = square(d.l_x * d.v_y - d.l_y * d.v_x);
      const bool is_forward = (along < In(0)) & (along2 > In(0));
      const In below = In(1) / (is_forward ? along2 : In(1));
      const In t = (square(d.v_z) * (square(d.l_x) + square(d.l_y)) + across2) * below;
      // What no Real holds is as good as infinite: the lobe is nothing there.
      constexpr In most = static_cast<In>(std::numeric_limits<Real>::max());
      tan2[k] = static_cast<Real>(is_forward ? lane::at_most(most, t) : In(0));
      if constexpr (both_orders) {
        const In s = (square(d.l_z) * (square(d.v_x) + square(d.v_y)) + across2) * below;
        swapped[k] = static_cast<Real>(is_forward ? lane::at_most(most, s) : In(0));
      }
      forward[k] = is_forward ? Real(1) : Real(0);
    }
  }
};

template <class Real, class In>
struct Along {
  using Arguments = PrepareArguments<Real, In>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    const auto direction = a.direction;
    Real* const dot_h = a[Field::dot_h];
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      const auto d = Vectors<In>::at(direction, k);
      dot_h[k] = static_cast<Real>(d.l_x * d.v_x + d.l_y * d.v_y);
    }
  }
};

template <class Real, class In>
struct Mirror {
  using Arguments = PrepareArguments<Real, In>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    const auto direction = a.direction;
    Real* const distance2 = a[Field::mirror_distance2];
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      const auto d = Vectors<In>::at(direction, k);
      distance2[k] = static_cast<Real>(square(d.l_x + d.v_x) + square(d.l_y + d.v_y) + square(d.v_z - d.l_z));
    }
  }
};

template <class Real, class In, bool half>
Loop<PrepareArguments<Real, In>> zenith(Fields fields, bool sums, InstructionSet set) {
  using enum Field;
  if (fields.any_of({log_one_minus_cos_i, log_one_minus_cos_r})) {
    return sums ? Vectorised<Zenith<Real, In, true, true, half>>::of(set)
                : Vectorised<Zenith<Real, In, true, false, half>>::of(set);
  }
  if (fields.any_of({one_minus_cos_i, one_minus_cos_r})) {
    return sums ? Vectorised<Zenith<Real, In, false, true, half>>::of(set)
                : Vectorised<Zenith<Real, In, false, false, half>>::of(set);
  }
  return Vectorised<Sum<Real, In, half>>::of(set);
}

}  // namespace

template <class Real, class In>
std::vector<Loop<PrepareArguments<Real, In>>> preparations(Fields fields, InstructionSet set) {
  using enum Field;
  std::vector<Loop<PrepareArguments<Real, In>>> loops;
  const bool sums = fields.any_of({s_z, s_h2});
  if (fields.any_of({cos_h, one_minus_cos_h})) {
    loops.push_back(zenith<Real, In, true>(fields, sums, set));
  } else {
    loops.push_back(zenith<Real, In, false>(fields, sums, set));
  }
  if (fields.has(tan2_f_swapped)) {
    loops.push_back(Vectorised<Forward<Real, In, true>>::of(set));
  } else if (fields.any_of({tan2_f, forward})) {
    loops.push_back(Vectorised<Forward<Real, In, false>>::of(set));
  }
  if (fields.has(dot_h)) loops.push_back(Vectorised<Along<Real, In>>::of(set));
  if (fields.has(mirror_distance2)) loops.push_back(Vectorised<Mirror<Real, In>>::of(set));
  return loops;
}

template std::vector<Loop<PrepareArguments<double, double>>> preparations(Fields, InstructionSet);
template std::vector<Loop<PrepareArguments<float, float>>> preparations(Fields, InstructionSet);
template std::vector<Loop<PrepareArguments<float, double>>> preparations(Fields, InstructionSet);

}  // namespace goniofit::block
