#include "body/joints/elastic.h"

#include <algorithm>
#include <cmath>

#include "base/lane_math.h"
#include "base/pack.h"
#include "body/mesh/minimise.h"
#include "body/mesh/quality.h"

namespace fabrica::body {

namespace {

constexpr double bulk = 6;         // b of (1): bones keep their volume
constexpr double anchor = 2e-5;    // [1/mm2] k of (2)
constexpr double length = 5;       // [mm] h of (2)
constexpr double flat = 0.05;      // D below which (1) goes on linearly: never reached at rest
constexpr double most_move = 0.7;  // [mm] of a node in one iteration

using Lanes = Pack<double, 8>;  // one lane a corner

Mat3d edges_at(const Corners& x, int corner) {
  Mat3d m;
  for (int k = 0; k < 3; ++k) {
    const Point e = x[std::size_t(corner_neighbours[corner][k])] - x[std::size_t(corner)];
    for (int i = 0; i < 3; ++i) m(i, k) = e[i];
  }
  return m;
}

// energy (1) of a brick; adds its gradient by the corners' places
double brick_energy(const Corners& x, const std::array<double, 72>& rest, Corners& gradient) {
  Lanes F[3][3], R[3][3];
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j) R[k][j] = Lanes::load(&rest[std::size_t(8 * (3 * k + j))]);
  alignas(64) double edge[3][3][8];  // component, neighbour, corner
  for (int c = 0; c < 8; ++c)
    for (int k = 0; k < 3; ++k) {
      const Point e = x[std::size_t(corner_neighbours[c][k])] - x[std::size_t(c)];
      for (int i = 0; i < 3; ++i) edge[i][k][c] = e[i];
    }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      F[i][j] = Lanes::load(edge[i][0]) * R[0][j] + Lanes::load(edge[i][1]) * R[1][j] +
                Lanes::load(edge[i][2]) * R[2][j];
  Lanes C[3][3];  // cofactors: dD / dF
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int a = (i + 1) % 3, b = (i + 2) % 3, p = (j + 1) % 3, q = (j + 2) % 3;
      C[i][j] = F[a][p] * F[b][q] - F[a][q] * F[b][p];
    }
  const Lanes D = F[0][0] * C[0][0] + F[0][1] * C[0][1] + F[0][2] * C[0][2];
  const Lanes chi = max(D, Lanes(flat));
  const Lanes held = select(D > Lanes(flat), Lanes(1.0), Lanes(0.0));
  Lanes square(0.0);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) square = square + F[i][j] * F[i][j];
  const Lanes root = cbrt(chi);
  const Lanes scale = Lanes(1.0 / 3.0) / (root * root);
  const Lanes f = square * scale;
  const Lanes g = Lanes(0.5) * (chi + Lanes(1.0) / chi);
  // below `flat` a steep line keeps pulling corners back
  const Lanes steep(200.0);
  const Lanes energy = f * f * f - Lanes(1.0) + Lanes(bulk) * (g - Lanes(1.0)) + steep * (chi - D);
  const Lanes by_F = Lanes(6.0) * f * f * scale;
  const Lanes by_D = held * (Lanes(-2.0) * f * f * f / chi +
                             Lanes(0.5 * bulk) * (Lanes(1.0) - Lanes(1.0) / (chi * chi))) -
                     (Lanes(1.0) - held) * steep;
  double sum = 0;
  for (int c = 0; c < 8; ++c) sum += get(energy, c);
  for (int i = 0; i < 3; ++i) {
    Lanes P[3];
    for (int j = 0; j < 3; ++j) P[j] = by_F * F[i][j] + by_D * C[i][j];
    for (int k = 0; k < 3; ++k) {
      const Lanes pull = P[0] * R[k][0] + P[1] * R[k][1] + P[2] * R[k][2];
      alignas(64) double at[8];
      pull.store(at);
      for (int c = 0; c < 8; ++c) {
        gradient[std::size_t(corner_neighbours[c][k])][i] += at[c];
        gradient[std::size_t(c)][i] -= at[c];
      }
    }
  }
  return sum;
}

}  // namespace

