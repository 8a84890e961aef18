#include "fit/problem.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/cross_validation.h"
#include "fit/parameter_settings.h"
#include "fit/reading_noise.h"
#include "fit/surface_basis.h"
#include "fit/thinning.h"
#include "peers/peers.h"
#include "support/error.h"

namespace goniofit {

namespace {

constexpr double default_n = 1.5;
constexpr std::size_t least_angles = 3;

// One value for all channels, one a channel, or none.
std::optional<double> per_channel(const std::vector<double>& values, std::size_t channel, std::size_t channels,
                                  const char* name) {
  if (values.empty()) return std::nullopt;
  if (values.size() == 1) return values.front();
  if (values.size() != channels) {
    throw usage_error(std::string(name) + ": " + std::to_string(values.size()) +
                      " values given, expected one or one for each of the " + std::to_string(channels) + " channels");
  }
  return values[channel];
}

bool same(const ChannelOptics& a, const ChannelOptics& b) { return a.n == b.n && a.kappa == b.kappa && a.f0 == b.f0; }

// Whether what is asked for reads a reading at a time, and geometry anew as often as need be. The integral over grooves
// is tabulated once for each pair.
bool goes_by_parts(const FitSettings& settings) {
  const bool tabulated = settings.components && settings.components->has(Effect::rough);
  const bool quadratic = !is_transformed(settings.loss) && settings.robust == RobustKernel::none;
  return quadratic && !tabulated && !settings.reflectances && !settings.profile &&
         settings.uncertainty != UncertaintySource::angles;
}

}  // namespace

Eigen::VectorXd ShapeMap::at(const double* z) const {
  Eigen::VectorXd result = offset;
  for (int j = 0; j < free; ++j) result += map.col(j) * z[j];
  return result;
}

Problem::Problem(const Scan& scan, const FitSettings& settings, Hold hold)
    : ProblemTerms{
          .model = settings.model,
          .terms = settings.terms,
          .forms = settings.forms,
          .anisotropic = settings.anisotropic || settings.parameters.contains("slope_y"),
          .solid_angle_sr = settings.solid_angle_sr.value_or(scan.solid_angle_sr.value_or(default_solid_angle_sr)),
          .free_optics = settings.free_optics,
          .weighting = settings.weight,
          .loss = settings.loss} {
  std::vector<std::string> names;
  for (const ScanChannel& c : scan.channels) names.push_back(c.name);
  check_parameter_names(settings, names);
  check_range(solid_angle_sr, 1e-12, 2.0 * pi, "solid angle");
  choose_rows(scan, settings, hold == Hold::parts && goes_by_parts(settings));
  choose_optics(scan, settings);
  if (model == surface_model) {
    choose_components(settings);
  } else if (settings.components) {
    throw usage_error("components: given for the model " + model + ", which has none, expected the model surface");
  }
  choose_basis();
  choose_shape(settings);
  choose_coefficients(settings);
  add_reflectances(settings);
  choose_weights(scan);
  fill_values(scan, settings);
  fill_targets();
  choose_uncertainty(scan, settings);
  if (by_parts()) drawn = searched_rows(*this);
}

Problem::Problem(std::unique_ptr<const Basis> own_basis, Readings readings, const FitSettings& settings)
    : ProblemTerms{.optics_groups = 1},
      basis(std::move(own_basis)),
      pairs(std::move(readings.pairs)),
      weight(readings.weight.cwiseSqrt()),
      channels(readings.values.size()) {
  const auto n = static_cast<Eigen::Index>(pairs.size());
  terms.fresnel = FresnelTier::none;
  if (weight.size() == 0) weight = Eigen::VectorXd::Ones(n);
  if (n == 0 || channels.empty()) throw usage_error("readings: none given, expected one channel of one at least");
  if (weight.size() != n || !(weight.minCoeff() > 0.0))
    throw usage_error("readings: expected a weight above zero for each of the " + std::to_string(n));
  for (std::size_t row = 0; row < pairs.size(); ++row) rows.push_back(row);
  sums = RowSums(rows.size());
  theta_i_deg.assign(rows.size(), 0.0);
  point_weight = weight;
  choose_shape(settings);
  choose_coefficients(settings);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (readings.values[c].size() != n)
      throw usage_error("readings: " + std::to_string(readings.values[c].size()) + " values in channel " +
                        std::to_string(c + 1) + ", expected one for each of the " + std::to_string(n) + " pairs");
    channels[c].value = std::move(readings.values[c]);
  }
  fill_targets();
}

