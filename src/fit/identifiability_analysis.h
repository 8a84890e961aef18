#pragma once
// How identifiability.h's statements are found.

#include <Eigen/Core>
#include <vector>

#include "identifiability.h"
#include "linear_parts.h"
#include "model.h"
#include "problem.h"

namespace goniofit {

/// A parameter that is not fixed, and where it stands in the columns of LinearSums.
struct DesignColumn {
  std::string name, channel;  ///< channel empty for shared ones
  std::ptrdiff_t channel_index = -1;
  Eigen::Index column = 0;  ///< of its channel's, or of every channel's for a shared one
  double value = 0.0;       ///< z of a shape parameter, which is a logarithm
  double size = 1.0;        ///< what a column is multiplied by: see identifiability.h
  bool logarithm = false;
  bool on_bound = false;

  [[nodiscard]] std::string key() const { return channel.empty() ? name : channel + "." + name; }
};

/// Shape parameters first, then channel after channel.
[[nodiscard]] std::vector<DesignColumn> design_columns(const Problem& problem, const FitPoint& point);

/// The whole whitened Jacobian's triangle R (J = QR) over `columns`, each multiplied by its size; `whitened`: of each
/// channel the rows themselves, or their triangle.
[[nodiscard]] Eigen::MatrixXd design_triangle(const std::vector<DesignColumn>& columns,
                                              const std::vector<Eigen::MatrixXd>& whitened, Eigen::Index shape_columns);

/// `sums` with those in units of the noise.
[[nodiscard]] Identifiability identify(const Problem& problem, const FitPoint& point, const LinearSums& sums);

}  // namespace goniofit
