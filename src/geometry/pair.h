#pragma once
// Everything about a pair of directions L (to the light) and V (to the viewer) that the reflectance terms read,
// computed once, each in the form that stays accurate at normal incidence, at grazing, at the mirror and at the retro
// direction.
//
// N = +z. Both vectors point away from the surface; s = L + V. A mirror reflection has phi_r = phi_i + 180°.

#include <cstddef>
#include <vector>

namespace goniofit {

/// The four angles of one reading, in degrees. theta in [0, 90], any azimuth.
struct AnglePair {
  double theta_i_deg = 0.0;
  double phi_i_deg = 0.0;
  double theta_r_deg = 0.0;
  double phi_r_deg = 0.0;
};

/// The incidence-plane convention of scans: signed theta_r, positive on the forward (mirror) side, phi_i = 0.
[[nodiscard]] AnglePair in_plane(double theta_i_deg, double signed_theta_r_deg) noexcept;

/// Real is double in the program and a 50-digit float in the tests.
template <class Real>
struct BasicPair {
  Real cos_i, cos_r;  ///< a direction with cos <= 0 is outside the domain
  Real one_minus_cos_i, one_minus_cos_r;
  Real log_one_minus_cos_i;  ///< ln(1 - cos); `log_of_zero` at the normal
  Real log_one_minus_cos_r;
  Real s_z;    ///< cos_i + cos_r
  Real s_h2;   ///< s_x² + s_y²
  Real cos_h;  ///< u, the cosine between H = s/|s| and V
  Real one_minus_cos_h;
  Real tan2_b;            ///< tan² of the angle between H and N: s_h2 / s_z²
  Real mirror_distance2;  ///< |V - mirror(L)|²
  Real tan2_f;            ///< LT's theta_f for fs; meaningful where forward
  Real tan2_f_swapped;    ///< the same with L and V exchanged
  Real dot_h;             ///< L_h · V_h of the horizontal parts: positive on the retro side
  // What an anisotropic surface reads besides, in its own frame (x is azimuth 0).
  Real s_x2, s_y2;              ///< s_x², s_y², each to the accuracy of their sum
  Real cos2_phi_i, sin2_phi_i;  ///< of the azimuth of L
  Real cos2_phi_r, sin2_phi_r;  ///< of the azimuth of V
  bool forward;                 ///< cos theta_f > 0: V on the mirror side of the plane through N normal to L_h
};

/// ln 0, written as a finite number: exp(q * log_of_zero) is exactly 0 for every q >= 0.1 and its derivative is 0
/// rather than 0 * infinity. No direction other than the normal itself comes near it (ln of the smallest double is
/// -745).
inline constexpr double log_of_zero = -1.0e5;

using Pair = BasicPair<double>;

/// Errors: none; angles outside [0, 90] give cosines <= 0, which evaluators answer with 0.
[[nodiscard]] Pair make_pair(const AnglePair& angles) noexcept;

/// The pair with L and V exchanged.
[[nodiscard]] AnglePair swapped(const AnglePair& angles) noexcept;

/// Many pairs in structure-of-arrays, for the batch kernels. All arrays have the same length. Real is double, or float
/// for kernels in single precision: each number is then the nearest to the one computed in double.
template <class Real>
class BasicPairBatch {
 public:
  BasicPairBatch() = default;
  explicit BasicPairBatch(const std::vector<AnglePair>& angles);
  /// Rounds, or widens, another batch.
  template <class Other>
  explicit BasicPairBatch(const BasicPairBatch<Other>& other);

  void push_back(const Pair& pair);
  void reserve(std::size_t n);
  [[nodiscard]] std::size_t size() const noexcept { return cos_i.size(); }
  /// Inline: the batch kernels read through it, and what they do not use costs nothing. T is Real or made of it.
  template <class T>
  [[nodiscard]] [[gnu::always_inline]] inline BasicPair<T> as(std::size_t i) const noexcept {
    return {T(cos_i[i]),
            T(cos_r[i]),
            T(one_minus_cos_i[i]),
            T(one_minus_cos_r[i]),
            T(log_one_minus_cos_i[i]),
            T(log_one_minus_cos_r[i]),
            T(s_z[i]),
            T(s_h2[i]),
            T(cos_h[i]),
            T(one_minus_cos_h[i]),
            T(tan2_b[i]),
            T(mirror_distance2[i]),
            T(tan2_f[i]),
            T(tan2_f_swapped[i]),
            T(dot_h[i]),
            T(s_x2[i]),
            T(s_y2[i]),
            T(cos2_phi_i[i]),
            T(sin2_phi_i[i]),
            T(cos2_phi_r[i]),
            T(sin2_phi_r[i]),
            forward[i] != Real(0)};
  }
  [[nodiscard]] [[gnu::always_inline]] inline BasicPair<Real> operator[](std::size_t i) const noexcept {
    return as<Real>(i);
  }
  [[nodiscard]] BasicPairBatch subset(const std::vector<std::size_t>& rows) const;

  std::vector<Real> cos_i, cos_r, one_minus_cos_i, one_minus_cos_r, log_one_minus_cos_i, log_one_minus_cos_r, s_z, s_h2,
      cos_h, one_minus_cos_h, tan2_b, mirror_distance2, tan2_f, tan2_f_swapped, dot_h, s_x2, s_y2, cos2_phi_i,
      sin2_phi_i, cos2_phi_r, sin2_phi_r;
  std::vector<Real> forward;  ///< 1 or 0
};

using PairBatch = BasicPairBatch<double>;
using FloatPairBatch = BasicPairBatch<float>;

}  // namespace goniofit