std::optional<std::size_t> Problem::shape_index(const std::string& name) const {
  const std::vector<ShapeParameter>& all = basis->shape_parameters();
  const auto at = std::find_if(all.begin(), all.end(), [&](const ShapeParameter& p) { return p.name == name; });
  if (at == all.end()) return std::nullopt;
  return static_cast<std::size_t>(at - all.begin());
}

void Problem::make_basis() {
  if (model == surface_model) {
    basis = std::make_unique<SurfaceBasis>(components, ShapeSettings::of(terms, forms, anisotropic), solid_angle_sr);
  } else {
    basis = make_peer(model, solid_angle_sr);
  }
}

void Problem::choose_basis() {
  make_basis();
  if (!basis->has_length()) return;
  for (const ProblemChannel& c : channels) {
    if (c.wavelength_um) continue;
    const bool wave = ShapeSettings::of(terms, forms, anisotropic).wave_optics();
    throw usage_error(std::string(wave ? "distribution he-torrance" : "coh") + " needs the wavelength of channel " +
                      c.name + ", expected `# wavelength_um: ...` in the scan or a channel named like 550nm");
  }
}

void Problem::choose_optics(const Scan& scan, const FitSettings& settings) {
  const std::size_t count = scan.channels.size();
  bool assumed = false;
  for (std::size_t c = 0; c < count; ++c) {
    const ScanChannel& from = scan.channels[c];
    ProblemChannel& to = channels.emplace_back();
    to.name = from.name;
    to.wavelength_um = from.wavelength_um;
    const std::optional<double> f0 = per_channel(settings.f0, c, count, "f0");
    const std::optional<double> n = per_channel(settings.n, c, count, "n");
    const std::optional<double> kappa = per_channel(settings.kappa, c, count, "kappa");
    if (f0) {
      if (terms.fresnel == FresnelTier::exact)
        throw usage_error("f0: the exact Fresnel term needs n and kappa, expected --n or --fresnel schlick");
      if (n || kappa) throw usage_error("f0: given beside n or kappa, expected either f0 or n and kappa");
      check_range(*f0, 0.0, 1.0, "f0");
      to.optics = ChannelOptics::of_reflectance(*f0);
    } else {
      assumed = assumed || (!n && !from.n);
      to.n = n ? n : from.n ? from.n : default_n;
      to.kappa = kappa ? kappa : n ? 0.0 : from.kappa.value_or(0.0);
      check_range(*to.n, n_min, n_max, "n");
      check_range(*to.kappa, 0.0, n_max, "kappa");
      to.optics = ChannelOptics::of_index(*to.n, *to.kappa);
    }
    const auto twin = std::find_if(channels.begin(), channels.end() - 1,
                                   [&](const ProblemChannel& other) { return same(other.optics, to.optics); });
    to.optics_group = twin == channels.end() - 1 ? optics_groups++ : twin->optics_group;
    if (free_optics == FreeOptics::f0) {
      if (terms.fresnel != FresnelTier::schlick)
        throw usage_error("f0: it can be fitted with the schlick Fresnel term only, expected --free n");
      std::tie(to.optics_lower, to.optics_upper) = interval_of(setting_of(settings, "f0", to.name), "f0", 0.0, 1.0);
    } else if (free_optics == FreeOptics::n) {
      // Schlick's term knows n through f0 alone, which takes each value on two branches; the upper one is meant. A
      // dielectric under 1 would be the other side of the interface.
      const double k = to.optics.kappa;
      const double branch = terms.fresnel == FresnelTier::schlick || k == 0.0 ? std::sqrt(1.0 + k * k) : 0.05;
      const double top = k == 0.0 ? 10.0 : n_max;
      std::tie(to.optics_lower, to.optics_upper) = interval_of(setting_of(settings, "n", to.name), "n", branch, top);
    }
  }
  if (assumed && free_optics == FreeOptics::none && terms.fresnel != FresnelTier::none) {
    notes.emplace_back(
        "n = 1.5 was assumed, since neither the scan nor a recipe nor --n gives one; k_dd stands in for what it gets "
        "wrong");
  }
}

