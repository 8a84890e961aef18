#include "fit/bounded_least_squares.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace goniofit {

namespace {

using States = decltype(BoundedSolution::state);

struct Equations {
  SmallMatrix gram;
  SmallVector rhs, lower, upper;
};

// Solves for the free ones with the others where they are. Dependent columns (pivot below 1e-13 of the unit diagonal)
// keep their value. Cholesky by hand, because a semidefinite matrix of order <= 8 needs only that and no allocation.
SmallVector solve_free(const Equations& e, const States& state, const SmallVector& x) {
  const Eigen::Index n = x.size();
  SmallMatrix l = SmallMatrix::Zero(n, n);
  SmallVector residual = e.rhs;
  for (Eigen::Index j = 0; j < n; ++j) {
    if (state[j] != BoundState::free) residual -= e.gram.col(j) * x[j];
  }
  Eigen::Array<bool, Eigen::Dynamic, 1, Eigen::ColMajor, max_columns, 1> used(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    used[j] = false;
    if (state[j] != BoundState::free) continue;
    double pivot = e.gram(j, j);
    for (Eigen::Index k = 0; k < j; ++k) pivot -= l(j, k) * l(j, k);
    if (pivot <= 1e-13 * e.gram(j, j)) {
      residual -= e.gram.col(j) * x[j];
      continue;
    }
    used[j] = true;
    l(j, j) = std::sqrt(pivot);
    for (Eigen::Index i = j + 1; i < n; ++i) {
      if (state[i] != BoundState::free) continue;
      double sum = e.gram(i, j);
      for (Eigen::Index k = 0; k < j; ++k) sum -= l(i, k) * l(j, k);
      l(i, j) = sum / l(j, j);
    }
  }
  SmallVector y = x;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!used[i]) continue;
    double sum = residual[i];
    for (Eigen::Index k = 0; k < i; ++k) {
      if (used[k]) sum -= l(i, k) * y[k];
    }
    y[i] = sum / l(i, i);
  }
  for (Eigen::Index i = n - 1; i >= 0; --i) {
    if (!used[i]) continue;
    for (Eigen::Index k = i + 1; k < n; ++k) {
      if (used[k]) y[i] -= l(k, i) * y[k];
    }
    y[i] /= l(i, i);
  }
  return y;
}

// Moves from x towards y until the first bound; returns its index, or -1 when y is inside.
Eigen::Index step_to_bound(const Equations& e, const SmallVector& y, SmallVector& x, States& state) {
  Eigen::Index blocking = -1;
  double step = 1.0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (state[i] != BoundState::free) continue;
    const double bound = y[i] < e.lower[i] ? e.lower[i] : e.upper[i];
    if (y[i] >= e.lower[i] && y[i] <= e.upper[i]) continue;
    const double reach = std::clamp((bound - x[i]) / (y[i] - x[i]), 0.0, 1.0);
    if (reach < step || blocking < 0) {
      step = std::min(step, reach);
      blocking = i;
    }
  }
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (state[i] == BoundState::free) x[i] += step * (y[i] - x[i]);
  }
  if (blocking >= 0) {
    const bool low = y[blocking] < e.lower[blocking];
    state[blocking] = low ? BoundState::at_lower : BoundState::at_upper;
    x[blocking] = low ? e.lower[blocking] : e.upper[blocking];
  }
  return blocking;
}

// The bound whose release lowers the value fastest, or -1 when none does (the minimum).
Eigen::Index bound_to_release(const Equations& e, const SmallVector& x, const States& state) {
  const SmallVector gradient = e.gram * x - e.rhs;
  const double tolerance = 1e-13 * (1.0 + e.rhs.cwiseAbs().maxCoeff());
  Eigen::Index best = -1;
  double fastest = tolerance;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (e.lower[i] == e.upper[i]) continue;
    const double gain = state[i] == BoundState::at_lower   ? -gradient[i]
                        : state[i] == BoundState::at_upper ? gradient[i]
                                                           : 0.0;
    if (gain > fastest) {
      fastest = gain;
      best = i;
    }
  }
  return best;
}

}  // namespace

BoundedSolution solve_bounded(const SmallMatrix& gram, const SmallVector& rhs, const SmallVector& lower,
                              const SmallVector& upper) {
  const Eigen::Index n = rhs.size();
  // Equilibrate: unit diagonal, so that one tolerance serves a lobe of 10⁶ and a diffuse part of 0.1.
  SmallVector scale(n);
  for (Eigen::Index i = 0; i < n; ++i) scale[i] = gram(i, i) > 0.0 ? 1.0 / std::sqrt(gram(i, i)) : 0.0;
  Equations e{SmallMatrix(scale.asDiagonal() * gram * scale.asDiagonal()), scale.cwiseProduct(rhs), lower, upper};
  BoundedSolution s{SmallVector::Zero(n), 0.0, States::Constant(n, BoundState::free)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const double start = std::clamp(0.0, lower[i], upper[i]);
    if (scale[i] > 0.0) {
      e.lower[i] /= scale[i];
      e.upper[i] /= scale[i];
      s.x[i] = start / scale[i];
      if (lower[i] == upper[i]) s.state[i] = BoundState::at_lower;
    } else {
      // A column of zeros does not matter to the value.
      s.x[i] = start;
      e.lower[i] = e.upper[i] = start;
      s.state[i] = BoundState::at_lower;
    }
  }
  // Each pass either adds a bound or reaches the minimum of a face and leaves it downhill; faces do not repeat. The cap
  // is for round-off at degenerate corners, where the last x is as good as the minimum.
  for (int pass = 0; pass < 64; ++pass) {
    const SmallVector y = solve_free(e, s.state, s.x);
    if (step_to_bound(e, y, s.x, s.state) >= 0) continue;
    const Eigen::Index release = bound_to_release(e, s.x, s.state);
    if (release < 0) break;
    s.state[release] = BoundState::free;
  }
  s.value = s.x.dot(e.gram * s.x) - 2.0 * s.x.dot(e.rhs);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (scale[i] > 0.0) s.x[i] *= scale[i];
    if (s.state[i] == BoundState::at_lower && scale[i] > 0.0) s.x[i] = lower[i];
    if (s.state[i] == BoundState::at_upper) s.x[i] = upper[i];
  }
  return s;
}

}  // namespace goniofit
