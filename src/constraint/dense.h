#pragma once
// Symmetric positive semi-definite systems A x = b, small and dense, by A = L D L^T. Rows that
// depend on earlier ones (pivot below 1e-13 of the original diagonal) get x = 0, so redundant
// constraints are harmless.
#include <vector>

namespace fabrica {

class DenseFactor {
 public:
  // a: row-major n x n, lower triangle used
  void factor(std::vector<double> a, int n) {
    n_ = n;
    l_ = std::move(a);
    d_.assign(n, 0);
    for (int j = 0; j < n; ++j) {
      double pivot = l_[j * n + j];
      const double original = pivot;
      for (int k = 0; k < j; ++k) pivot -= l_[j * n + k] * l_[j * n + k] * d_[k];
      d_[j] = original > 0 && pivot > 1e-13 * original ? pivot : 0;
      for (int i = j + 1; i < n; ++i) {
        double s = l_[i * n + j];
        for (int k = 0; k < j; ++k) s -= l_[i * n + k] * l_[j * n + k] * d_[k];
        l_[i * n + j] = d_[j] > 0 ? s / d_[j] : 0;
      }
    }
  }
  // b is replaced by x
  void solve(std::vector<double>& b) const {
    for (int i = 0; i < n_; ++i)
      for (int k = 0; k < i; ++k) b[i] -= l_[i * n_ + k] * b[k];
    for (int i = 0; i < n_; ++i) b[i] = d_[i] > 0 ? b[i] / d_[i] : 0;
    for (int i = n_ - 1; i >= 0; --i)
      for (int k = i + 1; k < n_; ++k) b[i] -= l_[k * n_ + i] * b[k];
    for (int i = 0; i < n_; ++i)
      if (d_[i] == 0) b[i] = 0;
  }

 private:
  int n_ = 0;
  std::vector<double> l_, d_;
};

}  // namespace fabrica
