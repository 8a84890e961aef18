#include "columns.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>
#include <utility>

#include "models.h"
#include "oren_nayar_definitions.h"
#include "sensitivities.h"

namespace goniofit::truth {

namespace {

constexpr int conditioning_digits = 3;

// Columns that ordinary.csv leaves out: products of others, or of interest in corners only.
constexpr std::array corners_only{"T_schlick_i",
                                  "T_schlick_r",
                                  "S_v_cavity",
                                  "ln_g",
                                  "ln_x",
                                  "ln_coh_lt",
                                  "ln_coh_ht",
                                  "uds_schlick",
                                  "ln_fs_aniso_printed",
                                  "uds_exact",
                                  "ln_dd_smith_rough",
                                  "ln_fs_aniso_reciprocal"};

using Cells = std::vector<std::pair<std::string, std::string>>;

/// One row being filled: what its columns share, and the cells so far.
class Row {
 public:
  Row(const Inputs& inputs, int digits) : in_(inputs), digits_(digits), q_(inputs), p_(q_.geometry()) {}

  Cells fill() {
    for (const InputColumn& column : input_columns()) cells_.emplace_back(column.name, shortest(in_.*column.value));
    fresnel();
    shadowing();
    roughness_and_lobe_sum();
    directional_diffuse();
    forward_scattering();
    coherent();
    oren_nayar();
    whole_models();
    sensitivities();
    cells_.emplace_back("corner", in_.corner);
    return cells_;
  }

 private:
  template <class R>
  void put(const char* name, const R& value) {
    cells_.emplace_back(name, text(value, digits_));
  }

  void fresnel() {
    put("F_exact", fresnel_exact(q_.n, q_.kappa, p_.u));
    put("F_schlick", fresnel_schlick(q_.n, q_.kappa, p_.u));
    const Real exact_i = 1 - fresnel_exact(q_.n, q_.kappa, p_.l.z);
    const Real exact_r = 1 - fresnel_exact(q_.n, q_.kappa, p_.v.z);
    const Real schlick_i = 1 - fresnel_schlick(q_.n, q_.kappa, p_.l.z);
    const Real schlick_r = 1 - fresnel_schlick(q_.n, q_.kappa, p_.v.z);
    put("T_exact_i", exact_i);
    put("T_exact_r", exact_r);
    put("T_schlick_i", schlick_i);
    put("T_schlick_r", schlick_r);
    put("uds_schlick", Real(schlick_i * schlick_r / pi<Real>()));
    put("uds_exact", Real(exact_i * exact_r / pi<Real>()));
  }

  void shadowing() {
    const Real cosines = p_.l.z * p_.v.z;
    const Real schlick = shadowing_schlick(q_.slope, p_.l.z) * shadowing_schlick(q_.slope, p_.v.z);
    put("S_lt", Real(lt_.shadowing / cosines));
    put("S_smith", Real(ht_.shadowing / cosines));
    put("S_schlick", Real(schlick / cosines));
    put("S_v_cavity", Real(shadowing_v_cavity(p_) / cosines));
  }

  void roughness_and_lobe_sum() {
    put("ln_sigma_e_lt", Real(log(lt_.roughness)));
    put("ln_sigma_e_he", Real(log(ht_.roughness)));
    put("ln_g", Real(log(lobe_.g)));
    put("ln_x", Real(log(lobe_.x)));
    put("ln_W", sum_.log_w);
  }

  void directional_diffuse() {
    const auto this_sum = [&](const Real&, const Real&) { return sum_.log_w; };
    const auto any_sum = [](const Real& g, const Real& x) { return he_torrance_sum(g, x).log_w; };
    put("ln_dd_lt", log_dd_rough(p_, isotropic_, lt_));
    put("ln_dd_ht", log_dd_ht(q_, p_, isotropic_, ht_, this_sum));
    put("ln_dd_student", log_dd(p_, lt_.shadowing, log_d_student_t(p_, q_.tail, Real(lt_.roughness * q_.slope))));
    put("ln_dd_smith_rough", log_dd_rough(p_, isotropic_, ht_));
    put("ln_dd_aniso_lt", log_dd_rough(p_, anisotropic_, anisotropic_lt_));
    put("ln_dd_aniso_ht", log_dd_ht(q_, p_, anisotropic_, attenuation_ht(p_, anisotropic_), any_sum));
  }

  void forward_scattering() {
    const Real m_e = lt_.roughness * q_.slope;
    const Real m_ex = anisotropic_lt_.roughness * q_.slope;
    const Real m_ey = anisotropic_lt_.roughness * q_.slope_y;
    put("ln_fs_printed", log_fs(p_, m_e, m_e, FsOrder::printed));
    put("ln_fs_reciprocal", log_fs(p_, m_e, m_e, FsOrder::reciprocal));
    put("ln_fs_aniso_printed", log_fs(p_, m_ex, m_ey, FsOrder::printed));
    put("ln_fs_aniso_reciprocal", log_fs(p_, m_ex, m_ey, FsOrder::reciprocal));
  }

  void coherent() {
    const Real solid_angle(0.0005);
    const Real sigma_e = lt_.roughness * q_.sigma;
    put("ln_coh_lt", log_coh(p_, lt_.shadowing, phase_variance(p_, sigma_e, q_.wavelength), solid_angle));
    put("ln_coh_ht", log_coh(p_, ht_.shadowing, lobe_.g, solid_angle));
  }

