#pragma once
// A material: which effects, which tier of each term, the shared surface and the coefficients of each channel. The
// value that fit produces and everything else (evaluation, export, plots, simulation) reads. Knows no file format.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../terms/tiers.h"

namespace goniofit {

/// The effects of Li & Torrance 2005, section 2, and the one their 2.1.2 invites.
enum class Effect : std::uint8_t {
  coh,   ///< coherent (mirror) reflection, k_dd F S exp(-g) / (cos_i dOmega) inside the mirror cone
  dd,    ///< directional-diffuse reflection of the rough surface, k_dd F S D / (pi cos_i cos_r)
  udf,   ///< uniform-diffuse reflection, k_udf / pi
  uds,   ///< uniform-diffuse light from below the surface, k_uds / pi T(cos_i) T(cos_r)
  fs,    ///< forward scattering from below the surface
  rough  ///< diffuse reflection of V-shaped grooves (Oren & Nayar 1994), of albedo rho
};
inline constexpr std::array all_effects{Effect::coh, Effect::dd, Effect::udf, Effect::uds, Effect::fs, Effect::rough};

class EffectSet {
 public:
  constexpr EffectSet() = default;
  constexpr EffectSet(std::initializer_list<Effect> effects) {
    for (const Effect e : effects) insert(e);
  }
  constexpr void insert(Effect e) noexcept { bits_ |= mask(e); }
  constexpr void erase(Effect e) noexcept { bits_ &= ~mask(e); }
  [[nodiscard]] constexpr bool has(Effect e) const noexcept { return (bits_ & mask(e)) != 0; }
  [[nodiscard]] constexpr bool empty() const noexcept { return bits_ == 0; }
  friend constexpr bool operator==(const EffectSet&, const EffectSet&) = default;

 private:
  static constexpr unsigned mask(Effect e) noexcept { return 1U << static_cast<unsigned>(e); }
  unsigned bits_ = 0;
};

/// The coefficients of the effects: linear, but for rho, whose square weighs the light that meets two facets. coh and
/// dd share k_dd.
enum class Coefficient : std::uint8_t { k_dd, k_udf, k_uds, k_fs, rho };
inline constexpr std::array all_coefficients{Coefficient::k_dd, Coefficient::k_udf, Coefficient::k_uds,
                                             Coefficient::k_fs, Coefficient::rho};
inline constexpr std::size_t coefficient_count = all_coefficients.size();
[[nodiscard]] Coefficient coefficient_of(Effect effect) noexcept;

enum class FsForm : std::uint8_t { printed, reciprocal };
/// Oren & Nayar's ladder: the integral over grooves, its functional fit, and that without all but the leading terms.
enum class RoughForm : std::uint8_t { integral, functional, qualitative };
/// How shadowing and effective roughness of an anisotropic surface read the azimuth: by the slope that the direction
/// meets, or by Li & Torrance's (25) as printed, which contradicts their distribution.
enum class AnisotropyForm : std::uint8_t { consistent, printed };

struct Forms {
  FsForm fs = FsForm::printed;
  RoughForm rough = RoughForm::functional;
  AnisotropyForm anisotropy = AnisotropyForm::consistent;
  friend bool operator==(const Forms&, const Forms&) = default;
};

struct Terms {
  FresnelTier fresnel = FresnelTier::schlick;
  ShadowingTier shadowing = ShadowingTier::li_torrance;
  EffectiveRoughnessTier effective_roughness = EffectiveRoughnessTier::li_torrance;
  DistributionTier distribution = DistributionTier::rough_limit;
  friend bool operator==(const Terms&, const Terms&) = default;
};

/// Names as files and flags spell them ("li-torrance"), and back; nullopt for a name that is no tier.
[[nodiscard]] std::string_view name_of(Effect) noexcept;
[[nodiscard]] std::string_view name_of(Coefficient) noexcept;
[[nodiscard]] std::string_view name_of(FresnelTier) noexcept;
[[nodiscard]] std::string_view name_of(ShadowingTier) noexcept;
[[nodiscard]] std::string_view name_of(EffectiveRoughnessTier) noexcept;
[[nodiscard]] std::string_view name_of(DistributionTier) noexcept;
[[nodiscard]] std::string_view name_of(FsForm) noexcept;
[[nodiscard]] std::string_view name_of(RoughForm) noexcept;
[[nodiscard]] std::string_view name_of(AnisotropyForm) noexcept;
/// E is any of the enumerations above.
template <class E>
[[nodiscard]] std::optional<E> parse_name(std::string_view name) noexcept;
/// "schlick, exact or none": what to offer in a message.
template <class E>
[[nodiscard]] std::string names_of();

/// Shape of the surface, shared by all channels. Lengths in µm. Null is "not determined" (without coh or the
/// distribution of He et al. the data know only the slope sigma/tau) or "not of this surface".
struct Surface {
  std::optional<double> slope{};            ///< m = sigma / tau; the Beckmann roughness is 2 m
  std::optional<double> sigma_um{};         ///< RMS height
  std::optional<double> tau_um{};           ///< correlation length
  std::optional<double> slope_y{};          ///< anisotropic only: sigma / tau_y, while slope and tau are those along x
  std::optional<double> tau_y_um{};         ///< anisotropic only
  std::optional<double> tail{};             ///< gamma > 1 of student-t: 2 is GGX, infinity Beckmann
  std::optional<double> facet_slope_deg{};  ///< of rough: standard deviation of the facets' slope angle

