#pragma once
// Upper triangles R of QR decompositions: what sums of products over rows can say, without squaring the condition.

#include <Eigen/Core>
#include <vector>

namespace goniofit {

/// R of m = QR; of fewer rows than columns where m has fewer.
[[nodiscard]] Eigen::MatrixXd triangle_of(const Eigen::MatrixXd& m);

/// From R of some rows to R of these and `rows` more, diag(weight) times the columns; `weight` may be null for 1. R
/// without a row is that of none.
void add_to_triangle(const std::vector<const double*>& columns, Eigen::Index rows, const double* weight,
                     Eigen::MatrixXd& r);

}  // namespace goniofit
