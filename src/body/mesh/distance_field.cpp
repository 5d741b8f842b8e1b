#include "body/mesh/distance_field.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fabrica::body {
namespace {

constexpr double closing_length = 0.8;  // [mm] in which the surface closes beyond an end slice

// signed distance of all loops of a slice on a grid of points, row by row
struct PlaneGrid {
  double x0, y0, spacing;
  int nx, ny;
};

std::vector<float> plane_distance(const Slice& slice, const PlaneGrid& grid) {
  std::vector<float> phi(std::size_t(grid.nx) * grid.ny);
  std::vector<float> nearest(grid.nx), x(grid.nx);
  std::vector<std::pair<double, int>> crossings;
  for (int i = 0; i < grid.nx; ++i) x[i] = float(grid.x0 + i * grid.spacing);
  for (int j = 0; j < grid.ny; ++j) {
    const double y = grid.y0 + j * grid.spacing;
    std::fill(nearest.begin(), nearest.end(), 1e12f);
    crossings.clear();
    for (const auto& loop : slice.loops)
      for (std::size_t a = 0; a < loop.size(); ++a) {
        const auto& p = loop[a];
        const auto& q = loop[(a + 1) % loop.size()];
        const double dx = q[0] - p[0], dy = q[1] - p[1];
        const float inverse = float(1 / std::max(dx * dx + dy * dy, 1e-12));
        const float px = float(p[0]), fx = float(dx), fy = float(dy), ry = float(y - p[1]);
        for (int i = 0; i < grid.nx; ++i) {
          const float rx = x[i] - px;
          float t = (rx * fx + ry * fy) * inverse;
          t = t < 0 ? 0 : t;
          t = t > 1 ? 1 : t;
          const float ex = rx - t * fx, ey = ry - t * fy, d = ex * ex + ey * ey;
          nearest[i] = d < nearest[i] ? d : nearest[i];
        }
        if ((p[1] <= y) != (q[1] <= y))
          crossings.push_back({p[0] + (y - p[1]) / dy * dx, p[1] <= y ? 1 : -1});
      }
    // the winding number grows by one where an outer contour is entered from the left
    std::sort(crossings.begin(), crossings.end());
    std::size_t c = 0;
    int winding = 0;
    for (int i = 0; i < grid.nx; ++i) {
      while (c < crossings.size() && crossings[c].first <= x[i]) winding -= crossings[c++].second;
      phi[std::size_t(j) * grid.nx + i] = (winding > 0 ? -1 : 1) * std::sqrt(nearest[i]);
    }
  }
  return phi;
}

// Where the line along z through `foot` meets a triangle: height, and -1 where it leaves the solid
// upwards, +1 where it enters. Edges are half-open: a line through an edge that two triangles share
// meets exactly one of them.
std::optional<std::pair<float, int>> crossing_of(const Point& foot, const Point& a, const Point& b,
                                                 const Point& c) {
  const double twice_area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  const auto inside = [&](const Point& p, const Point& q) {
    const bool swap = p.y > q.y || (p.y == q.y && p.x > q.x);
    const Point &u = swap ? q : p, &v = swap ? p : q;
    const double s = (v.x - u.x) * (foot.y - u.y) - (v.y - u.y) * (foot.x - u.x);
    return (s > 0) != swap;
  };
  const bool ab = inside(a, b), bc = inside(b, c), ca = inside(c, a);
  if (twice_area == 0 || ab != bc || bc != ca) return std::nullopt;
  const double wb = ((foot.x - a.x) * (c.y - a.y) - (foot.y - a.y) * (c.x - a.x)) / twice_area;
  const double wc = ((b.x - a.x) * (foot.y - a.y) - (b.y - a.y) * (foot.x - a.x)) / twice_area;
  return std::pair{float(a.z + wb * (b.z - a.z) + wc * (c.z - a.z)), twice_area > 0 ? -1 : 1};
}

constexpr int band = 8;  // spacings from the surface in which distances are measured anew

// d of |grad d| = 1 from the nearer neighbour along each axis of a grid of spacing h (Zhao, Math.
// Comp. 74, 2005)
float distance_beside(float x, float y, float z, float h) {
  const float least = std::min({x, y, z}), most = std::max({x, y, z});
  const float b = std::max(std::min(x, y), std::min(std::max(x, y), z)) - least, c = most - least;
  if (b >= h) return least + h;
  const float two = 0.5f * (b + std::sqrt(2 * h * h - b * b));
  if (two <= c) return least + two;
  return least +
         (b + c + std::sqrt(std::max(0.0f, (b + c) * (b + c) - 3 * (b * b + c * c - h * h)))) / 3;
}

// Distances to a level of the values phi on a grid, at most `reach` [mm].
struct Distances {
  std::array<int, 3> count;
  float spacing, reach;
  std::vector<float> value = {};
  std::vector<char> beside = {};  // a line through the point meets the level before the next point

