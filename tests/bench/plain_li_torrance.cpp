#include "plain_li_torrance.h"

#include <cmath>
#include <numbers>

namespace goniofit::bench {

double plain_li_torrance(const PlainMaterial& m, const Direction& l, const Direction& v) {
  if (l.z <= 0.0 || v.z <= 0.0) return 0.0;
  const double q = 1.0 / m.slope;
  const double s_x = l.x + v.x, s_y = l.y + v.y, s_z = l.z + v.z;
  const double s2 = s_x * s_x + s_y * s_y + s_z * s_z;
  const double u = 0.5 * std::sqrt(s2);
  const double fresnel = m.f0 + (1.0 - m.f0) * std::pow(1.0 - u, 5.0);
  const double shadowing = (1.0 - std::pow(1.0 - l.z, q)) * (1.0 - std::pow(1.0 - v.z, q));
  const double visible = (1.0 - std::pow(1.0 - l.z, 1.6 * q)) * (1.0 - std::pow(1.0 - v.z, 1.6 * q));
  const double m_e = m.slope * std::pow(visible, 0.1 * q);
  const double tan2_b = (s_x * s_x + s_y * s_y) / (s_z * s_z);
  const double d = (s2 / s_z) * (s2 / s_z) / (16.0 * m_e * m_e * s_z * s_z) * std::exp(-tan2_b / (4.0 * m_e * m_e));
  const double t_i = (1.0 - m.f0) * (1.0 - std::pow(1.0 - l.z, 5.0));
  const double t_r = (1.0 - m.f0) * (1.0 - std::pow(1.0 - v.z, 5.0));
  double forward = 0.0;
  const double sin2_i = l.x * l.x + l.y * l.y;
  const double along = -(l.x * v.x + l.y * v.y);
  if (along > 0.0) {
    const double cos2_f = along * along / sin2_i;
    const double tan2_f = (1.0 - cos2_f) / cos2_f;
    forward = (1.0 - l.z) * (1.0 - v.z) * std::exp(-tan2_f / (16.0 * m_e * m_e));
  }
  return m.k_dd * fresnel * shadowing * d / (std::numbers::pi * l.z * v.z) +
         t_i * t_r * (m.k_uds + m.k_fs * forward) / std::numbers::pi;
}

}  // namespace goniofit::bench
