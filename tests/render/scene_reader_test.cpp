// Scenes as users write them: what is read, and the words for what is not.

#include "render/scene_reader.h"

#include <gtest/gtest.h>

#include "io/material_io.h"
#include "render/exr_image.h"
#include "render/obj_reader.h"
#include "render_support.h"
#include "support/error.h"
#include "support/output_file.h"
#include "support/paths.h"

namespace goniofit::test {
namespace {

const std::string camera = "[camera]\nposition = [0, -5, 1]\nlook_at = [0, 0, 0]\n";
const std::string materials = "[materials]\nwhite = {reflectance = 0.5}\n";
const std::string sphere = "[[objects]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"white\"\n";
const std::string lamp = "[[lights]]\ntype = \"point\"\nposition = [0, -5, 5]\nintensity = 10\n";

std::string complaint(const std::string& toml, const std::filesystem::path& source = "s.toml") {
  try {
    (void)parse_scene(toml, source);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input) << error.what();
    return error.what();
  }
  return "nothing is wrong";
}

TEST(SceneReader, ReadsEveryKindOfThing) {
  const ScratchDir folder;
  write_file(folder / "paint.json", to_json(garnet_red_paint_13()));
  write_file(folder / "quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  write_exr_image(folder / "sky.exr", {2, 1, {"B", "G", "R"}, {{3.0F, 6.0F}, {2.0F, 5.0F}, {1.0F, 4.0F}}, {}});
  const std::string toml = R"(
[camera]
position = [1, -9.5, 3]
look_at = [0, 0, 1]
up = [0, 1, 1]
fov_deg = 25
[image]
width = 320
height = 200
samples = 4
max_bounces = 7
indirect = 0.5
path_limit = 3
seed = 11
exposure = -1.5
[plan]
tolerance = 0.01
[materials]
floor = {reflectance = [0.5, 0.6, 0.7]}
paint = {file = "paint.json"}
[[objects]]
type = "plane"
point = [0, 0, -1]
normal = [0, 0, 2]
half_size = 3
material = "floor"
[[objects]]
type = "sphere"
center = [1, 2, 3]
radius = 0.5
material = "paint"
tangent = [0, 1, 0]
brushed_deg = 30
[[objects]]
type = "cylinder"
base = [3, 0, 0]
top = [3, 0, 2]
radius = 0.25
caps = false
material = "paint"
[[objects]]
type = "mesh"
file = "quad.obj"
scale = 2
rotate = [90, 0, 90]
translate = [0, 0, 5]
material = "floor"
[[lights]]
type = "point"
position = [0, 0, 9]
intensity = [1, 2, 3]
radius = 0.1
[[lights]]
type = "directional"
direction = [0, 0, -2]
irradiance = 2
diameter_deg = 0.5
[[lights]]
type = "area"
shape = "rectangle"
center = [0, 0, 8]
u = [1, 0, 0]
v = [0, -1, 0]
radiance = 4
[[lights]]
type = "area"
shape = "disc"
center = [0, 0, 8]
normal = [0, 0, -1]
radius = 2
radiance = 5
[[lights]]
type = "area"
shape = "sphere"
center = [9, 0, 8]
radius = 2
radiance = 5
[[lights]]
type = "environment"
file = "sky.exr"
scale = 0.5
rotation_deg = 90
)";
  const Scene s = parse_scene(toml, folder / "s.toml");
  EXPECT_EQ(s.camera.position, (Vec3{1, -9.5, 3}));
  EXPECT_EQ(s.camera.up, (Vec3{0, 1, 1}));
  EXPECT_EQ(s.camera.fov_deg, 25.0);
  EXPECT_EQ(s.image.width, 320U);
  EXPECT_EQ(s.image.height, 200U);
  EXPECT_EQ(s.image.samples, 4U);
  EXPECT_EQ(s.image.max_bounces, 7);
  EXPECT_EQ(s.image.indirect, 0.5);
  EXPECT_EQ(s.image.path_limit, 3.0);
  EXPECT_EQ(s.image.seed, 11U);
  EXPECT_EQ(s.image.exposure_stops, -1.5);
  EXPECT_EQ(s.plan_tolerance, 0.01);
  ASSERT_EQ(s.materials.size(), 2U);
  EXPECT_EQ(s.materials[1].name, "paint");
  EXPECT_EQ(s.materials[1].material, garnet_red_paint_13());
  EXPECT_EQ(s.materials[0].material.channels[2].coefficient(Coefficient::k_udf), 0.7);
  ASSERT_EQ(s.channels.size(), 3U);
  EXPECT_EQ(s.channels[0], (SceneChannel{"R", 0.65}));
  ASSERT_EQ(s.objects.size(), 4U);
  EXPECT_EQ(std::get<Plane>(s.objects[0].shape).half_size, 3.0);
  EXPECT_EQ(s.objects[0].material, 0U);
  EXPECT_EQ(s.objects[1].material, 1U);
  EXPECT_EQ(s.objects[1].tangent, (Vec3{0, 1, 0}));
  EXPECT_EQ(s.objects[1].brushed_deg, 30.0);
  EXPECT_FALSE(std::get<Cylinder>(s.objects[2].shape).caps);
  const Mesh& mesh = std::get<Mesh>(s.objects[3].shape);
  ASSERT_EQ(mesh.triangles.size(), 2U);
  // (1, 1, 0), doubled, about x: (2, 0, 2), about z: (0, 2, 2).
  EXPECT_NEAR(length(mesh.vertices[2] - Vec3{0, 2, 7}), 0.0, 1e-12);
  ASSERT_EQ(s.lights.size(), 6U);
  EXPECT_EQ(std::get<PointLight>(s.lights[0]).intensity, (Spectrum{1, 2, 3}));
  EXPECT_EQ(std::get<DirectionalLight>(s.lights[1]).irradiance, (Spectrum{2, 2, 2}));
  EXPECT_EQ(std::get<Rectangle>(std::get<AreaLight>(s.lights[2]).shape).v, (Vec3{0, -1, 0}));
  const auto& sky = std::get<EnvironmentLight>(s.lights[5]);
  EXPECT_EQ(sky.radiance, (Spectrum{0.5, 0.5, 0.5}));
  EXPECT_EQ(sky.map->values, (std::vector<double>{1, 2, 3, 4, 5, 6})) << "by name, in the materials' order";
}

TEST(SceneReader, DefaultsSuffice) {
  const Scene s = parse_scene(camera + materials + sphere + lamp, "s.toml");
  EXPECT_EQ(s.image.width, 512U);
  EXPECT_FALSE(s.image.exposure_stops);
  EXPECT_FALSE(s.plan_tolerance);
  EXPECT_EQ(s.channels.size(), 3U);
}

struct Bad {
  std::string toml, message;
};

TEST(SceneReader, SaysWhatIsWrongAndWhere) {
  const std::string rest = materials + sphere + lamp;
  const auto object = [&](const std::string& text) { return camera + materials + "[[objects]]\n" + text + lamp; };
  const auto light = [&](const std::string& text) { return camera + materials + sphere + "[[lights]]\n" + text; };
  const std::vector<Bad> cases{
      {"", "s.toml: /camera: is missing"},
      {"[camera\n", "s.toml:1: column"},
      {camera + rest + "[extra]\n", "/extra: is not a known key, expected camera, image"},
      {"[camera]\nposition = [0, 0]\nlook_at = [0, 0, 0]\n" + rest, "/camera/position: has 2 numbers, expected three"},
      {"[camera]\nposition = [0, nan, 0]\nlook_at = [0, 0, 0]\n" + rest, "/camera/position/1: is nan"},
      {"[camera]\nposition = [0, 1e300, 0]\nlook_at = [0, 0, 0]\n" + rest, "/camera/position/1: is 1e+300, expected"},
      {"[camera]\nposition = [0, -5, 0]\nlook_at = [0, -5, 0]\n" + rest,
       "/camera/look_at: is the camera's own position"},
      {camera + "up = [0, 5, -1]\n" + rest, "/camera/up: is parallel to the line of sight"},
      {camera + "up = [0, 0, 0]\n" + rest, "/camera/up: is the zero vector"},
      {camera + "fov_deg = 180\n" + rest, "/camera/fov_deg: is 180, expected degrees"},
      {"[camera]\nposition = [0.2, 0, 0.1]\nlook_at = [0, 0, 0]\n" + rest, "/camera/position: is inside objects/0"},
      {"[image]\nwidth = 0\n" + camera + rest, "/image/width: is 0, expected a whole number from 1"},
      {"[image]\nwidth = 60000\nheight = 60000\n" + camera + rest, "/image: is of 60000 x 60000 pixels"},
      {"[image]\nsamples = 1.5\n" + camera + rest, "/image/samples: is a floating-point"},
      {"[image]\nmax_bounces = 1000\n" + camera + rest, "/image/max_bounces: is 1000"},
      {"[image]\nindirect = 0\n" + camera + rest, "/image/indirect: is 0, expected a number above 0"},
      {"[image]\npath_limit = 0\n" + camera + rest, "/image/path_limit: is 0, expected a number above 0"},
      {"[image]\nexposure = \"bright\"\n" + camera + rest, "/image/exposure: is a string, expected \"auto\""},
      {"[plan]\ntolerance = 1\n" + camera + rest, "/plan/tolerance: is 1, expected a number between 0 and 1"},
      {camera + sphere + lamp, "/materials: is missing"},
      {camera + "[materials]\n" + sphere + lamp, "/materials: is empty"},
      {camera + "[materials]\nwhite = {}\n" + sphere + lamp, "/materials/white: expected one of file"},
      {camera + "[materials]\nwhite = {reflectance = 1.5}\n" + sphere + lamp, "/materials/white/reflectance: is 1.5"},
      {camera + "[materials]\nwhite = {reflectance = [0.5, 0.5]}\n" + sphere + lamp, "has 2 numbers, expected one, or"},
      {camera + "[materials]\nwhite = {file = \"none.json\"}\n" + sphere + lamp, "none.json"},
      {camera + materials + lamp, "/objects: is missing"},
      {"objects = []\n" + camera + materials + lamp, "/objects: is empty"},
      {object("type = \"cube\"\nmaterial = \"white\"\n"), "/objects/0/type: \"cube\" is not known, expected sphere"},
      {object("type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n"), "/objects/0/material: is missing"},
      {object("type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"red\"\n"),
       "/objects/0/material: \"red\" is no material, expected white"},
      {object("type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 0\nmaterial = \"white\"\n"),
       "/objects/0/radius: is 0, expected a number above 0"},
      {object("type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nsize = 2\nmaterial = \"white\"\n"),
       "/objects/0/size: is not a known key"},
      {object("type = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 0]\nmaterial = \"white\"\n"),
       "/objects/0/normal: is the zero vector"},
      {object("type = \"cylinder\"\nbase = [0, 0, 0]\ntop = [0, 0, 0]\nradius = 1\nmaterial = \"white\"\n"),
       "/objects/0/top: is the base itself"},
      {object("type = \"cylinder\"\nbase = [0, -9, 0]\ntop = [0, 9, 0]\nradius = 2\nmaterial = \"white\"\n"),
       "/camera/position: is inside objects/0"},
      {object("type = \"mesh\"\nfile = \"missing.obj\"\nmaterial = \"white\"\n"), "missing.obj"},
      {camera + materials + sphere, "/lights: is missing"},
      {"lights = []\n" + camera + materials + sphere, "/lights: is empty"},
      {light("type = \"lamp\"\n"), "/lights/0/type: \"lamp\" is not known"},
      {light("type = \"point\"\nposition = [0, 0, 5]\nintensity = 0\n"), "/lights: none of them shines"},
      {light("type = \"point\"\nposition = [0, 0, 5]\nintensity = -1\n"), "/lights/0/intensity: is -1"},
      {light("type = \"point\"\nposition = [0, 0, 5]\nintensity = [1, 2]\n"), "/lights/0/intensity: has 2 numbers"},
      {light("type = \"directional\"\ndirection = [0, 0, 0]\nirradiance = 1\n"), "/lights/0/direction: is the zero"},
      {light(
           "type = \"area\"\nshape = \"rectangle\"\ncenter = [0, 0, 5]\nu = [1, 0, 0]\nv = [2, 0, 0]\nradiance = 1\n"),
       "/lights/0/v: is parallel to u: the light has no area"},
      {light(
           "type = \"area\"\nshape = \"rectangle\"\ncenter = [0, 0, 5]\nu = [0, 0, 0]\nv = [2, 0, 0]\nradiance = 1\n"),
       "/lights/0/u: is the zero vector"},
      {light("type = \"area\"\nshape = \"disc\"\ncenter = [0, 0, 5]\nnormal = [0, 0, 1]\nradius = 0\nradiance = 1\n"),
       "/lights/0/radius: is 0"},
      {light("type = \"area\"\nshape = \"disc\"\ncenter = [0, 0, 5]\nu = [0, 0, 1]\nradius = 1\nradiance = 1\n"),
       "/lights/0/u: is not a known key"},
      {light("type = \"area\"\nshape = \"sphere\"\ncenter = [0, -5, 1]\nradius = 1\nradiance = 1\n"),
       "/camera/position: is inside lights/0"},
      {light("type = \"environment\"\n"), "/lights/0: expected one of radiance and file"},
      {light("type = \"environment\"\nfile = \"missing.exr\"\n"), "missing.exr"},
  };
  for (const Bad& bad : cases) {
    const std::string said = complaint(bad.toml);
    EXPECT_NE(said.find(bad.message), std::string::npos) << bad.toml << "\nsaid: " << said;
  }
}

TEST(SceneReader, MaterialsMustHaveTheSameChannels) {
  const ScratchDir folder;
  write_file(folder / "a.json", to_json(garnet_red_paint_13()));
  write_file(folder / "b.json", to_json(smooth_aluminium_45()));
  const std::string two = "[materials]\na = {file = \"a.json\"}\nwhite = {file = \"b.json\"}\n";
  const std::string said = complaint(camera + two + sphere + lamp, folder / "s.toml");
  EXPECT_NE(said.find("/materials/white: has the channels \"550nm\" (0.55 um), expected those of the other materials"),
            std::string::npos)
      << said;
}

TEST(SceneReader, ACameraInsideAClosedMeshIsFoundByParity) {
  const ScratchDir folder;
  const std::string corners = "v 9 9 9\nv 9 -9 -9\nv -9 9 -9\nv -9 -9 9\n";
  const std::string faces = "f 1 2 3\nf 1 4 2\nf 1 3 4\n";
  const std::string mesh =
      camera + materials + "[[objects]]\ntype = \"mesh\"\nfile = \"m.obj\"\nmaterial = \"white\"\n" + lamp;
  write_file(folder / "m.obj", corners + faces + "f 2 4 3\n");
  EXPECT_NE(complaint(mesh, folder / "s.toml").find("is inside objects/0"), std::string::npos);
  write_file(folder / "m.obj", corners + faces);
  EXPECT_EQ(complaint(mesh, folder / "s.toml"), "nothing is wrong") << "an open mesh has no inside";
}

TEST(SceneReader, MapsOfTheWrongKindAreRefused) {
  const ScratchDir folder;
  const std::string sky = camera + materials + sphere + "[[lights]]\ntype = \"environment\"\nfile = \"sky.exr\"\n";
  write_file(folder / "sky.exr", "not a picture");
  EXPECT_NE(complaint(sky, folder / "s.toml").find("is not a complete OpenEXR file"), std::string::npos);
  write_exr_image(folder / "sky.exr", {1, 1, {"R", "X"}, {{1.0F}, {1.0F}}, {}});
  EXPECT_NE(complaint(sky, folder / "s.toml").find("has no channel \"G\""), std::string::npos);
  write_exr_image(folder / "sky.exr", {1, 1, {"Y"}, {{-1.0F}}, {}});
  EXPECT_NE(complaint(sky, folder / "s.toml").find("has a negative value"), std::string::npos);
  write_exr_image(folder / "sky.exr", {1, 1, {"Y"}, {{0.0F}}, {}});
  EXPECT_NE(complaint(sky, folder / "s.toml").find("none of them shines"), std::string::npos);
  write_exr_image(folder / "sky.exr", {1, 1, {"Y"}, {{2.0F}}, {}});
  EXPECT_EQ(complaint(sky, folder / "s.toml"), "nothing is wrong");
}

TEST(ObjReader, NamesTheLine) {
  const std::string corners = "# a square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 2 0 0\n";
  const std::vector<Bad> cases{
      {"", "m.obj: has no faces"},
      {"v 0 0\n", "m.obj:1: \"v\" has 2 numbers, expected three"},
      {"v 0 0 x\n", "m.obj:1: \"x\" is not"},
      {"v 0 0 inf\n", "m.obj:1: \"inf\" is not finite"},
      {corners + "f 1 2\n", "m.obj:6: the face has 2 corners"},
      {corners + "f 1 2 5\n", "m.obj:6: there is no vertex 5, expected 1 to 4"},
      {corners + "f 1 2 0\n", "m.obj:6: there is no vertex 0"},
      {corners + "f 1 2 -5\n", "m.obj:6: there is no vertex -5"},
      {corners + "f 1 2 x\n", "m.obj:6: \"x\" is not an index"},
      {corners + "f 1//1 2//1 3//1\n", "m.obj:6: there is no normal 1, expected 1 to 0"},
      {corners + "f 1 2 3\nf 1 2 4\n", "m.obj:7: the face is degenerate"},
      {corners + "f 1 2 2\n", "m.obj:6: the face is degenerate"},
      {corners + "vn 0 0 0\n", "m.obj:6: the normal is zero"},
      {"solid cube\n", "m.obj:1: \"solid\" is no record of an OBJ file"},
  };
  for (const Bad& bad : cases) {
    std::istringstream in(bad.toml);
    try {
      (void)read_obj(in, "m.obj");
      ADD_FAILURE() << bad.toml;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(bad.message), std::string::npos) << error.what();
    }
  }
}

TEST(ObjReader, PassesOverWhatNamesAndColours) {
  std::istringstream in(
      "mtllib x.mtl\no thing\r\ng a b\ns off\nusemtl red\nv 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nvt 0 0\nvn 0 0 2\n"
      "f 1/1/1 2/1/1 3/1/-1 # a face\n");
  const Mesh mesh = read_obj(in, "m.obj");
  ASSERT_EQ(mesh.triangles.size(), 1U);
  EXPECT_EQ(mesh.normals[0], (Vec3{0, 0, 1}));
  EXPECT_TRUE(mesh.triangles[0].normal.has_value());
  EXPECT_FALSE(is_closed(mesh));
}

TEST(SceneReader, ShippedScenesAreRead) {
  std::size_t scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_dir() / "data" / "scenes")) {
    if (entry.path().extension() != ".toml") continue;
    EXPECT_NO_THROW((void)read_scene(entry.path())) << entry.path();
    ++scenes;
  }
  EXPECT_GE(scenes, 2U);
}

}  // namespace
}  // namespace goniofit::test