  std::size_t place(int i, int j, int k) const {
    return (std::size_t(k) * count[1] + j) * count[0] + i;
  }

  // A plane that meets the lines through a point at s_x, s_y, s_z is
  // (1/s_x^2 + 1/s_y^2 + 1/s_z^2)^(-1/2) away.
  void find_beside(const std::vector<float>& phi, double level) {
    const std::size_t stride[3] = {1, std::size_t(count[0]), std::size_t(count[0]) * count[1]};
    value.assign(phi.size(), reach), beside.assign(phi.size(), 0);
    for (int k = 0; k < count[2]; ++k)
      for (int j = 0; j < count[1]; ++j)
        for (int i = 0; i < count[0]; ++i) {
          const int index[3] = {i, j, k};
          const std::size_t n = place(i, j, k);
          const double here = phi[n] - level;
          double sum = 0;  // infinite where the point lies on the level
          for (int a = 0; a < 3; ++a) {
            double share = 2;  // of a spacing up to the level
            const auto look = [&](std::size_t other) {
              const double there = phi[other] - level;
              if ((here < 0) != (there < 0)) share = std::min(share, here / (here - there));
            };
            if (index[a] > 0) look(n - stride[a]);
            if (index[a] < count[a] - 1) look(n + stride[a]);
            if (share <= 1) sum += 1 / (share * share);
          }
          if (sum == 0) continue;
          beside[n] = 1, value[n] = float(spacing / std::sqrt(sum));
        }
  }

  // once through all points, along each axis upwards or downwards
  void sweep(bool x_down, bool y_down, bool z_down) {
    const int nx = count[0];
    std::vector<float> beyond(nx, reach), y(nx), z(nx);
    const auto row = [&](int j, int k) {
      const bool inside = j >= 0 && k >= 0 && j < count[1] && k < count[2];
      return inside ? &value[place(0, j, k)] : beyond.data();
    };
    for (int a = 0; a < count[2]; ++a)
      for (int b = 0; b < count[1]; ++b) {
        const int k = z_down ? count[2] - 1 - a : a, j = y_down ? count[1] - 1 - b : b;
        const float *y0 = row(j - 1, k), *y1 = row(j + 1, k), *z0 = row(j, k - 1),
                    *z1 = row(j, k + 1);
        for (int i = 0; i < nx; ++i) y[i] = std::min(y0[i], y1[i]), z[i] = std::min(z0[i], z1[i]);
        float* d = row(j, k);
        const char* fixed = &beside[place(0, j, k)];
        for (int c = 0; c < nx; ++c) {
          const int i = x_down ? nx - 1 - c : c;
          const float x = std::min(i > 0 ? d[i - 1] : reach, i < nx - 1 ? d[i + 1] : reach);
          // a result is at least the nearest neighbour's and spacing / sqrt(3)
          if (fixed[i] || std::min({x, y[i], z[i]}) + 0.57f * spacing >= d[i]) continue;
          d[i] = std::min(d[i], distance_beside(x, y[i], z[i], spacing));
        }
      }
  }
};

}  // namespace

Point closest_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Point ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Point bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + (d1 / (d1 - d3)) * ab;
  const Point cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + (d2 / (d2 - d6)) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
  const double sum = 1 / (va + vb + vc);
  return a + (vb * sum) * ab + (vc * sum) * ac;
}

