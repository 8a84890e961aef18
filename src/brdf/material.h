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

/// The effects of Li & Torrance 2005, section 2.
enum class Effect : std::uint8_t {
  coh,  ///< coherent (mirror) reflection, k_dd F S exp(-g) / (cos_i dOmega) inside the mirror cone
  dd,   ///< directional-diffuse reflection of the rough surface, k_dd F S D / (pi cos_i cos_r)
  udf,  ///< uniform-diffuse reflection, k_udf / pi
  uds,  ///< uniform-diffuse light from below the surface, k_uds / pi T(cos_i) T(cos_r)
  fs    ///< forward scattering from below the surface
};
inline constexpr std::array all_effects{Effect::coh, Effect::dd, Effect::udf, Effect::uds, Effect::fs};

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

/// The linear coefficients. coh and dd share k_dd.
enum class Coefficient : std::uint8_t { k_dd, k_udf, k_uds, k_fs };
inline constexpr std::array all_coefficients{Coefficient::k_dd, Coefficient::k_udf, Coefficient::k_uds,
                                             Coefficient::k_fs};
inline constexpr std::size_t coefficient_count = all_coefficients.size();
[[nodiscard]] Coefficient coefficient_of(Effect effect) noexcept;

enum class FsForm : std::uint8_t { printed, reciprocal };

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
/// E is any of the enumerations above.
template <class E>
[[nodiscard]] std::optional<E> parse_name(std::string_view name) noexcept;
/// "schlick, exact or none": what to offer in a message.
template <class E>
[[nodiscard]] std::string names_of();

/// Shape of the surface, shared by all channels. Lengths in µm. Null is "not determined": without coh, the data know
/// only the slope sigma/tau.
struct Surface {
  std::optional<double> slope;     ///< m = sigma / tau; the Beckmann roughness is 2 m
  std::optional<double> sigma_um;  ///< RMS height
  std::optional<double> tau_um;    ///< correlation length
  friend bool operator==(const Surface&, const Surface&) = default;
};

struct MaterialChannel {
  std::string name;
  std::optional<double> wavelength_um;  ///< needed by coh only
  std::optional<double> n, kappa;       ///< refractive index n + i kappa
  std::optional<double> f0;             ///< normal-incidence reflectance, instead of n and kappa (schlick only)
  /// By Coefficient; null is "not determined by the scan" and evaluates as 0.
  std::array<std::optional<double>, coefficient_count> k{};

  [[nodiscard]] std::optional<double>& coefficient(Coefficient c) { return k[static_cast<std::size_t>(c)]; }
  [[nodiscard]] const std::optional<double>& coefficient(Coefficient c) const { return k[static_cast<std::size_t>(c)]; }
  /// F at normal incidence, from f0 or from n and kappa (0 where unset); 0 where neither is known, which validate()
  /// lets pass only where nothing reads it.
  [[nodiscard]] double normal_reflectance() const noexcept;
  friend bool operator==(const MaterialChannel&, const MaterialChannel&) = default;
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
  friend bool operator==(const FitSummary&, const FitSummary&) = default;
};

inline constexpr double default_solid_angle_sr = 0.0005;
/// The slopes that a material may have; a fit's own bounds are narrower (slope_min in fit/settings.h).
inline constexpr double smallest_slope = 1e-6, largest_slope = 10.0;

struct Material {
  std::string name;
  EffectSet components;
  Terms terms;
  Surface surface;
  FsForm fs_form = FsForm::printed;
  std::vector<MaterialChannel> channels;
  double solid_angle_sr = default_solid_angle_sr;  ///< of the source, for coh
  std::optional<FitSummary> fit;
  friend bool operator==(const Material&, const Material&) = default;
};

/// Throws Error (bad_input) with the key and the constraint when the material cannot be evaluated: `where` is the file
/// it came from (empty: none). Checks ranges, slope = sigma/tau to 1e-6, channel names, and what each effect with a
/// coefficient other than 0 reads: coh, dd, fs the slope; coh sigma and the wavelength; all but udf n or f0, exact n.
void validate(const Material& material, const std::string& where);

}  // namespace goniofit
