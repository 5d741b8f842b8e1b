#include "body/mesh/skull_vault.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/lane_math.h"
#include "body/tables.h"

namespace fabrica::body {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int rows = 91, columns = 181;

// associated Legendre function without the Condon-Shortley phase, by the recursion in l
double legendre(int l, int m, double x) {
  double p = 1;
  const double s = std::sqrt(std::max(0.0, 1 - x * x));
  for (int i = 1; i <= m; ++i) p *= (2 * i - 1) * s;
  if (l == m) return p;
  double next = x * (2 * m + 1) * p;
  for (int k = m + 2; k <= l; ++k) {
    const double after = ((2 * k - 1) * x * next - (k + m - 1) * p) / (k - m);
    p = next;
    next = after;
  }
  return next;
}

double normalisation(int l, int m) {
  double ratio = 1;  // (l - m)! / (l + m)!
  for (int i = l - m + 1; i <= l + m; ++i) ratio /= i;
  return std::sqrt((2 * l + 1) / (4 * pi) * ratio * (m > 0 ? 2 : 1));
}

}  // namespace

VaultSurface::VaultSurface(const std::string& column) {
  const Table table("anatomy/bones/skull_vault.csv");
  for (int row = 0; row < table.rows(); ++row)
    terms_.push_back(
        {int(table.number(row, "l")), int(table.number(row, "m")), table.number(row, column)});
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
      samples_.push_back(exact_radius(pi * i / (rows - 1), 2 * pi * j / (columns - 1) - pi));
}

double VaultSurface::exact_radius(double theta, double phi) const {
  double sum = 0;
  for (const Term& t : terms_) {
    const int m = std::abs(t.m);
    const double wave = t.m > 0 ? cos(m * phi) : t.m < 0 ? sin(m * phi) : 1.0;
    sum += t.a * normalisation(t.l, m) * legendre(t.l, m, cos(theta)) * wave;
  }
  return sum;
}

double VaultSurface::radius(const Point& direction) const {
  const double theta = std::acos(std::clamp(direction.z, -1.0, 1.0)),
               phi = std::atan2(direction.y, direction.x);
  const double u = theta / pi * (rows - 1), v = (phi + pi) / (2 * pi) * (columns - 1);
  const int i = std::clamp(int(u), 0, rows - 2), j = std::clamp(int(v), 0, columns - 2);
  const double s = u - i, t = v - j;
  const double* at = &samples_[std::size_t(i) * columns + j];
  return (1 - s) * ((1 - t) * at[0] + t * at[1]) +
         s * ((1 - t) * at[columns] + t * at[columns + 1]);
}

}  // namespace fabrica::body