DistanceField::DistanceField(const Box& box, const Axes& axes, double spacing, double margin)
    : axes_(axes), spacing_(spacing) {
  for (int a = 0; a < 3; ++a) {
    origin_[a] = box.low[a] - margin;
    count_[a] = int(std::ceil((box.high[a] - box.low[a] + 2 * margin) / spacing)) + 1;
  }
  phi_.assign(std::size_t(count_[0]) * count_[1] * count_[2], 0.0f);
}

DistanceField DistanceField::of_slices(const std::vector<Slice>& slices, const Axes& axes,
                                       double spacing, double margin, bool halfway) {
  Box box{{1e9, 1e9, slices.front().height}, {-1e9, -1e9, slices.back().height}};
  for (const Slice& slice : slices)
    for (const auto& loop : slice.loops)
      for (const auto& p : loop)
        for (int a = 0; a < 2; ++a) {
          box.low[a] = std::min(box.low[a], p[a]);
          box.high[a] = std::max(box.high[a], p[a]);
        }
  DistanceField field(box, axes, spacing, margin);
  const int plane = field.count_[0] * field.count_[1];
  const PlaneGrid grid{field.origin_.x, field.origin_.y, spacing, field.count_[0], field.count_[1]};
  std::vector<std::vector<float>> distance;
  for (const Slice& slice : slices) distance.push_back(plane_distance(slice, grid));
  const auto depth = [](const std::vector<float>& d) {
    return -*std::min_element(d.begin(), d.end());
  };
  const double first_depth = std::max(0.2f, depth(distance.front())),
               last_depth = std::max(0.2f, depth(distance.back()));

  std::size_t above = 1;
  for (int k = 0; k < field.count_[2]; ++k) {
    const double z = field.origin_.z + k * spacing;
    float* out = &field.at(0, 0, k);
    if (z <= slices.front().height || z >= slices.back().height) {
      const bool low = z <= slices.front().height;
      const double beyond = low ? slices.front().height - z : z - slices.back().height;
      const float rise = float((low ? first_depth : last_depth) * beyond / closing_length);
      const auto& d = low ? distance.front() : distance.back();
      for (int i = 0; i < plane; ++i) out[i] = d[i] + rise;
      continue;
    }
    while (slices[above].height < z) ++above;
    const double apart = slices[above].height - slices[above - 1].height;
    const double t = (z - slices[above - 1].height) / apart;
    const auto &a = distance[above - 1], &b = distance[above];
    for (int i = 0; i < plane; ++i) {
      const float most = halfway && (a[i] < 0) != (b[i] < 0) ? float(apart) : 1e9f;
      out[i] = float((1 - t) * std::clamp(a[i], -most, most) + t * std::clamp(b[i], -most, most));
    }
  }
  field.divide_by_gradient();
  return field;
}

void DistanceField::divide_by_gradient() {
  const auto [nx, ny, nz] = count_;
  std::vector<float> out(phi_.size());
  const auto slope = [&](int i, int j, int k, int di, int dj, int dk, int index, int count) {
    const int back = index > 0, forth = index < count - 1;
    return (at(i + di * forth, j + dj * forth, k + dk * forth) -
            at(i - di * back, j - dj * back, k - dk * back)) /
           ((back + forth) * spacing_);
  };
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const double gx = slope(i, j, k, 1, 0, 0, i, nx), gy = slope(i, j, k, 0, 1, 0, j, ny),
                     gz = slope(i, j, k, 0, 0, 1, k, nz);
        const double norm = std::clamp(std::sqrt(gx * gx + gy * gy + gz * gz), 0.6, 20.0);
        out[std::size_t(k * ny + j) * nx + i] = float(at(i, j, k) / norm);
      }
  phi_.swap(out);
}

void DistanceField::measure_distance() {
  Distances distance{count_, float(spacing_), float(band * spacing_)};
  distance.find_beside(phi_, offset);
  // a distance grows along straight lines: each lies in one of eight directions
  for (int way = 0; way < 8; ++way) distance.sweep(way & 1, way & 2, way & 4);
  for (std::size_t n = 0; n < phi_.size(); ++n)
    phi_[n] = float(offset + (phi_[n] < offset ? -distance.value[n] : distance.value[n]));
}

