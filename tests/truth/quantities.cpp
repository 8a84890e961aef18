#include "quantities.h"

#include <algorithm>
#include <limits>

#include "brdf/evaluator.h"
#include "peers/cook_torrance.h"

namespace goniofit::stability {

namespace {

namespace naive = truth::naive;

template <class T>
Outcome<T> plain(const T& value) {
  return {value, T(std::numeric_limits<double>::quiet_NaN())};
}
template <class T>
Outcome<T> logarithm(const T& log) {
  return {T(std::numeric_limits<double>::quiet_NaN()), log};
}

template <class T>
T shadowing(ShadowingTier tier, const Sample<T>& s) {
  return surface_terms(with(lt_settings, tier), s.surface, s.pair).shadowing_over_cosines;
}

template <class T>
T height_ratio(const ShapeSettings& settings, const Sample<T>& s) {
  return surface_terms(settings, s.surface, s.pair).log_height_ratio;
}

template <class T>
WaveArguments<T> lobe_arguments(const Sample<T>& s) {
  return wave_arguments(ht_settings, s.surface, height_ratio(ht_settings, s), s.in.wavelength_um, s.pair);
}

template <class T>
T log_w(DistributionTier tier, const Sample<T>& s) {
  const WaveArguments<T> a = lobe_arguments(s);
  return log_wave_lobe(tier, a.log_g, a.x);
}

// ---- Whole models: by the Evaluator in double, put together from the same templates in 50 digits -------------------

enum class Model { lt, ht, ht_fast, mixed };

Terms terms_of(Model model) {
  using enum Model;
  if (model == lt) return {};
  if (model == mixed) return {.fresnel = FresnelTier::exact, .distribution = DistributionTier::student_t};
  return {.fresnel = FresnelTier::exact,
          .shadowing = ShadowingTier::smith,
          .effective_roughness = EffectiveRoughnessTier::he,
          .distribution = model == ht ? DistributionTier::he_torrance_series : DistributionTier::he_torrance};
}
bool diffuse_only(Model model) { return model == Model::ht || model == Model::ht_fast; }
FsForm fs_form(Model model) { return model == Model::mixed ? FsForm::reciprocal : FsForm::printed; }

Material material_of(Model model, const Inputs& in) {
  Material m;
  m.components = diffuse_only(model) ? EffectSet{Effect::dd, Effect::udf}
                                     : EffectSet{Effect::dd, Effect::udf, Effect::uds, Effect::fs};
  m.terms = terms_of(model);
  m.forms.fs = fs_form(model);
  m.surface.slope = in.slope;
  m.surface.sigma_um = in.sigma_um;
  m.surface.tail = in.tail;
  MaterialChannel c;
  c.name = "one";
  c.wavelength_um = in.wavelength_um;
  c.n = in.n;
  c.kappa = in.kappa;
  c.k = {in.k_dd, in.k_udf, in.k_uds, in.k_fs};
  m.channels.push_back(c);
  return m;
}

Outcome<double> whole(Model model, const Sample<double>& s) {
  return {Evaluator(material_of(model, s.in)).value(s.pair, 0), std::numeric_limits<double>::quiet_NaN()};
}

Outcome<Big> whole(Model model, const Sample<Big>& s) {
  const Terms terms = terms_of(model);
  const ShapeSettings settings = with(ShapeSettings::of(terms, {}, false), fs_form(model));
  const Big below = optics_factor(OpticsFactor::transmission, terms.fresnel, s.optics, s.pair);
  Big sum = s.in.k_dd * optics_factor(OpticsFactor::fresnel, terms.fresnel, s.optics, s.pair) * dd(settings, s).value;
  sum += s.in.k_udf / math::pi_of<Big>();
  if (!diffuse_only(model)) sum += below * (s.in.k_uds / math::pi_of<Big>() + s.in.k_fs * fs(settings, s).value);
  return {sum, log(sum)};
}

/// f is generic: it makes both the double and the 50-digit form.
template <class F>
Quantity both(std::string_view name, std::string_view column, Kind kind, F f,
              double (*plain_form)(const naive::Sample&)) {
  return {name, column, kind, f, f, plain_form};
}

/// A tier whose W is a table of doubles, to the 1e-9 that it claims.
Quantity tabulated(std::string_view name, std::string_view column, Kind kind,
                   Outcome<double> (*f)(const Sample<double>&), double (*plain_form)(const naive::Sample&)) {
  return {name, column, kind, f, nullptr, plain_form, 1e-9, 1e-9};
}

using List = std::vector<Quantity>;

double schlick_transmission(const naive::Sample& s, double c) {
  return 1.0 - naive::fresnel_schlick(s.in.n, s.in.kappa, c);
}
double exact_transmission(const naive::Sample& s, double c) {
  return 1.0 - naive::fresnel_exact(s.in.n, s.in.kappa, c);
}

void add_fresnel(List& list) {
  const auto add = [&](std::string_view name, std::string_view column, auto f, auto plain_form) {
    list.push_back(both(name, column, Kind::plain, f, plain_form));
  };
  add(
      "F exact", "F_exact", [](const auto& s) { return plain(fresnel(FresnelTier::exact, s.optics, s.pair)); },
      [](const naive::Sample& s) { return naive::fresnel_exact(s.in.n, s.in.kappa, s.u); });
  add(
      "F schlick", "F_schlick", [](const auto& s) { return plain(fresnel(FresnelTier::schlick, s.optics, s.pair)); },
      [](const naive::Sample& s) { return naive::fresnel_schlick(s.in.n, s.in.kappa, s.u); });
  add(
      "T exact, L", "T_exact_i",
      [](const auto& s) {
        return plain(transmission_exact(s.optics.n, s.optics.kappa, s.pair.cos_i, s.pair.one_minus_cos_i));
      },
      [](const naive::Sample& s) { return exact_transmission(s, s.l.z); });
  add(
      "T exact, V", "T_exact_r",
      [](const auto& s) {
        return plain(transmission_exact(s.optics.n, s.optics.kappa, s.pair.cos_r, s.pair.one_minus_cos_r));
      },
      [](const naive::Sample& s) { return exact_transmission(s, s.v.z); });
  add(
      "T schlick, L", "T_schlick_i",
      [](const auto& s) { return plain(transmission_schlick(s.optics.t0, s.pair.cos_i)); },
      [](const naive::Sample& s) { return schlick_transmission(s, s.l.z); });
  add(
      "T schlick, V", "T_schlick_r",
      [](const auto& s) { return plain(transmission_schlick(s.optics.t0, s.pair.cos_r)); },
      [](const naive::Sample& s) { return schlick_transmission(s, s.v.z); });
}

void add_diffuse(List& list) {
  const auto add = [&](std::string_view name, std::string_view column, auto f, auto plain_form) {
    list.push_back(both(name, column, Kind::plain, f, plain_form));
  };
  add(
      "uds, schlick", "uds_schlick",
      [](const auto& s) {
        const auto t = transmission(FresnelTier::schlick, s.optics, s.pair);
        return plain(decltype(t)(t / math::pi_of<std::decay_t<decltype(t)>>()));
      },
      [](const naive::Sample& s) { return naive::transmissions(s, false) / naive::pi; });
  add(
      "uds, exact", "uds_exact",
      [](const auto& s) {
        const auto t = transmission(FresnelTier::exact, s.optics, s.pair);
        return plain(decltype(t)(t / math::pi_of<std::decay_t<decltype(t)>>()));
      },
      [](const naive::Sample& s) { return naive::transmissions(s, true) / naive::pi; });
  add(
      "Oren-Nayar direct", "on_direct",
      [](const auto& s) {
        const auto f = closed_rough_factors(RoughForm::functional, s.facet_slope, s.pair);
        return plain(f.direct / math::pi_of<decltype(f.direct)>());
      },
      naive::on_direct);
  add(
      "Oren-Nayar interreflection", "on_interreflection",
      [](const auto& s) {
        const auto f = closed_rough_factors(RoughForm::functional, s.facet_slope, s.pair);
        return plain(f.interreflection / math::pi_of<decltype(f.direct)>());
      },
      naive::on_interreflection);
  add(
      "Oren-Nayar qualitative", "on_qualitative",
      [](const auto& s) {
        const auto f = closed_rough_factors(RoughForm::qualitative, s.facet_slope, s.pair);
        return plain(f.direct / math::pi_of<decltype(f.direct)>());
      },
      naive::on_qualitative);
}

void add_shadowing(List& list) {
  const auto add = [&](std::string_view name, std::string_view column, auto f, auto plain_form) {
    list.push_back(both(name, column, Kind::plain, f, plain_form));
  };
  add(
      "S li-torrance / (c_i c_r)", "S_lt",
      [](const auto& s) { return plain(shadowing(ShadowingTier::li_torrance, s)); },
      [](const naive::Sample& s) {
        return naive::shadowing(naive::Tier::lt, naive::isotropic(s), s) / (s.l.z * s.v.z);
      });
  add(
      "S smith / (c_i c_r)", "S_smith", [](const auto& s) { return plain(shadowing(ShadowingTier::smith, s)); },
      [](const naive::Sample& s) {
        return naive::shadowing(naive::Tier::he, naive::isotropic(s), s) / (s.l.z * s.v.z);
      });
  add(
      "S schlick / (c_i c_r)", "S_schlick", [](const auto& s) { return plain(shadowing(ShadowingTier::schlick, s)); },
      [](const naive::Sample& s) {
        return naive::shadowing_schlick(s.in.slope, s.l.z) * naive::shadowing_schlick(s.in.slope, s.v.z) /
               (s.l.z * s.v.z);
      });
  add(
      "S v-cavity / (c_i c_r)", "S_v_cavity",
      [](const auto& s) { return plain(decltype(s.facet_slope)(4.0 * v_cavity_over_cosines(s.pair))); },
      [](const naive::Sample& s) {
        const double height = 2.0 * s.s.z / std::sqrt(s.s2) / s.u;
        return std::min({1.0, height * s.v.z, height * s.l.z}) / (s.l.z * s.v.z);
      });
}

void add_roughness(List& list) {
  const auto add = [&](std::string_view name, std::string_view column, auto f, auto plain_form) {
    list.push_back(both(name, column, Kind::logarithm, f, plain_form));
  };
  add(
      "sigma_e / sigma, li-torrance", "ln_sigma_e_lt",
      [](const auto& s) { return logarithm(height_ratio(lt_settings, s)); },
      [](const naive::Sample& s) { return naive::roughness(naive::Tier::lt, naive::isotropic(s), s); });
  add(
      "sigma_e / sigma, he", "ln_sigma_e_he", [](const auto& s) { return logarithm(height_ratio(ht_settings, s)); },
      [](const naive::Sample& s) { return naive::roughness(naive::Tier::he, naive::isotropic(s), s); });
  const auto naive_g = [](const naive::Sample& s) {
    return naive::phase_variance(s, naive::roughness(naive::Tier::he, naive::isotropic(s), s) * s.in.sigma_um);
  };
  add(
      "g", "ln_g", [](const auto& s) { return logarithm(lobe_arguments(s).log_g); }, naive_g);
  add(
      "x", "ln_x",
      [](const auto& s) {
        using namespace math;
        return logarithm(decltype(s.facet_slope)(log(lobe_arguments(s).x)));
      },
      [](const naive::Sample& s) { return naive::lobe_argument(s, naive::isotropic(s)); });
  const auto naive_w = [](const naive::Sample& s) {
    const naive::Slopes m = naive::isotropic(s);
    const double sigma_e = naive::roughness(naive::Tier::he, m, s) * s.in.sigma_um;
    return naive::lobe_sum(naive::phase_variance(s, sigma_e), naive::lobe_argument(s, m));
  };
  add(
      "W, he-torrance-series", "ln_W",
      [](const auto& s) { return logarithm(log_w(DistributionTier::he_torrance_series, s)); }, naive_w);
  list.push_back(tabulated(
      "W, he-torrance", "ln_W", Kind::logarithm,
      [](const Sample<double>& s) { return logarithm(log_w(DistributionTier::he_torrance, s)); }, naive_w));
}

void add_directional_diffuse(List& list) {
  const auto add = [&](std::string_view name, std::string_view column, auto f, auto plain_form) {
    list.push_back(both(name, column, Kind::log_of_value, f, plain_form));
  };
  add(
      "dd, li-torrance", "ln_dd_lt", [](const auto& s) { return dd(lt_settings, s); },
      [](const naive::Sample& s) { return naive::dd_rough(naive::Tier::lt, s); });
  add(
      "dd, student-t", "ln_dd_student",
      [](const auto& s) { return dd(with(lt_settings, DistributionTier::student_t), s); }, naive::dd_student);
  add(
      "dd, smith, he, rough-limit", "ln_dd_smith_rough",
      [](const auto& s) { return dd(with(ht_settings, DistributionTier::rough_limit), s); },
      [](const naive::Sample& s) { return naive::dd_rough(naive::Tier::he, s); });
  add(
      "dd, he-torrance-series", "ln_dd_ht", [](const auto& s) { return dd(ht_settings, s); },
      [](const naive::Sample& s) { return naive::dd_he(s, naive::isotropic(s)); });
  list.push_back(tabulated(
      "dd, he-torrance", "ln_dd_ht", Kind::log_of_value,
      [](const Sample<double>& s) { return dd(with(ht_settings, DistributionTier::he_torrance), s); },
      [](const naive::Sample& s) { return naive::dd_he(s, naive::isotropic(s)); }));
  add(
      "dd anisotropic, li-torrance", "ln_dd_aniso_lt", [](const auto& s) { return dd(anisotropic(lt_settings), s); },
      naive::dd_rough_anisotropic);
  add(
      "dd anisotropic, he-torrance-series", "ln_dd_aniso_ht",
      [](const auto& s) { return dd(anisotropic(ht_settings), s); },
      [](const naive::Sample& s) { return naive::dd_he(s, naive::anisotropic(s)); });
}

void add_other_effects(List& list) {
  const auto add = [&](std::string_view name, std::string_view column, auto f, auto plain_form) {
    list.push_back(both(name, column, Kind::log_of_value, f, plain_form));
  };
  add(
      "fs printed", "ln_fs_printed", [](const auto& s) { return fs(lt_settings, s); },
      [](const naive::Sample& s) { return naive::fs(s, naive::isotropic(s), false); });
  add(
      "fs reciprocal", "ln_fs_reciprocal", [](const auto& s) { return fs(with(lt_settings, FsForm::reciprocal), s); },
      [](const naive::Sample& s) { return naive::fs(s, naive::isotropic(s), true); });
  add(
      "fs anisotropic, printed", "ln_fs_aniso_printed", [](const auto& s) { return fs(anisotropic(lt_settings), s); },
      [](const naive::Sample& s) { return naive::fs(s, naive::anisotropic(s), false); });
  add(
      "fs anisotropic, reciprocal", "ln_fs_aniso_reciprocal",
      [](const auto& s) { return fs(anisotropic(with(lt_settings, FsForm::reciprocal)), s); },
      [](const naive::Sample& s) { return naive::fs(s, naive::anisotropic(s), true); });
  add(
      "coh, li-torrance", "ln_coh_lt", [](const auto& s) { return coh(lt_settings, s); },
      [](const naive::Sample& s) { return naive::coh(s, naive::Tier::lt); });
  add(
      "coh, he", "ln_coh_ht", [](const auto& s) { return coh(ht_settings, s); },
      [](const naive::Sample& s) { return naive::coh(s, naive::Tier::he); });
}

void add_whole_models(List& list) {
  const auto add = [&](std::string_view name, std::string_view column, auto f, auto plain_form) {
    list.push_back(both(name, column, Kind::log_of_value, f, plain_form));
  };
  add(
      "f, Li & Torrance", "ln_f_lt", [](const auto& s) { return whole(Model::lt, s); }, naive::f_lt);
  add(
      "f, He et al. (series)", "ln_f_ht", [](const auto& s) { return whole(Model::ht, s); }, naive::f_ht);
  list.push_back(tabulated(
      "f, He et al.", "ln_f_ht", Kind::log_of_value, [](const Sample<double>& s) { return whole(Model::ht_fast, s); },
      naive::f_ht));
  add(
      "f, exact, student-t, reciprocal fs", "ln_f_mixed", [](const auto& s) { return whole(Model::mixed, s); },
      naive::f_mixed);
}

}  // namespace

const std::vector<Quantity>& quantities() {
  static const List all = [] {
    List list;
    add_fresnel(list);
    add_diffuse(list);
    add_shadowing(list);
    add_roughness(list);
    add_directional_diffuse(list);
    add_other_effects(list);
    add_whole_models(list);
    return list;
  }();
  return all;
}

}  // namespace goniofit::stability