  [[nodiscard]] bool anisotropic() const noexcept { return slope_y.has_value(); }
  /// The parameter of that name ("tail"), or null where there is none of it.
  [[nodiscard]] std::optional<double>* find(std::string_view name) noexcept;
  friend bool operator==(const Surface&, const Surface&) = default;
};
inline constexpr std::array<std::string_view, 7> surface_parameter_names{
    "slope", "sigma_um", "tau_um", "slope_y", "tau_y_um", "tail", "facet_slope_deg"};

struct MaterialChannel {
  std::string name;
  std::optional<double> wavelength_um;  ///< needed by coh only
  std::optional<double> n, kappa;       ///< refractive index n + i kappa
  std::optional<double> f0;             ///< normal-incidence reflectance, instead of n and kappa (schlick only)
  /// By Coefficient; null is "not determined by the scan" and evaluates as 0.
  std::array<std::optional<double>, coefficient_count> k{};
  std::map<std::string, std::optional<double>> peer_k{};  ///< of a peer model, by its coefficients' names

  [[nodiscard]] std::optional<double>& coefficient(Coefficient c) { return k[static_cast<std::size_t>(c)]; }
  [[nodiscard]] const std::optional<double>& coefficient(Coefficient c) const { return k[static_cast<std::size_t>(c)]; }
  /// By name: of the effects ("k_dd") or of a peer; nullopt where it is not given.
  [[nodiscard]] std::optional<double> coefficient(std::string_view name) const;
  void set_coefficient(const std::string& name, std::optional<double> value);
  /// F at normal incidence, from f0 or from n and kappa (0 where unset); 0 where neither is known, which validate()
  /// lets pass only where nothing reads it.
  [[nodiscard]] double normal_reflectance() const noexcept;
  friend bool operator==(const MaterialChannel&, const MaterialChannel&) = default;
};

struct Interval {
  double lower = 0.0, upper = 0.0;
  friend bool operator==(const Interval&, const Interval&) = default;
};

/// What the fit that made the material says of itself; absent in a hand-written one.
struct FitSummary {
  double loss = 0.0;  ///< sum over samples and channels of cos(theta_i) |f_model - f_measured|², not halved
  double rms = 0.0;   ///< sqrt(loss / (samples * channels))
  std::size_t samples = 0;
  bool converged = false;
  std::map<std::string, double> shared_uncertainty;                          ///< by parameter: "slope"
  std::map<std::string, std::map<std::string, double>> channel_uncertainty;  ///< by channel, then parameter
  std::map<std::string, bool> identifiable;                                  ///< by parameter: "slope", "R.k_fs"
  std::string uncertainty_from;  ///< "readings", "residuals" or "incidence angles"; empty where it is not said
  std::map<std::string, Interval> interval_95;  ///< by parameter, likewise
  friend bool operator==(const FitSummary&, const FitSummary&) = default;
};

inline constexpr double default_solid_angle_sr = 0.0005;
/// The slopes that a material may have; a fit's own bounds are narrower (slope_min in fit/settings.h).
inline constexpr double smallest_slope = 1e-6, largest_slope = 10.0;
inline constexpr double largest_facet_slope_deg = 80.0;
/// "surface" is this family; every other name is a peer of peers/peers.h.
inline constexpr std::string_view surface_model = "surface";

struct Material {
  std::string name;
  std::string model{surface_model};
  EffectSet components;  ///< of the surface family; empty for a peer, as is `surface`
  Terms terms;           ///< a peer reads the Fresnel tier alone
  Surface surface;
  std::map<std::string, std::optional<double>> parameters;  ///< shape of a peer, by name
  Forms forms;
  std::vector<MaterialChannel> channels;
  double solid_angle_sr = default_solid_angle_sr;  ///< of the source, for coh
  std::optional<FitSummary> fit;
  friend bool operator==(const Material&, const Material&) = default;
};

/// Throws Error (bad_input) with the key and the constraint when the material cannot be evaluated: `where` is the file
/// it came from (empty: none). Checks ranges, slope = sigma/tau to 1e-6, names, and that everything is there that the
/// terms read of effects with a coefficient other than 0, or the peer model.
void validate(const Material& material, const std::string& where);

}  // namespace goniofit