ElasticBones::ElasticBones(const std::vector<PlacedBone>& bones, const Mirror& mirror)
    : rest_(bones.size()), mirror_(mirror) {
  for (std::size_t b = 0; b < bones.size(); ++b) {
    start_.push_back(bones[b].nodes);
    for (const Brick& brick : bones[b].mesh.bricks) {
      const Corners x = corners_of(bones[b].nodes, brick);
      Rest& rest = rest_[b].emplace_back();
      for (int c = 0; c < 8; ++c) {
        const Mat3d m = inverse(edges_at(x, c));
        for (int k = 0; k < 3; ++k)
          for (int j = 0; j < 3; ++j) rest.m[std::size_t(8 * (3 * k + j) + c)] = m(k, j);
      }
    }
  }
}

namespace {

// The bones that take part, all their nodes in one list. Left nodes that mirror right ones follow
// them; nodes farther than `influence` from every touch stay.
class Together {
 public:
  Together(const std::vector<PlacedBone>& bones, const Mirror& mirrors,
           const std::vector<Touch>& touches)
      : bones_(bones), first(bones.size(), -1), near(bones.size()) {
    std::vector<std::vector<Point>> places = places_of(touches, mirrors);
    for (std::size_t b = 0; b < bones.size(); ++b) {
      if (places[b].empty()) continue;
      first[b] = int(nodes.size());
      nodes.insert(nodes.end(), bones[b].nodes.begin(), bones[b].nodes.end());
      choose_bricks(b, places[b]);
    }
    leader_.assign(nodes.size(), -1);
    for (std::size_t b = 0; b < bones.size(); ++b)
      if (takes_part(b)) choose_leaders(b, mirrors);
    for (std::size_t n = 0; n < nodes.size(); ++n)
      if (is_free_[n] && (leader_[n] < 0 || leader_[n] == int(n))) free_.push_back(n);
  }
  bool takes_part(std::size_t b) const { return first[b] >= 0; }
  // the nodes that move of themselves
  std::vector<Point> moving() const {
    std::vector<Point> list;
    for (const std::size_t n : free_) list.push_back(nodes[n]);
    return list;
  }
  // puts them in their places, left nodes at the mirror images of right ones
  void place(const std::vector<Point>& moving) {
    for (std::size_t i = 0; i < free_.size(); ++i) nodes[free_[i]] = moving[i];
    for (std::size_t n = 0; n < nodes.size(); ++n)
      if (leader_[n] >= 0 && leader_[n] != int(n))
        nodes[n] = mirror(nodes[std::size_t(leader_[n])]);
  }
  // the gradient by left nodes goes to right ones, then that of the nodes that move
  void reduce(std::vector<Point>& by_node, std::vector<Point>& gradient) const {
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (leader_[n] < 0) continue;
      if (leader_[n] == int(n))
        by_node[n].y = 0;  // in the plane of symmetry
      else
        by_node[std::size_t(leader_[n])] += mirror(by_node[n]);
    }
    for (std::size_t i = 0; i < free_.size(); ++i) gradient[i] = by_node[free_[i]];
  }

 private:
  // where each bone is touched; of a pair both in the same places
  std::vector<std::vector<Point>> places_of(const std::vector<Touch>& touches,
                                            const Mirror& mirrors) const {
    std::vector<std::vector<Point>> places(bones_.size());
    const auto at = [&](int b, int n) { return bones_[std::size_t(b)].nodes[std::size_t(n)]; };
    const auto add = [&](int b, int n) {
      const Point p = at(b, n);
      places[std::size_t(b)].push_back(p);
      const int twin = mirrors.own[std::size_t(b)] ? b : mirrors.twin[std::size_t(b)];
      if (twin >= 0) places[std::size_t(twin)].push_back(mirror(p));
    };
    for (const Touch& t : touches) add(t.a, t.node), add(t.b, t.quad[0]);
    return places;
  }
  // the node that each follows: its image on the right, of a node in the plane of symmetry itself
  void choose_leaders(std::size_t b, const Mirror& mirrors) {
    const std::size_t base = std::size_t(first[b]);
    const int twin = bones_[b].side == Side::left ? mirrors.twin[b] : -1;
    for (std::size_t n = 0; n < bones_[b].nodes.size(); ++n) {
      if (twin >= 0) leader_[base + n] = first[std::size_t(twin)] + int(n);
      if (!mirrors.own[b]) continue;
      const std::size_t image = std::size_t(bones_[b].mesh.image[n]);
      if (image <= n) leader_[base + n] = int(base + image);
    }
  }
  void choose_bricks(std::size_t b, const std::vector<Point>& places) {
    const std::vector<Point>& x = bones_[b].nodes;
    const std::size_t base = std::size_t(first[b]);
    is_free_.resize(nodes.size(), 0);
    for (std::size_t n = 0; n < x.size(); ++n)
      is_free_[base + n] = std::any_of(places.begin(), places.end(), [&](const Point& p) {
        return dot(x[n] - p, x[n] - p) < ElasticBones::influence * ElasticBones::influence;
      });
    for (std::size_t e = 0; e < bones_[b].mesh.bricks.size(); ++e) {
      const Brick& brick = bones_[b].mesh.bricks[e];
      if (std::any_of(brick.begin(), brick.end(),
                      [&](int n) { return is_free_[base + std::size_t(n)] != 0; }))
        near[b].push_back(e);
    }
  }
  const std::vector<PlacedBone>& bones_;
  std::vector<char> is_free_;
  std::vector<int> leader_;  // node that this one mirrors, itself in the plane of symmetry, or -1
  std::vector<std::size_t> free_;

