#include <goniofit/fit/fit.h>
#include <goniofit/io/scan_reader.h>

#include <iostream>

int main(int, char** argv) {
  const goniofit::Scan scan = goniofit::read_scan(argv[1]);
  const goniofit::FitResult result = goniofit::fit(scan, {});
  std::cout << "slope " << result.material.surface.slope.value() << '\n';
}
