#pragma once
// Piecewise linear curves of springs and dampers, in double. Outside the points the end segments
// continue. The input curve's points are copied, so that a law can mirror them and invert them
// once.
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/curve.h"

namespace fabrica {

class Polyline {
 public:
  Polyline() = default;
  Polyline(std::vector<double> x, std::vector<double> y) : x_(std::move(x)), y_(std::move(y)) {}
  explicit Polyline(const CurveView& c) : x_(c.x, c.x + c.n), y_(c.y, c.y + c.n) {}
  // the line y = slope x
  static Polyline line(double slope) { return {{-1.0, 1.0}, {-slope, slope}}; }

  explicit operator bool() const { return !x_.empty(); }

  // value at a and, in slope, dy/dx there
  double at(double a, double& slope) const {
    if (x_.size() < 2) return slope = 0, x_.empty() ? 0.0 : y_[0];
    const auto above = std::upper_bound(x_.begin() + 1, x_.end() - 1, a);
    const std::size_t i = std::size_t(above - x_.begin()) - 1;
    slope = (y_[i + 1] - y_[i]) / (x_[i + 1] - x_[i]);
    return y_[i] + slope * (a - x_[i]);
  }
  double at(double a) const {
    double slope = 0;
    return at(a, slope);
  }

  // value at a, held at the end values outside the points
  double held(double a) const { return at(std::clamp(a, x_.front(), x_.back())); }

  // largest slope of any segment; 0 for a single point
  double steepest() const {
    double s = 0;
    for (std::size_t i = 0; i + 1 < x_.size(); ++i)
      s = std::max(s, (y_[i + 1] - y_[i]) / (x_[i + 1] - x_[i]));
    return s;
  }

  // The point nearest to x = 0 where the curve has the value `level`; the end segments continue.
  // Where the curve never reaches it, the point whose value comes nearest.
  double inverse(double level) const {
    if (x_.size() < 2) return x_.empty() ? 0.0 : x_[0];
    double best = 0, best_distance = INFINITY;
    const std::size_t last = x_.size() - 2;
    for (std::size_t i = 0; i <= last; ++i) {
      const double rise = y_[i + 1] - y_[i];
      if (rise == 0) {
        if (y_[i] == level) keep_nearer(std::clamp(0.0, x_[i], x_[i + 1]), best, best_distance);
        continue;
      }
      const double t = (level - y_[i]) / rise;
      if ((t < 0 && i > 0) || (t > 1 && i < last)) continue;
      keep_nearer(x_[i] + t * (x_[i + 1] - x_[i]), best, best_distance);
    }
    return best_distance < INFINITY ? best : nearest_point(level);
  }

  // Odd continuation of a curve that is given for x >= 0 only; others are returned as they are.
  Polyline mirrored() const {
    if (x_.empty() || x_.front() < 0) return *this;
    Polyline m;
    for (std::size_t i = x_.size(); i-- > 0;)
      if (x_[i] > 0) m.x_.push_back(-x_[i]), m.y_.push_back(-y_[i]);
    if (x_.front() > 0) m.x_.push_back(0), m.y_.push_back(0);
    m.x_.insert(m.x_.end(), x_.begin(), x_.end());
    m.y_.insert(m.y_.end(), y_.begin(), y_.end());
    return m;
  }

 private:
  static void keep_nearer(double x, double& best, double& best_distance) {
    if (std::fabs(x) < best_distance) best = x, best_distance = std::fabs(x);
  }
  double nearest_point(double level) const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < x_.size(); ++i)
      if (std::fabs(y_[i] - level) < std::fabs(y_[best] - level)) best = i;
    return x_[best];
  }

  std::vector<double> x_, y_;
};

}  // namespace fabrica
