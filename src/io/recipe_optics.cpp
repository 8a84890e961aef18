#include "io/recipe_optics.h"

#include "io/optical_constants.h"
#include "support/error.h"

namespace goniofit {

void use_optical_constants(const std::filesystem::path& path, const Scan& scan, FitSettings& settings) {
  const OpticalConstants constants = read_optical_constants(path);
  settings.n.clear();
  settings.kappa.clear();
  settings.f0.clear();
  for (const ScanChannel& channel : scan.channels) {
    if (!channel.wavelength_um) {
      throw input_error(scan.source, 0, channel.name,
                        "no wavelength, which the optical constants of " + path.string() +
                            " need; name the column by it (550nm) or add a line '# wavelength_um: ...'");
    }
    const OpticalConstants::Index index = constants.at(*channel.wavelength_um);
    settings.n.push_back(index.n);
    settings.kappa.push_back(index.kappa);
  }
}

}  // namespace goniofit