void Problem::choose_components(const FitSettings& settings) {
  components = settings.components.value_or(EffectSet{});
  if (components.empty()) throw usage_error("components: none given, expected some of " + names_of<Effect>());
  if (!components.has(Effect::coh)) return;
  bool in_cone = false;
  for_each_pairs([&](const PairBatch& run) {
    for (std::size_t i = 0; i < run.size() && !in_cone; ++i) in_cone = in_mirror_cone(run[i], solid_angle_sr);
  });
  if (in_cone) return;
  components.erase(Effect::coh);
  components.insert(Effect::dd);
  warnings.emplace_back(
      "coh was left out: no reading lies within the mirror cone of the solid angle given; measure the mirror direction "
      "itself");
}

void Problem::add_free(std::size_t parameter, double low, double high) {
  const double origin = basis->shape_parameters()[parameter].origin;
  shape.map(static_cast<Eigen::Index>(parameter), shape.free++) = 1.0;
  shape.row.push_back(static_cast<int>(parameter));
  shape.lower.push_back(std::log(low - origin));
  shape.upper.push_back(std::log(high - origin));
  shape.lower_value.push_back(low);
  shape.upper_value.push_back(high);
}

void Problem::fix(std::size_t parameter, double value) {
  shape.offset[static_cast<Eigen::Index>(parameter)] = std::log(value - basis->shape_parameters()[parameter].origin);
}

void Problem::free_or_fix(const FitSettings& settings, std::size_t parameter) {
  const ShapeParameter& p = basis->shape_parameters()[parameter];
  const auto [low, high] = interval_of(setting_of(settings, p.name), p.name, p.lower, p.upper);
  if (low < high) {
    add_free(parameter, low, high);
  } else {
    fix(parameter, low);
  }
}

void Problem::choose_slope(const FitSettings& settings) {
  const auto [low, high] = interval_of(setting_of(settings, "slope"), "slope", slope_min, slope_max);
  if (!known_sigma_um || !known_tau_um) return free_or_fix(settings, *shape_index("slope"));
  const double slope = *known_sigma_um / *known_tau_um;
  if (setting_of(settings, "slope").value && std::fabs(low / slope - 1.0) > 1e-6) {
    throw usage_error(
        "parameter slope: fixed to another value than sigma_um / tau_um, expected one of the three to be left out");
  }
  check_range(slope, slope_min, slope_max, "sigma_um / tau_um");
  fix(*shape_index("slope"), slope);
}

void Problem::choose_sigma(const FitSettings& settings) {
  const std::size_t sigma = *shape_index("sigma_um");
  if (known_sigma_um) return fix(sigma, *known_sigma_um);
  if (!known_tau_um) {
    free_or_fix(settings, sigma);
    if (shape.row.empty() || shape.row.back() != static_cast<int>(sigma)) {  // its bounds met
      known_sigma_um = std::exp(shape.offset[static_cast<Eigen::Index>(sigma)]);
    }
    return;
  }
  const auto slope = static_cast<Eigen::Index>(*shape_index("slope"));  // sigma = tau * slope
  const auto row = static_cast<Eigen::Index>(sigma);
  shape.offset[row] = std::log(*known_tau_um) + shape.offset[slope];
  shape.map.row(row) = shape.map.row(slope);
}

