#include "fit/triangle.h"

#include <Eigen/QR>
#include <algorithm>

namespace goniofit {

Eigen::MatrixXd triangle_of(const Eigen::MatrixXd& m) {
  const Eigen::Index rows = std::min(m.rows(), m.cols());
  if (rows == 0) return Eigen::MatrixXd::Zero(0, m.cols());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(m);
  return qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
}

// Of so many rows at a time, each on top of them the triangle of those before: they stay in the cache.
void add_to_triangle(const std::vector<const double*>& columns, Eigen::Index rows, const double* weight,
                     Eigen::MatrixXd& r) {
  constexpr Eigen::Index at_once = 512;
  const auto width = static_cast<Eigen::Index>(columns.size());
  if (r.rows() == 0) r.resize(0, width);
  for (Eigen::Index first = 0; first < rows; first += at_once) {
    const Eigen::Index count = std::min(at_once, rows - first);
    Eigen::MatrixXd part(r.rows() + count, width);
    part.topRows(r.rows()) = r;
    for (Eigen::Index p = 0; p < width; ++p) {
      const Eigen::Map<const Eigen::VectorXd> column(columns[static_cast<std::size_t>(p)] + first, count);
      part.col(p).tail(count) = column;
    }
    if (weight != nullptr)
      part.bottomRows(count).array().colwise() *= Eigen::Map<const Eigen::ArrayXd>(weight + first, count);
    r = triangle_of(part);
  }
}

}  // namespace goniofit