DistanceField DistanceField::of_triangles(const TriangleSurface& surface, double spacing,
                                          double margin) {
  Box box{surface.nodes[0], surface.nodes[0]};
  for (const Point& p : surface.nodes)
    for (int a = 0; a < 3; ++a) {
      box.low[a] = std::min(box.low[a], p[a]);
      box.high[a] = std::max(box.high[a], p[a]);
    }
  DistanceField field(box, Axes{}, spacing, margin);
  const auto [nx, ny, nz] = field.count_;
  std::fill(field.phi_.begin(), field.phi_.end(), float(margin));
  std::vector<std::vector<std::pair<float, int>>> column(std::size_t(nx) *
                                                         ny);  // crossings along z
  for (const auto& t : surface.triangles) {
    const Point &a = surface.nodes[t[0]], &b = surface.nodes[t[1]], &c = surface.nodes[t[2]];
    std::array<int, 3> first, last;
    for (int d = 0; d < 3; ++d) {
      const double low = std::min({a[d], b[d], c[d]}) - margin,
                   high = std::max({a[d], b[d], c[d]}) + margin;
      first[d] = std::max(0, int(std::ceil((low - field.origin_[d]) / spacing)));
      last[d] = std::min(field.count_[d] - 1, int(std::floor((high - field.origin_[d]) / spacing)));
    }
    const Point across = cross(b - a, c - a);
    const Point normal = (1 / std::max(norm(across), 1e-12)) * across;
    for (int j = first[1]; j <= last[1]; ++j)
      for (int i = first[0]; i <= last[0]; ++i) {
        const Point foot{field.origin_.x + i * spacing, field.origin_.y + j * spacing, 0};
        for (int k = first[2]; k <= last[2]; ++k) {
          const Point p{foot.x, foot.y, field.origin_.z + k * spacing};
          float& nearest = field.at(i, j, k);
          const double height = dot(normal, p - a);
          if (height * height >= nearest * nearest)
            continue;  // not even the triangle's plane is nearer
          nearest = std::min(nearest, float(norm(p - closest_on_triangle(p, a, b, c))));
        }
        if (const auto crossing = crossing_of(foot, a, b, c))
          column[std::size_t(j) * nx + i].push_back(*crossing);
      }
  }
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      auto& crossings = column[std::size_t(j) * nx + i];
      std::sort(crossings.begin(), crossings.end());
      std::size_t c = 0;
      int winding = 0;
      for (int k = 0; k < nz; ++k) {
        while (c < crossings.size() && crossings[c].first <= field.origin_.z + k * spacing)
          winding += crossings[c++].second;
        if (winding > 0) field.at(i, j, k) = -field.at(i, j, k);
      }
    }
  return field;
}

double DistanceField::value(const Point& p) const {
  Point gradient;
  return value(p, gradient);
}

DistanceField DistanceField::symmetric(bool exact) const {
  // centre of the volume, half a cell where the surface passes through
  double moment = 0, sum = 0;
  for (int k = 0; k < count_[2]; ++k)
    for (int j = 0; j < count_[1]; ++j)
      for (int i = 0; i < count_[0]; ++i) {
        const double inside = std::clamp(0.5 - (at(i, j, k) - offset) / spacing_, 0.0, 1.0);
        sum += inside, moment += inside * (origin_.y + j * spacing_);
      }
  const double middle = sum > 0 ? moment / sum : 0;
  DistanceField measured = *this;
  if (exact) measured.measure_distance();
  DistanceField field = *this;
  const double low = origin_.y, high = low + (count_[1] - 1) * spacing_;
  const int half = int(std::ceil(std::max(std::abs(low), std::abs(high)) / spacing_));
  field.origin_.y = -half * spacing_;
  field.count_[1] = 2 * half + 1;
  field.phi_.assign(std::size_t(count_[0]) * field.count_[1] * count_[2], 0.0f);
  field.fill([&](const Point& q) {
    return 0.5 * (measured.value(axes_.to_bone({q.x, middle + q.y, q.z})) +
                  measured.value(axes_.to_bone({q.x, middle - q.y, q.z}))) +
           offset;
  });
  exact ? field.measure_distance() : field.divide_by_gradient();
  return field;
}