void Problem::choose_shape(const FitSettings& settings) {
  const auto size = static_cast<Eigen::Index>(basis->shape_parameters().size());
  shape.offset = Eigen::VectorXd::Zero(size);
  shape.map = Eigen::MatrixXd::Zero(size, size);
  if (model == surface_model) {
    const ParameterSetting sigma = setting_of(settings, "sigma_um");
    const ParameterSetting tau = setting_of(settings, "tau_um");
    if (sigma.value) known_sigma_um = interval_of(sigma, "sigma_um", 1e-9, 1e9).first;
    if (tau.value) known_tau_um = interval_of(tau, "tau_um", 1e-9, 1e9).first;
    if (!basis->has_length() && (sigma.min || sigma.max || tau.min || tau.max)) {
      throw usage_error(
          "parameter sigma_um or tau_um: bounds have no meaning without coh or the distribution he-torrance, which "
          "alone tell them from their quotient; expected bounds of slope, or a fixed value");
    }
    if (tau.min || tau.max)
      throw usage_error("parameter tau_um: cannot be bounded, expected bounds of slope and sigma_um");
  }
  for (std::size_t i = 0; i < basis->shape_parameters().size(); ++i) {
    const std::string& name = basis->shape_parameters()[i].name;
    if (model == surface_model && name == "slope") {
      choose_slope(settings);
    } else if (model == surface_model && name == "sigma_um") {
      choose_sigma(settings);
    } else {
      free_or_fix(settings, i);
    }
  }
  shape.map.conservativeResize(Eigen::NoChange, shape.free);
}

void Problem::choose_coefficients(const FitSettings& settings) {
  const std::vector<BasisCoefficient>& coefficients = basis->coefficients();
  for (const Coefficient c : all_coefficients) {
    const std::string name(name_of(c));
    const bool used = std::any_of(coefficients.begin(), coefficients.end(),
                                  [&](const BasisCoefficient& k) { return k.name == name; });
    if (!used && settings.parameters.contains(name)) {
      notes.push_back("the setting of " + name + " has no effect: no component of the model reads it");
    }
  }
  const auto size = static_cast<Eigen::Index>(coefficients.size());
  for (ProblemChannel& channel : channels) {
    channel.lower.resize(size);
    channel.upper.resize(size);
    for (Eigen::Index j = 0; j < size; ++j) {
      const BasisCoefficient& k = coefficients[static_cast<std::size_t>(j)];
      // Bounds given by the user may go beyond the default ones: a scan of uncertain scale may want k_dd of 1.2.
      const ParameterSetting setting = k.constant() ? ParameterSetting{} : setting_of(settings, k.name, channel.name);
      const double highest = std::max({k.upper, setting.max.value_or(0.0), setting.value.value_or(0.0)});
      const auto [low, high] = interval_of(setting, k.name, k.lower, highest);
      channel.lower[j] = low;
      channel.upper[j] = setting.max || setting.value ? high : std::min(high, k.upper);
    }
  }
}

void Problem::choose_uncertainty(const Scan& scan, const FitSettings& settings) {
  scale_u = settings.scale_u.value_or(scan.scale_u.value_or(0.0));
  check_range(scale_u, 0.0, 1.0, "scale-u");
  const bool stated = states_uncertainties(*this);
  uncertainty = settings.uncertainty.value_or(stated ? UncertaintySource::readings : UncertaintySource::residuals);
  if (uncertainty == UncertaintySource::readings && !stated) {
    throw usage_error(scan.source +
                      ": uncertainties from the readings are asked for, but not every channel has a column of its own, "
                      "expected u_NAME beside each");
  }
  if (uncertainty != UncertaintySource::angles) return;
  const std::size_t groups = angle_groups(*this).count();
  if (groups < least_angles) {
    throw usage_error(scan.source + ": uncertainties from the incidence angles are asked for, of which it has " +
                      std::to_string(groups) + ", expected at least " + std::to_string(least_angles));
  }
}

}  // namespace goniofit
