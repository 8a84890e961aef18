// The laws of every model: the effects, the tiers of their terms, isotropic and not, the paper's samples and the peers.
// Where a model breaks one, the number stated here was measured; the paper or the tier's own header explains it.

#include "support/laws.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "peers/peers.h"
#include "support/materials.h"

namespace goniofit::test {
namespace {

Irreciprocity of_fs(double of_largest) { return {in_plane_grid(), of_largest}; }
// c_r/c_i across it: LT's coh, and Schlick's Delta where it is more than the lobe around it.
Irreciprocity of_mirror_cone(double of_largest) { return {edge_of_mirror_cone(), of_largest}; }

template <class Change>
Material changed(Material m, const Change& change) {
  change(m);
  return m;
}

Material with_components(Material m, EffectSet components) {
  m.components = components;
  return m;
}

// Everything that any effect reads; the k's sum up to 1.
Material everything() {
  Material m;
  m.name = "everything";
  m.surface = {.slope = 0.1, .sigma_um = 0.05, .tau_um = 0.5, .facet_slope_deg = 25.0};
  for (const Effect e : all_effects) m.components.insert(e);
  m.channels = {channel("R", 0.65, 1.5, 0.0, 0.3, 0.1, 0.2, 1.0)};
  m.channels[0].coefficient(Coefficient::rho) = 0.2;
  return m;
}

Material one_effect(Effect effect) {
  Material m = with_components(everything(), {effect});
  m.channels[0].coefficient(coefficient_of(effect)) = 1.0;
  return m;
}

Material white_rough(RoughForm form) {
  return changed(one_effect(Effect::rough), [&](Material& m) { m.forms.rough = form; });
}

Material reciprocal_fs(Material m) {
  m.forms.fs = FsForm::reciprocal;
  return m;
}

Material anisotropic(Material m, double slope_y) {
  m.surface.slope_y = slope_y;
  m.surface.tau_y_um.reset();
  return m;
}

Material printed_lengths(Material m) {
  m.forms.anisotropy = AnisotropyForm::printed;
  return m;
}

GONIOFIT_LAWS(Effects, {.name = "coh", .material = one_effect(Effect::coh), .irreciprocity = of_mirror_cone(0.072)},
              {.name = "dd", .material = one_effect(Effect::dd)}, {.name = "udf", .material = one_effect(Effect::udf)},
              {.name = "uds", .material = one_effect(Effect::uds)},
              {.name = "fs_printed", .material = one_effect(Effect::fs), .irreciprocity = of_fs(0.735)},
              {.name = "fs_reciprocal", .material = reciprocal_fs(one_effect(Effect::fs))});

// The integral's direct part is 1 and what is missing of it, to 1e-15: towards double forward grazing no digit is left.
GONIOFIT_LAWS(Rough,
              {.name = "functional",
               .material = white_rough(RoughForm::functional),
               .conserves_up_to_deg = 80.0,
               .excess = {{85.0, 0.0, 1.0083}, {89.0, 0.0, 1.0278}}},
              {.name = "qualitative", .material = white_rough(RoughForm::qualitative)},
              {.name = "integral",
               .material = white_rough(RoughForm::integral),
               .precision = 3e-6,
               .derivative_precision = 1e-3,
               .differentiable_above = 1e-6,
               .directions = 30});

// All six at once. At 80 degrees the mirror cone holds 50 times the light of what lies around it.
GONIOFIT_LAWS(Together, {.name = "printed", .material = everything(), .irreciprocity = of_mirror_cone(0.0711)},
              {.name = "reciprocal", .material = reciprocal_fs(everything()), .irreciprocity = of_mirror_cone(0.0711)},
              {.name = "exact_fresnel",
               .material = changed(reciprocal_fs(everything()),
                                   [](Material& m) {
                                     m.terms.fresnel = FresnelTier::exact;
                                     m.channels[0].kappa = 0.7;
                                   }),
               .irreciprocity = of_mirror_cone(0.0711)},
              {.name = "without_fresnel",
               .material = changed(reciprocal_fs(everything()),
                                   [](Material& m) { m.terms.fresnel = FresnelTier::none; }),
               .irreciprocity = of_mirror_cone(0.0711)},
              {.name = "anisotropic",
               .material = anisotropic(reciprocal_fs(everything()), 0.02),
               .irreciprocity = of_mirror_cone(0.0711)},
              {.name = "he_torrance",
               .material = changed(reciprocal_fs(everything()), [](Material& m) { m.terms = he_torrance_terms(); }),
               .irreciprocity = of_mirror_cone(0.0711)});

// dd alone with F = 1 and k_dd = 1: what the tiers themselves reflect.
Material white_dd(double slope, const Terms& terms = {}) {
  Material m = with_components(everything(), {Effect::dd});
  m.terms = terms;
  m.terms.fresnel = FresnelTier::none;
  m.surface = {.slope = slope, .sigma_um = 0.1};
  m.channels[0].coefficient(Coefficient::k_dd) = 1.0;
  return m;
}

struct Distribution {
  std::string name;
  DistributionTier tier;
  double tail;
};
const std::vector<Distribution>& distributions() {
  using enum DistributionTier;
  static const std::vector<Distribution> all{{"rough_limit", rough_limit, 0.0},
                                             {"he_torrance", he_torrance, 0.0},
                                             {"he_torrance_series", he_torrance_series, 0.0},
                                             {"student_t_1_2", student_t, 1.2},
                                             {"student_t_2", student_t, 2.0},
                                             {"student_t_50", student_t, 50.0},
                                             {"student_t_million", student_t, 1e6}};
  return all;
}

std::string identifier(std::string_view name) {
  std::string out(name);
  for (char& c : out) {
    if (c == '-') c = '_';
  }
  return out;
}

// Without shadowing every distribution of rays reflects more at 85 degrees than it receives; so do, with LT's S1, which
// is Gaussian, the slopes of a tail of 1.2, whose mean is infinite. By sigma_e: LT's, He's, none.
std::vector<Excess> excess_of(const Terms& terms, const Distribution& d) {
  const auto roughness = static_cast<std::size_t>(terms.effective_roughness);
  const auto at_85 = [roughness](std::array<double, 3> albedo) {
    return std::vector<Excess>{{85.0, 0.0, albedo[roughness]}};
  };
  if (terms.shadowing == ShadowingTier::none) {
    if (d.name == "student_t_1_2") return at_85({5.402, 5.680, 6.707});
    if (d.name == "student_t_2") return at_85({2.175, 2.116, 2.743});
    if (d.name == "student_t_50") return at_85({1.582, 1.513, 1.843});
    if (d.name == "rough_limit" || d.name == "student_t_million") return at_85({1.575, 1.506, 1.833});
  }
  if (terms.shadowing == ShadowingTier::li_torrance && d.name == "student_t_1_2") return at_85({1.231, 1.238, 1.397});
  return {};
}

std::vector<LawCase> every_tier() {
  std::vector<LawCase> out;
  for (const Distribution& d : distributions()) {
    for (const ShadowingTier shadowing :
         {ShadowingTier::li_torrance, ShadowingTier::smith, ShadowingTier::schlick, ShadowingTier::none}) {
      if (shadowing == ShadowingTier::smith && d.tail == 1.2) continue;  // such a surface shadows itself entirely
      for (const EffectiveRoughnessTier roughness :
           {EffectiveRoughnessTier::li_torrance, EffectiveRoughnessTier::he, EffectiveRoughnessTier::none}) {
        LawCase c;
        const Terms terms{FresnelTier::none, shadowing, roughness, d.tier};
        c.name = d.name + "_S_" + identifier(name_of(shadowing)) + "_sigma_e_" + identifier(name_of(roughness));
        c.material = white_dd(0.2, terms);
        if (d.tail > 0.0) c.material.surface.tail = d.tail;
        c.excess = excess_of(terms, d);
        if (!c.excess.empty()) c.conserves_up_to_deg = 60.0;
        c.directions = 200;
        out.push_back(std::move(c));
      }
    }
  }
  return out;
}

GONIOFIT_LAWS(Tiers, every_tier());

// Slopes at which what matters differs: facets that all see the sky, and facets as steep as a roof.
GONIOFIT_LAWS(Slopes, {.name = "mirror_like", .material = white_dd(0.002), .conserves_up_to_deg = 89.0},
              {.name = "smooth", .material = white_dd(0.02), .conserves_up_to_deg = 89.0},
              {.name = "rough", .material = white_dd(0.6), .conserves_up_to_deg = 89.0},
              {.name = "steep", .material = white_dd(2.0), .conserves_up_to_deg = 89.0},
              {.name = "steep_smith",
               .material = white_dd(2.0, {.shadowing = ShadowingTier::smith}),
               .conserves_up_to_deg = 89.0},
              {.name = "ground_glass_as_published_but_for_S_and_sigma_e",
               .material = white_dd(0.172, {.shadowing = ShadowingTier::none,
                                            .effective_roughness = EffectiveRoughnessTier::none}),
               .conserves_up_to_deg = 60.0,
               .excess = {{85.0, 0.0, 1.660}, {89.9, 0.0, 56.1}}});

Material long_tailed(double slope) {
  Material m = white_dd(slope, {.shadowing = ShadowingTier::smith, .distribution = DistributionTier::student_t});
  m.surface.tail = 2.5;
  return m;
}

// Brushed metal, light along the grooves, across and between. LT (25) as printed lets too much light out between.
GONIOFIT_LAWS(
    Anisotropic, {.name = "ratio_4", .material = anisotropic(white_dd(0.1), 0.025)},
    {.name = "ratio_10", .material = anisotropic(white_dd(0.1), 0.01), .conserves_up_to_deg = 89.0},
    {.name = "ratio_half", .material = anisotropic(white_dd(0.3), 0.6)},
    {.name = "ratio_4_printed", .material = printed_lengths(anisotropic(white_dd(0.1), 0.025))},
    {.name = "ratio_4_printed_without_sigma_e",
     .material = printed_lengths(anisotropic(white_dd(0.1, {.effective_roughness = EffectiveRoughnessTier::none}),
                                             0.025)),
     .excess = {{89.5, 45.0, 1.146}}},
    {.name = "ratio_10_printed",
     .material = printed_lengths(anisotropic(white_dd(0.1), 0.01)),
     .conserves_up_to_deg = 80.0,
     .excess = {{88.0, 42.5, 1.462}}},
    {.name = "he_torrance", .material = anisotropic(white_dd(0.2, he_torrance_terms()), 0.05)},
    {.name = "student_t", .material = anisotropic(long_tailed(0.2), 0.05)},
    {.name = "fs_printed", .material = anisotropic(one_effect(Effect::fs), 0.3), .irreciprocity = of_fs(0.735)},
    {.name = "fs_reciprocal", .material = anisotropic(reciprocal_fs(one_effect(Effect::fs)), 0.3)},
    {.name = "brushed_aluminium", .material = brushed_aluminium()});

// The rough limit's dd has all of the reflected light already, so that smooth aluminium's coh comes on top of it.
GONIOFIT_LAWS(Samples,
              {.name = "garnet_red_paint_13", .material = garnet_red_paint_13(), .irreciprocity = of_fs(3.45e-4)},
              {.name = "laser_paper_73", .material = laser_paper_73(), .irreciprocity = of_fs(9.07e-4)},
              {.name = "fs_of_laser_paper_73",
               .material = with_components(laser_paper_73(), {Effect::fs}),
               .irreciprocity = of_fs(0.86)},
              {.name = "ground_glass_41", .material = ground_glass_41(), .conserves_up_to_deg = 89.0},
              {.name = "smooth_aluminium_45",
               .material = smooth_aluminium_45(),
               .conserves_up_to_deg = 60.0,
               .excess = {{80.0, 0.0, 1.345}, {85.0, 0.0, 1.617}},
               .irreciprocity = of_mirror_cone(0.0584)},
              {.name = "smooth_aluminium_45_by_he",
               .material = changed(smooth_aluminium_45(), [](Material& m) { m.terms = he_torrance_terms(); }),
               .irreciprocity = of_mirror_cone(0.072)},
              {.name = "ground_glass_41_by_he", .material = he_ground_glass()},
              {.name = "rough_plaster", .material = rough_plaster()},
              {.name = "long_tailed_paint", .material = reciprocal_fs(long_tailed_paint())});

using Shape = std::map<std::string, std::optional<double>>;

struct PeerCase {
  std::string name, model;
  Shape shape, k;
  double conserves_from_deg = 0.0, conserves_up_to_deg = 89.0;
  std::vector<Excess> excess{};
  double across_mirror_cone = 0.0;
};

LawCase of_peer(const PeerCase& p) {
  LawCase c;
  c.name = p.name;
  c.material.name = p.name;
  c.material.model = p.model;
  c.material.parameters = p.shape;
  c.material.terms.fresnel = p.model.starts_with("schlick-double") ? FresnelTier::exact : FresnelTier::none;
  c.material.channels = {channel("R", 0.55, 1.5, 0.0, 0.0, 0.0, 0.0, 0.0)};
  c.material.channels[0].k = {};
  c.material.channels[0].peer_k = p.k;
  c.conserves_from_deg = p.conserves_from_deg;
  c.conserves_up_to_deg = p.conserves_up_to_deg;
  c.excess = p.excess;
  if (p.across_mirror_cone > 0.0) c.irreciprocity = of_mirror_cone(p.across_mirror_cone);
  return c;
}

// Strength 1 in all: a tenth to Lambert's part.
const Shape with_base{{"k_d", 0.1}, {"k_s", 0.9}};
const Shape white_layer{{"C", 1.0}};
const Shape grey_layer{{"C_2", 0.6}};
const Shape two_layers{{"r_1", 0.1}, {"p_1", 0.4}, {"r_2", 0.7}, {"p_2", 0.8}};

const Shape two_lobes{
    {"exponent_1", 20.0}, {"normal_to_grazing_1", 1.0}, {"exponent_2", 500.0}, {"normal_to_grazing_2", 0.3}};

Shape three_lobes() {
  Shape all = two_lobes;
  all.insert({{"exponent_3", 5000.0}, {"normal_to_grazing_3", 3.0}});
  return all;
}

// Schlick's shadowed light has no bound towards grazing (energy_test). Where r < 1/2 his mirror is not reciprocal: the
// numbers are small at r of 0.3, whose mirror has (1 - 2r)² = 0.16 of the light; in the double model the clear layer's
// mirror reflects F, about 0.4 at 80 degrees.
std::vector<PeerCase> peer_cases() {
  return {
      {"lambert", "lambert", {}, {{"k_d", 1.0}}},
      {"blinn_phong",
       "blinn-phong",
       {{"exponent", 300.0}},
       with_base,
       75.0,
       89.0,
       {{0.0, 0.0, 3.65}, {60.0, 0.0, 1.006}}},
      {"neumann_neumann", "neumann-neumann", {{"exponent", 60.0}}, with_base},
      {"lafortune_1", "lafortune-1", {{"exponent", 60.0}, {"normal_to_grazing", 1.0}}, with_base},
      {"lafortune_1_at_the_normal",
       "lafortune-1",
       {{"exponent", 1000.0}, {"normal_to_grazing", 50.0}},
       with_base,
       30.0,
       89.0,
       {{0.0, 0.0, 1.865}}},
      {"lafortune_2", "lafortune-2", two_lobes, {{"k_d", 0.1}, {"k_s_1", 0.5}, {"k_s_2", 0.3}}},
      {"lafortune_3", "lafortune-3", three_lobes(), {{"k_d", 0.1}, {"k_s_1", 0.4}, {"k_s_2", 0.2}, {"k_s_3", 0.1}}},
      {"ward", "ward", {{"alpha", 0.2}}, with_base},
      {"ward_anisotropic", "ward-anisotropic", {{"alpha_x", 0.3}, {"alpha_y", 0.05}}, with_base},
      {"cook_torrance", "cook-torrance", {{"m", 0.2}}, with_base},
      {"ggx", "ggx", {{"alpha", 0.2}}, with_base},
      {"ggx_anisotropic", "ggx-anisotropic", {{"alpha_x", 0.3}, {"alpha_y", 0.05}}, with_base},
      {"schlick_single",
       "schlick-single",
       {{"r", 0.3}, {"p", 0.4}},
       white_layer,
       0.0,
       30.0,
       {{85.0, 90.0, 4.877}},
       0.072},
      {"schlick_single_printed",
       "schlick-single-printed",
       {{"r", 0.3}, {"p", 0.4}},
       white_layer,
       0.0,
       30.0,
       {{85.0, 90.0, 4.763}},
       0.072},
      {"schlick_single_isotropic",
       "schlick-single-isotropic",
       {{"r", 0.3}},
       white_layer,
       0.0,
       30.0,
       {{85.0, 0.0, 4.705}},
       0.072},
      {"schlick_single_half",
       "schlick-single-isotropic",
       {{"r", 0.501}},
       white_layer,
       0.0,
       30.0,
       {{85.0, 0.0, 5.627}, {60.0, 0.0, 1.026}}},
      {"schlick_single_diffuse",
       "schlick-single-isotropic",
       {{"r", 0.7}},
       white_layer,
       0.0,
       30.0,
       {{85.0, 0.0, 4.948}}},
      {"schlick_double", "schlick-double", two_layers, grey_layer, 0.0, 30.0, {{85.0, 90.0, 3.348}}, 0.072},
      {"schlick_double_printed",
       "schlick-double-printed",
       two_layers,
       grey_layer,
       0.0,
       30.0,
       {{85.0, 90.0, 3.336}},
       0.072},
      {"schlick_double_isotropic",
       "schlick-double-isotropic",
       {{"r_1", 0.1}, {"r_2", 0.7}},
       grey_layer,
       0.0,
       30.0,
       {{85.0, 0.0, 3.331}},
       0.072},
  };
}

std::vector<LawCase> every_peer() {
  std::vector<LawCase> out;
  for (const PeerCase& p : peer_cases()) out.push_back(of_peer(p));
  return out;
}

GONIOFIT_LAWS(Peers, every_peer());

TEST(LawsOfPeers, LeaveNoPeerOut) {
  for (const PeerInfo& info : peer_catalogue()) {
    const std::vector<PeerCase> all = peer_cases();
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const PeerCase& p) { return p.model == info.name; }))
        << info.name;
  }
}

}  // namespace
}  // namespace goniofit::test
