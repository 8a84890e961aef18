#pragma once
// Each reader as a function of bytes, for the fuzzer and for the replay of its corpus. A reader either succeeds or
// throws goniofit::Error; anything else it lets out is a bug, which is what both look for.

#include <array>
#include <cstdint>
#include <string_view>

namespace goniofit::fuzz {

void scan(std::string_view bytes);
void directions(std::string_view bytes);
void optical_constants(std::string_view bytes);
void reflectances(std::string_view bytes);
void material(std::string_view bytes);
void recipe(std::string_view bytes);
void exr_table(std::string_view bytes);
void scene(std::string_view bytes);
void mesh(std::string_view bytes);
void exr_image(std::string_view bytes);

struct Reader {
  const char* name;  ///< of its corpus folder
  void (*read)(std::string_view bytes);
};
inline constexpr std::array readers{Reader{"scan", scan},
                                    Reader{"directions", directions},
                                    Reader{"optical_constants", optical_constants},
                                    Reader{"reflectances", reflectances},
                                    Reader{"material", material},
                                    Reader{"recipe", recipe},
                                    Reader{"exr_table", exr_table},
                                    Reader{"scene", scene},
                                    Reader{"mesh", mesh},
                                    Reader{"exr_image", exr_image}};

}  // namespace goniofit::fuzz