 public:
  std::vector<int> first;                      // bone -> its first node, -1: takes no part
  std::vector<std::vector<std::size_t>> near;  // bone -> bricks that can move
  std::vector<Point> nodes;
};

// touches of (2)
double touch_energy(const Together& all, const std::vector<Touch>& touches, double stiffness,
                    const std::vector<Point>& x, std::vector<Point>& gradient) {
  double sum = 0;
  for (const Touch& t : touches) {
    const std::size_t node = std::size_t(all.first[std::size_t(t.a)] + t.node);
    const int base = all.first[std::size_t(t.b)];
    Point place{0, 0, 0};
    for (std::size_t i = 0; i < 4; ++i) place += t.weight[i] * x[std::size_t(base + t.quad[i])];
    const double missing = t.gap - dot(x[node] - place, t.normal);
    if (missing <= 0) continue;
    sum += stiffness * missing * missing;
    const Point pull = (2 * stiffness * missing) * t.normal;
    gradient[node] -= pull;
    for (std::size_t i = 0; i < 4; ++i)
      gradient[std::size_t(base + t.quad[i])] += t.weight[i] * pull;
  }
  return sum;
}

}  // namespace

double ElasticBones::own_energy(std::size_t bone, const std::vector<std::array<int, 8>>& bricks,
                                const std::vector<std::size_t>& near, double times, const Point* x,
                                Point* gradient) const {
  double sum = 0;
  for (std::size_t n = 0; n < start_[bone].size(); ++n) {
    const Point u = x[n] - start_[bone][n];
    sum += times * anchor * dot(u, u);
    gradient[n] += (2 * times * anchor) * u;
  }
  for (const std::size_t e : near) {
    Corners corners, pull{};
    for (std::size_t c = 0; c < 8; ++c) corners[c] = x[bricks[e][c]];
    sum += times * brick_energy(corners, rest_[bone][e].m, pull);
    for (std::size_t c = 0; c < 8; ++c) gradient[bricks[e][c]] += times * pull[c];
  }
  return sum;
}

void ElasticBones::press(std::vector<PlacedBone>& bones, const std::vector<Touch>& touches,
                         double weight, int iterations) const {
  Together all(bones, mirror_, touches);
  std::vector<Point> moving = all.moving(), by_node(all.nodes.size());
  const auto energy = [&](const std::vector<Point>& at, std::vector<Point>& gradient) {
    all.place(at);
    std::fill(by_node.begin(), by_node.end(), Point{0, 0, 0});
    double sum = touch_energy(all, touches, weight / (length * length), all.nodes, by_node);
    for (std::size_t b = 0; b < bones.size(); ++b) {
      const bool twin = mirror_.twin[b] >= 0;
      if (!all.takes_part(b) || (twin && bones[b].side == Side::left)) continue;
      const std::size_t base = std::size_t(all.first[b]);
      // a left bone has the energy of the right one
      sum += own_energy(b, bones[b].mesh.bricks, all.near[b], twin ? 2 : 1, &all.nodes[base],
                        &by_node[base]);
    }
    all.reduce(by_node, gradient);
    return sum;
  };
  minimise(energy, moving, most_move, iterations);
  all.place(moving);
  for (std::size_t b = 0; b < bones.size(); ++b)
    if (all.takes_part(b))
      for (std::size_t n = 0; n < bones[b].nodes.size(); ++n)
        bones[b].nodes[n] = all.nodes[std::size_t(all.first[b]) + n];
}

}  // namespace fabrica::body
