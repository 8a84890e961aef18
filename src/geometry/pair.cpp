#include "geometry/pair.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/pair_of_angles.h"

namespace goniofit {

AnglePair in_plane(double theta_i_deg, double signed_theta_r_deg) noexcept {
  return {theta_i_deg, 0.0, std::fabs(signed_theta_r_deg), signed_theta_r_deg < 0.0 ? 0.0 : 180.0};
}

AnglePair swapped(const AnglePair& angles) noexcept {
  return {angles.theta_r_deg, angles.phi_r_deg, angles.theta_i_deg, angles.phi_i_deg};
}

namespace {

// An array of the batch and what a pair has for it, in the order of pair_arrays.
template <class Real>
struct Field {
  std::vector<Real> BasicPairBatch<Real>::*array;
  double Pair::*member;
};

template <class Real>
constexpr std::array fields{
    Field<Real>{&BasicPairBatch<Real>::cos_i, &Pair::cos_i},
    Field<Real>{&BasicPairBatch<Real>::cos_r, &Pair::cos_r},
    Field<Real>{&BasicPairBatch<Real>::one_minus_cos_i, &Pair::one_minus_cos_i},
    Field<Real>{&BasicPairBatch<Real>::one_minus_cos_r, &Pair::one_minus_cos_r},
    Field<Real>{&BasicPairBatch<Real>::log_one_minus_cos_i, &Pair::log_one_minus_cos_i},
    Field<Real>{&BasicPairBatch<Real>::log_one_minus_cos_r, &Pair::log_one_minus_cos_r},
    Field<Real>{&BasicPairBatch<Real>::s_z, &Pair::s_z},
    Field<Real>{&BasicPairBatch<Real>::s_h2, &Pair::s_h2},
    Field<Real>{&BasicPairBatch<Real>::cos_h, &Pair::cos_h},
    Field<Real>{&BasicPairBatch<Real>::one_minus_cos_h, &Pair::one_minus_cos_h},
    Field<Real>{&BasicPairBatch<Real>::tan2_b, &Pair::tan2_b},
    Field<Real>{&BasicPairBatch<Real>::mirror_distance2, &Pair::mirror_distance2},
    Field<Real>{&BasicPairBatch<Real>::tan2_f, &Pair::tan2_f},
    Field<Real>{&BasicPairBatch<Real>::tan2_f_swapped, &Pair::tan2_f_swapped},
    Field<Real>{&BasicPairBatch<Real>::dot_h, &Pair::dot_h},
    Field<Real>{&BasicPairBatch<Real>::s_x2, &Pair::s_x2},
    Field<Real>{&BasicPairBatch<Real>::s_y2, &Pair::s_y2},
    Field<Real>{&BasicPairBatch<Real>::cos2_phi_i, &Pair::cos2_phi_i},
    Field<Real>{&BasicPairBatch<Real>::sin2_phi_i, &Pair::sin2_phi_i},
    Field<Real>{&BasicPairBatch<Real>::cos2_phi_r, &Pair::cos2_phi_r},
    Field<Real>{&BasicPairBatch<Real>::sin2_phi_r, &Pair::sin2_phi_r},
};

}  // namespace

template <class Real>
BasicPairBatch<Real>::BasicPairBatch(const std::vector<AnglePair>& angles) {
  // Block by block, since a vector cannot grow without writing zeros: those stay in the first-level cache.
  constexpr std::size_t block = 256;
  reserve(angles.size());
  for (std::size_t first = 0; first < angles.size(); first += block) {
    const std::size_t end = std::min(first + block, angles.size());
    std::array<Real*, pair_arrays> to{};
    const auto grow = [&](std::vector<Real>& array) {
      array.resize(end);
      return array.data() + first;
    };
    for (std::size_t k = 0; k < fields<Real>.size(); ++k) to[k] = grow(this->*fields<Real>[k].array);
    to.back() = grow(forward);
    fill_arrays<Real>(std::span(angles).subspan(first, end - first), to);
  }
}

template <class Real>
template <class Other>
BasicPairBatch<Real>::BasicPairBatch(const BasicPairBatch<Other>& other) {
  reserve(other.size());
  for (std::size_t i = 0; i < other.size(); ++i) push_back(other.template as<double>(i));
}

template <class Real>
void BasicPairBatch<Real>::reserve(std::size_t n) {
  for (const Field<Real>& f : fields<Real>) (this->*f.array).reserve(n);
  forward.reserve(n);
}

template <class Real>
void BasicPairBatch<Real>::push_back(const Pair& p) {
  for (const Field<Real>& f : fields<Real>) (this->*f.array).push_back(static_cast<Real>(p.*f.member));
  forward.push_back(p.forward ? Real(1) : Real(0));
}

template <class Real>
BasicPairBatch<Real> BasicPairBatch<Real>::subset(const std::vector<std::size_t>& rows) const {
  BasicPairBatch out;
  out.reserve(rows.size());
  for (const std::size_t row : rows) out.push_back(as<double>(row));
  return out;
}

template class BasicPairBatch<double>;
template class BasicPairBatch<float>;
template BasicPairBatch<float>::BasicPairBatch(const BasicPairBatch<double>&);
template BasicPairBatch<double>::BasicPairBatch(const BasicPairBatch<float>&);

}  // namespace goniofit
