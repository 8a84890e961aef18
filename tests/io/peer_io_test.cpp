// Peer models as materials in JSON.

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "basis/basis.h"
#include "io/material_io.h"
#include "peers/peers.h"
#include "support/error_message.h"
#include "support/replaced.h"
#include "support/text.h"

namespace goniofit {

namespace {

using test::error_message;
using test::replaced;

// "\"r\": 1e-05, \"p\": 0.01" of a peer.
std::string lower_bounds(std::string_view model) {
  std::string text;
  const auto basis = make_peer(model);
  for (const ShapeParameter& p : basis->shape_parameters()) {
    text += (text.empty() ? "\"" : ", \"") + p.name + "\": " + shortest(p.lower);
  }
  return text;
}

const std::string ward = R"({
  "format": "goniofit-material",
  "version": 1,
  "name": "lacquer",
  "model": "ward-anisotropic",
  "terms": {
    "fresnel": "schlick"
  },
  "parameters": {
    "alpha_x": 0.1,
    "alpha_y": 0.25
  },
  "channels": [
    {
      "name": "R",
      "wavelength_um": null,
      "n": null,
      "kappa": null,
      "k_d": 0.25,
      "k_s": null
    },
    {
      "name": "G",
      "wavelength_um": 0.55,
      "f0": 0.04,
      "k_d": 0.5,
      "k_s": 0.125
    }
  ],
  "solid_angle_sr": 0.0005,
  "fit": {
    "loss": 0.25,
    "rms": 0.5,
    "samples": 1,
    "converged": true,
    "uncertainty": {
      "alpha_x": 0.001,
      "G": {
        "k_s": 0.01
      }
    },
    "identifiable": {
      "R.k_s": false,
      "alpha_x": true
    }
  }
}
)";

TEST(PeerIo, ReadsAndWritesTheDocumentedText) {
  const Material m = parse_material(ward, "m.json");
  EXPECT_EQ(m.model, "ward-anisotropic");
  EXPECT_TRUE(m.components.empty());
  EXPECT_EQ(m.parameters, (std::map<std::string, std::optional<double>>{{"alpha_x", 0.1}, {"alpha_y", 0.25}}));
  EXPECT_EQ(m.channels[1].coefficient("k_s"), 0.125);
  EXPECT_EQ(m.channels[0].peer_k.at("k_s"), std::nullopt);
  EXPECT_EQ(to_json(m), ward);
}

TEST(PeerIo, AnEmptyListOfComponentsIsAccepted) {
  const Material m = parse_material(replaced(ward, "\"terms\"", "\"components\": [], \"terms\""), "m.json");
  EXPECT_EQ(m, parse_material(ward, "m.json"));
}

TEST(PeerIo, WhatIsOfTheSurfaceAloneIsRefused) {
  const auto complaint = [](const std::string& from, const std::string& to) {
    return error_message([&] { (void)parse_material(replaced(ward, from, to), "m.json"); });
  };
  const std::string keys =
      "is not a known key, expected format, version, name, model, components, terms, parameters, channels, "
      "solid_angle_sr or fit";
  EXPECT_EQ(complaint("\"terms\"", "\"surface\": {\"slope\": 0.1}, \"terms\""), "2 m.json: /surface: " + keys);
  EXPECT_EQ(complaint("\"terms\"", "\"forms\": {}, \"terms\""), "2 m.json: /forms: " + keys);
  EXPECT_EQ(complaint("\"terms\"", "\"components\": [\"dd\"], \"terms\""),
            "2 m.json: /components: are named though the model is ward-anisotropic, which has no effects");
  EXPECT_EQ(complaint("\"fresnel\"", "\"shadowing\""),
            "2 m.json: /terms/shadowing: is not a known key, expected fresnel");
  EXPECT_EQ(complaint("\"alpha_y\"", "\"alpha\""),
            "2 m.json: /parameters/alpha_y: is not given, expected a number: ward-anisotropic reads it");
  EXPECT_EQ(complaint("\"alpha_y\"", "\"alpha\": 1, \"alpha_y\""),
            "2 m.json: /parameters/alpha: is not a parameter of ward-anisotropic");
  EXPECT_EQ(complaint("0.25\n  }", "\"0.25\"\n  }"),
            "2 m.json: /parameters/alpha_y: is a string, expected a number or null");
  EXPECT_EQ(complaint("\"k_s\": null", "\"k_dd\": null"),
            "2 m.json: /channels/0/k_dd: is not a known key, expected name, wavelength_um, n, kappa, f0, k_d or k_s");
  EXPECT_EQ(complaint("ward-anisotropic", "phong"),
            "2 m.json: /model: \"phong\" is no model, expected one that `goniofit models` names");
}

TEST(PeerIo, EveryModelOfTheCatalogueHasAFile) {
  for (const PeerInfo& info : peer_catalogue()) {
    const Material m = parse_material("{\"format\": \"goniofit-material\", \"version\": 1, \"model\": \"" +
                                          std::string(info.name) + "\", \"parameters\": {" + lower_bounds(info.name) +
                                          "}, \"channels\": [{\"name\": \"R\", \"n\": 1.5}]}",
                                      "m.json");
    EXPECT_EQ(m.model, info.name);
    EXPECT_EQ(parse_material(to_json(m), "m.json"), m) << info.name;
  }
}

}  // namespace
}  // namespace goniofit
