#include "app/bench_models.h"

#include <cmath>

namespace fabrica {
namespace {

void add_controls(Builder& b) { b.add_card("CONTROL_TERMINATION").set("endtim", 1.0); }

void add_steel(Builder& b, int id) {
  b.add_card("MAT_PLASTIC_KINEMATIC")
      .set("mid", id)
      .set("ro", 7.85e-6)
      .set("e", 210)
      .set("pr", 0.3)
      .set("sigy", 0.3)
      .set("etan", 2.1);
}

void add_part(Builder& b, int id, int section, int material) {
  Card card("PART");
  card.title = "block " + std::to_string(id);
  card.set("pid", id).set("secid", section).set("mid", material);
  b.add_card(std::move(card));
}

// a rigid wall in the plane z = 0
void add_floor(Builder& b) {
  b.add_card("RIGIDWALL_PLANAR")
      .set("xt", 0)
      .set("yt", 0)
      .set("zt", 0)
      .set("xh", 0)
      .set("yh", 0)
      .set("zh", 1);
}

// nx x ny x nz cells of edge h; node and element ids start after the given ones
void add_bricks(Builder& b, int part, int nx, int ny, int nz, double h, Vec3d at,
                std::int64_t node0, std::int64_t element0) {
  auto id = [&](int i, int j, int k) {
    return node0 + 1 + i + std::int64_t(nx + 1) * (j + std::int64_t(ny + 1) * k);
  };
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i)
        b.add_node(id(i, j, k), {at.x + h * i, at.y + h * j, at.z + h * k});
  std::int64_t e = element0;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const std::int64_t n[8] = {
            id(i, j, k),     id(i + 1, j, k),     id(i + 1, j + 1, k),     id(i, j + 1, k),
            id(i, j, k + 1), id(i + 1, j, k + 1), id(i + 1, j + 1, k + 1), id(i, j + 1, k + 1)};
        b.add_solid(++e, part, n, 8);
      }
}

void add_velocity(Builder& b, int part, double vz) {
  b.add_card("INITIAL_VELOCITY_GENERATION").set("id", part).set("styp", 2).set("vz", vz);
}

int cube_side(int elements) { return int(std::lround(std::cbrt(double(elements)))); }

}  // namespace

std::unique_ptr<Model> bench_bricks(int elements, Diagnostics& diagnostics) {
  Builder b(diagnostics);
  add_controls(b);
  const int n = cube_side(elements);
  add_bricks(b, 1, n, n, n, 2.0, {0, 0, 0.5}, 0, 0);
  b.add_card("SECTION_SOLID").set("secid", 1).set("elform", 1);
  add_steel(b, 1);
  add_part(b, 1, 1, 1);
  add_velocity(b, 1, -10);
  add_floor(b);
  return b.finish();
}

std::unique_ptr<Model> bench_tets(int elements, Diagnostics& diagnostics) {
  Builder b(diagnostics);
  add_controls(b);
  const int n = cube_side(elements / 6);
  const double h = 2.0;
  auto id = [&](int i, int j, int k) {
    return std::int64_t(1) + i + std::int64_t(n + 1) * (j + std::int64_t(n + 1) * k);
  };
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) b.add_node(id(i, j, k), {h * i, h * j, h * k + 0.5});
  // six tetrahedra around the cell's diagonal 1-7
  static const int split[6][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6},
                                  {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
  std::int64_t e = 0;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const std::int64_t c[8] = {
            id(i, j, k),     id(i + 1, j, k),     id(i + 1, j + 1, k),     id(i, j + 1, k),
            id(i, j, k + 1), id(i + 1, j, k + 1), id(i + 1, j + 1, k + 1), id(i, j + 1, k + 1)};
        for (const auto& t : split) {
          const std::int64_t t8[8] = {c[t[0]], c[t[1]], c[t[2]], c[t[3]],
                                      c[t[3]], c[t[3]], c[t[3]], c[t[3]]};
          b.add_solid(++e, 1, t8, 8);
        }
      }
  b.add_card("SECTION_SOLID").set("secid", 1).set("elform", 10);
  b.add_card("MAT_ELASTIC").set("mid", 1).set("ro", 1.1e-6).set("e", 0.5).set("pr", 0.4);
  add_part(b, 1, 1, 1);
  add_velocity(b, 1, -1);
  add_floor(b);
  return b.finish();
}

std::unique_ptr<Model> bench_shells(int elements, Diagnostics& diagnostics) {
  Builder b(diagnostics);
  add_controls(b);
  const int n = int(std::lround(std::sqrt(double(elements))));
  const double h = 5.0;
  auto id = [&](int i, int j) { return std::int64_t(1) + i + std::int64_t(n + 1) * j; };
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      b.add_node(id(i, j), {h * i, h * j, 0.2 * std::sin(0.7 * i) * std::cos(0.4 * j)},
                 i == 0 ? 7 : 0, i == 0 ? 7 : 0);
  std::int64_t e = 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const std::int64_t q[4] = {id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)};
      b.add_shell(++e, 1, q, 4);
    }
  b.add_card("SECTION_SHELL")
      .set("secid", 1)
      .set("elform", 2)
      .set("nip", 5)
      .set("t1", 1.5)
      .set("shrf", 0.8333);
  add_steel(b, 1);
  add_part(b, 1, 1, 1);
  add_velocity(b, 1, 5);
  return b.finish();
}

std::unique_ptr<Model> bench_contact(int elements, Diagnostics& diagnostics) {
  Builder b(diagnostics);
  add_controls(b);
  const int n = cube_side(elements / 2), m = n - 1;
  add_bricks(b, 1, n, n, n, 2.0, {0, 0, 0}, 0, 0);
  const std::int64_t nodes = std::int64_t(n + 1) * (n + 1) * (n + 1);
  add_bricks(b, 2, m, m, m, 2.0, {0.7, 0.6, 2.0 * n + 0.05}, nodes, std::int64_t(n) * n * n);
  b.add_card("SECTION_SOLID").set("secid", 1).set("elform", 1);
  add_steel(b, 1);
  add_part(b, 1, 1, 1);
  add_part(b, 2, 1, 1);
  add_velocity(b, 1, 5);
  add_velocity(b, 2, -5);
  Card contact("CONTACT_AUTOMATIC_SURFACE_TO_SURFACE");
  contact.set("ssid", 1)
      .set("msid", 2)
      .set("sstyp", 3)
      .set("mstyp", 3)
      .set("fs", 0.2)
      .set("fd", 0.2);
  b.add_card(std::move(contact));
  return b.finish();
}

}  // namespace fabrica