  void oren_nayar() {
    const OrenNayarAngles<Real> a(q_.theta_i, q_.phi_i, q_.theta_r, q_.phi_r, q_.facet_slope_deg);
    put("on_direct", oren_nayar_direct(a));
    put("on_interreflection", oren_nayar_interreflection(a));
    put("on_qualitative", oren_nayar_qualitative(a));
  }

  void whole_models() {
    put("ln_f_lt", log_of_sum(components_lt(q_)));
    put("ln_f_ht", log_of_sum(components_ht(q_, [&](const Real&, const Real&) { return sum_.log_w; })));
    put("ln_f_mixed", log_of_sum(components_mixed(q_)));
  }

  void sensitivities() {
    const LobeSum<Hundred> sum{Hundred(sum_.g), Hundred(sum_.x), Hundred(sum_.log_w), Hundred(sum_.dlog_dg),
                               Hundred(sum_.dlog_dx)};
    const auto near = [&](const Hundred& g, const Hundred& x) { return sum.near(g, x); };
    const auto dd_lt = [](const Quantities<Hundred>& q) {
      const Geometry<Hundred> p = q.geometry();
      const auto m = Slopes<Hundred>::isotropic(q);
      return log_dd_rough(p, m, attenuation_lt(p, m));
    };
    const auto dd_ht = [&](const Quantities<Hundred>& q) {
      const Geometry<Hundred> p = q.geometry();
      const auto m = Slopes<Hundred>::isotropic(q);
      return log_dd_ht(q, p, m, attenuation_ht(p, m), near);
    };
    const Quantities<Hundred> at(in_);
    put("dln_dd_lt_dln_slope", log_derivative(at, &Quantities<Hundred>::slope, dd_lt));
    put("dln_dd_ht_dln_slope", log_derivative(at, &Quantities<Hundred>::slope, dd_ht));
    put("dln_dd_ht_dln_sigma", log_derivative(at, &Quantities<Hundred>::sigma, dd_ht));

    const auto of_lt = [](const Quantities<Hundred>& q) { return log_of_sum(components_lt(q)); };
    const auto of_ht = [&](const Quantities<Hundred>& q) { return log_of_sum(components_ht(q, near)); };
    const auto lt = conditioning(in_, of_lt);
    auto ht = conditioning(in_, of_ht);
    ht.add(in_.sigma_um, &Quantities<Hundred>::sigma);
    cells_.emplace_back("conditioning_lt", text(lt.total(), conditioning_digits));
    cells_.emplace_back("conditioning_ht", text(ht.total(), conditioning_digits));
  }

  const Inputs& in_;
  int digits_;
  Quantities<Real> q_;
  Geometry<Real> p_;
  Slopes<Real> isotropic_ = Slopes<Real>::isotropic(q_);
  Slopes<Real> anisotropic_ = Slopes<Real>::anisotropic(q_);
  Attenuation<Real> lt_ = attenuation_lt(p_, isotropic_);
  Attenuation<Real> ht_ = attenuation_ht(p_, isotropic_);
  Attenuation<Real> anisotropic_lt_ = attenuation_lt(p_, anisotropic_);
  LobeArguments<Real> lobe_{q_, p_, isotropic_, ht_.roughness};
  LobeSum<Real> sum_ = he_torrance_sum(lobe_.g, lobe_.x);
  Cells cells_;
};

bool belongs(Table table, const std::string& name) {
  return table == Table::hard || std::find(corners_only.begin(), corners_only.end(), name) == corners_only.end();
}

Cells kept_cells(Table table, const Inputs& inputs) {
  Cells kept;
  for (auto& cell : Row(inputs, table == Table::hard ? hard_digits : ordinary_digits).fill())
    if (belongs(table, cell.first)) kept.push_back(std::move(cell));
  return kept;
}

}  // namespace

const std::vector<InputColumn>& input_columns() {
  static const std::vector<InputColumn> columns{
      {"theta_i", &Inputs::theta_i},   {"phi_i", &Inputs::phi_i},
      {"theta_r", &Inputs::theta_r},   {"phi_r", &Inputs::phi_r},
      {"slope", &Inputs::slope},       {"slope_y", &Inputs::slope_y},
      {"sigma_um", &Inputs::sigma_um}, {"wavelength_um", &Inputs::wavelength_um},
      {"tail", &Inputs::tail},         {"n", &Inputs::n},
      {"kappa", &Inputs::kappa},       {"facet_slope_deg", &Inputs::facet_slope_deg},
      {"k_dd", &Inputs::k_dd},         {"k_udf", &Inputs::k_udf},
      {"k_uds", &Inputs::k_uds},       {"k_fs", &Inputs::k_fs}};
  return columns;
}

std::string shortest(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::vector<std::string> header(Table table) {
  Inputs any;
  any.theta_i = 30;
  any.theta_r = 40;
  std::vector<std::string> names;
  for (auto& cell : kept_cells(table, any)) names.push_back(std::move(cell.first));
  return names;
}

std::vector<std::string> cells(Table table, const Inputs& inputs) {
  std::vector<std::string> values;
  for (auto& cell : kept_cells(table, inputs)) values.push_back(std::move(cell.second));
  return values;
}

std::string joined(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) {
    if (!line.empty()) line += ',';
    line += cell;
  }
  return line;
}

}  // namespace goniofit::truth