double DistanceField::value(const Point& p, Point& gradient) const {
  const Point q = axes_.to_grid(p) - origin_;
  int cell[3];
  double t[3];
  Point outside{0, 0, 0};  // how far p lies beyond the grid
  for (int a = 0; a < 3; ++a) {
    const double s = q[a] / spacing_, inside = std::clamp(s, 0.0, double(count_[a] - 1));
    cell[a] = std::min(int(inside), count_[a] - 2);
    t[a] = inside - cell[a];
    outside[a] = (s - inside) * spacing_;
  }
  const float* base = &phi_[std::size_t(cell[2] * count_[1] + cell[1]) * count_[0] + cell[0]];
  const std::size_t dy = count_[0], dz = std::size_t(count_[0]) * count_[1];
  const double c00 = base[0] + t[0] * (base[1] - base[0]),
               c10 = base[dy] + t[0] * (base[dy + 1] - base[dy]);
  const double c01 = base[dz] + t[0] * (base[dz + 1] - base[dz]);
  const double c11 = base[dz + dy] + t[0] * (base[dz + dy + 1] - base[dz + dy]);
  const double c0 = c00 + t[1] * (c10 - c00), c1 = c01 + t[1] * (c11 - c01);
  const double gx =
      (1 - t[2]) * ((1 - t[1]) * (base[1] - base[0]) + t[1] * (base[dy + 1] - base[dy])) +
      t[2] * ((1 - t[1]) * (base[dz + 1] - base[dz]) + t[1] * (base[dz + dy + 1] - base[dz + dy]));
  const double gy = (1 - t[2]) * (c10 - c00) + t[2] * (c11 - c01), gz = c1 - c0;
  Point slope{gx / spacing_, gy / spacing_, gz / spacing_};
  const double far = norm(outside);
  if (far > 0) slope = (1 / far) * outside;
  gradient = axes_.to_bone(slope);
  return c0 + t[2] * (c1 - c0) + far - offset;
}

std::vector<Point> DistanceField::surface_points(int stride) const {
  std::vector<Point> points;
  const int steps[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int k = 0; k + 1 < count_[2]; k += stride)
    for (int j = 0; j + 1 < count_[1]; j += stride)
      for (int i = 0; i + 1 < count_[0]; i += stride)
        for (const auto& d : steps) {
          const double a = at(i, j, k), b = at(i + d[0], j + d[1], k + d[2]);
          if ((a < 0) == (b < 0)) continue;
          const double t = a / (a - b);
          points.push_back(
              axes_.to_bone(origin_ + spacing_ * Point{i + t * d[0], j + t * d[1], k + t * d[2]}));
        }
  return points;
}

Box DistanceField::box() const {
  Box box{{1e9, 1e9, 1e9}, {-1e9, -1e9, -1e9}};
  for (int k = 0; k < count_[2]; ++k)
    for (int j = 0; j < count_[1]; ++j)
      for (int i = 0; i < count_[0]; ++i)
        if (at(i, j, k) < offset) {
          const int index[3] = {i, j, k};
          for (int a = 0; a < 3; ++a) {
            box.low[a] = std::min(box.low[a], origin_[a] + index[a] * spacing_);
            box.high[a] = std::max(box.high[a], origin_[a] + index[a] * spacing_);
          }
        }
  return box;
}

namespace {

// share of a cell of the dual grid that is inside: full where phi < -s/2, empty where phi > s/2,
// linear between
double inside_share(double phi, double spacing) {
  return std::clamp(0.5 - phi / spacing, 0.0, 1.0);
}

}  // namespace

double DistanceField::volume() const {
  double sum = 0;
  for (const float phi : phi_) sum += inside_share(phi - offset, spacing_);
  return sum * spacing_ * spacing_ * spacing_;
}

void DistanceField::match_volume(double volume, double most) {
  // values so deep or so far out that no offset changes their share are counted once
  std::vector<float> near;
  double deep = 0;
  for (const float phi : phi_)
    if (phi < -most - spacing_)
      deep += 1;
    else if (phi < most + spacing_)
      near.push_back(phi);
  const double wanted = volume / (spacing_ * spacing_ * spacing_);
  double low = -most, high = most;
  for (int i = 0; i < 14; ++i) {
    offset = 0.5 * (low + high);
    double sum = deep;
    for (const float phi : near) sum += inside_share(phi - offset, spacing_);
    (sum < wanted ? low : high) = offset;
  }
}

}  // namespace fabrica::body
