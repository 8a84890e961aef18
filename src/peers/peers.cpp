#include "peers/peers.h"

#include <array>

#include "peers/blinn_phong.h"
#include "peers/cook_torrance.h"
#include "peers/ggx.h"
#include "peers/lafortune.h"
#include "peers/lambert.h"
#include "peers/neumann_neumann.h"
#include "peers/schlick.h"
#include "peers/ward.h"

namespace goniofit {

namespace {

using Maker = std::unique_ptr<const Basis> (*)(double solid_angle_sr);

template <std::unique_ptr<const Basis> (*make)()>
std::unique_ptr<const Basis> plain(double /*solid_angle_sr*/) {
  return make();
}
template <std::size_t lobes>
std::unique_ptr<const Basis> lafortune(double /*solid_angle_sr*/) {
  return make_lafortune(lobes);
}
template <SchlickAzimuth form>
std::unique_ptr<const Basis> schlick_single(double solid_angle_sr) {
  return make_schlick_single(form, solid_angle_sr);
}
template <SchlickAzimuth form>
std::unique_ptr<const Basis> schlick_double(double solid_angle_sr) {
  return make_schlick_double(form, solid_angle_sr);
}

constexpr std::string_view lafortune_paper = "Lafortune, Foo, Torrance & Greenberg 1997";
constexpr std::string_view schlick_paper = "Schlick 1994 (22)-(33)";

constexpr std::array catalogue{
    PeerInfo{"lambert", "the same in every direction", "Lambert 1760"},
    PeerInfo{"blinn-phong", "Lambert + normalised cosine lobe about the half vector", "Blinn 1977; Ngan et al. 2005"},
    PeerInfo{"neumann-neumann", "Lambert + mirror lobe over the greater cosine",
             "Neumann, Neumann & Szirmay-Kalos 1999"},
    PeerInfo{"lafortune-1", "Lambert + one generalised cosine lobe", lafortune_paper},
    PeerInfo{"lafortune-2", "Lambert + two generalised cosine lobes", lafortune_paper},
    PeerInfo{"lafortune-3", "Lambert + three generalised cosine lobes", lafortune_paper},
    PeerInfo{"ward", "Lambert + Gaussian lobe over sqrt(cos cos)", "Ward 1992"},
    PeerInfo{"ward-anisotropic", "the same with two widths", "Ward 1992"},
    PeerInfo{"cook-torrance", "Lambert + Fresnel, Beckmann facets, V-cavity shadowing", "Cook & Torrance 1982"},
    PeerInfo{"ggx", "Lambert + Fresnel, GGX facets, height-correlated Smith shadowing",
             "Walter et al. 2007; Heitz 2014"},
    PeerInfo{"ggx-anisotropic", "the same with two widths", "Walter et al. 2007; Heitz 2014"},
    PeerInfo{"schlick-single", "one material C, r, p; normalised A(w)", schlick_paper},
    PeerInfo{"schlick-single-printed", "the same with A(w) as printed", schlick_paper},
    PeerInfo{"schlick-single-isotropic", "the same with p = 1", schlick_paper},
    PeerInfo{"schlick-double", "a clear layer r_1, p_1 over a material C_2, r_2, p_2; normalised A(w)", schlick_paper},
    PeerInfo{"schlick-double-printed", "the same with A(w) as printed", schlick_paper},
    PeerInfo{"schlick-double-isotropic", "the same with p_1 = p_2 = 1", schlick_paper},
};

// In the order of the catalogue.
constexpr std::array<Maker, catalogue.size()> makers{plain<make_lambert>,
                                                     plain<make_blinn_phong>,
                                                     plain<make_neumann_neumann>,
                                                     lafortune<1>,
                                                     lafortune<2>,
                                                     lafortune<3>,
                                                     plain<make_ward>,
                                                     plain<make_ward_anisotropic>,
                                                     plain<make_cook_torrance>,
                                                     plain<make_ggx>,
                                                     plain<make_ggx_anisotropic>,
                                                     schlick_single<SchlickAzimuth::normalised>,
                                                     schlick_single<SchlickAzimuth::printed>,
                                                     schlick_single<SchlickAzimuth::isotropic>,
                                                     schlick_double<SchlickAzimuth::normalised>,
                                                     schlick_double<SchlickAzimuth::printed>,
                                                     schlick_double<SchlickAzimuth::isotropic>};

}  // namespace

std::span<const PeerInfo> peer_catalogue() noexcept { return catalogue; }

std::unique_ptr<const Basis> make_peer(std::string_view model, double solid_angle_sr) {
  for (std::size_t i = 0; i < catalogue.size(); ++i) {
    if (catalogue[i].name == model) return makers[i](solid_angle_sr);
  }
  return nullptr;
}

}  // namespace goniofit
