#include "body/fixture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "body/cards.h"
#include "body/mesh/shell_layer.h"

namespace fabrica::body {
namespace {

// x along the axis, -z toward the bones
Mat3d axes_of(const RigFixture& fixture) {
  const Point z = -1.0 * fixture.toward;
  Point x = fixture.axis;
  if (fixture.shape == RigFixture::ball)  // any direction across
    x = cross(std::abs(z.x) < 0.7 ? Point{1, 0, 0} : Point{0, 1, 0}, z);
  x = unit(x);
  const Point y = cross(z, x);
  return {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
}

double pad_thickness(const RigFixture& fixture) { return fixture.pad ? fixture.pad->thickness : 0; }

// height of the fixture's lower side over its centre at a place of its footprint; nothing beside it
std::optional<double> lower_side(const RigFixture& fixture, double x, double y) {
  const double r = fixture.radius;
  switch (fixture.shape) {
    case RigFixture::ball:
      if (x * x + y * y < r * r) return -std::sqrt(r * r - x * x - y * y);
      return {};
    case RigFixture::cylinder:
      if (std::abs(x) <= fixture.length / 2 && std::abs(y) < r) return -std::sqrt(r * r - y * y);
      return {};
    case RigFixture::box:
      if (std::abs(x) <= fixture.size.x / 2 && std::abs(y) <= fixture.size.y / 2)
        return -fixture.size.z / 2 - pad_thickness(fixture);
  }
  return {};
}

// Points of the surface to which contact reaches: the faces of a bone, each at five by five places,
// moved out by half the thickness of its shell.
std::vector<Point> contact_surface(const PlacedBone& bone, bool rigid) {
  constexpr int n = 4;
  const std::vector<double> shell = bone.mesh.cortex.empty() || rigid
                                        ? std::vector<double>(bone.mesh.surface.size(), 0)
                                        : shell_thickness(bone.mesh, bone.mesh.cortex);
  std::vector<Point> points;
  for (std::size_t q = 0; q < bone.mesh.surface.size(); ++q) {
    std::array<Point, 4> c;
    for (std::size_t k = 0; k < 4; ++k) c[k] = bone.nodes[std::size_t(bone.mesh.surface[q][k])];
    const Point area = cross(c[2] - c[0], c[3] - c[1]);
    const Point out = (0.5 * shell[q] / norm(area)) * area;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j) {
        const double u = double(i) / n, v = double(j) / n;
        points.push_back((1 - u) * ((1 - v) * c[0] + v * c[3]) + u * ((1 - v) * c[1] + v * c[2]) +
                         out);
      }
  }
  return points;
}

ShapeMesh mesh_of(const RigFixture& fixture) {
  switch (fixture.shape) {
    case RigFixture::ball:
      return ball_mesh(fixture.radius, fixture.element);
    case RigFixture::cylinder:
      return cylinder_mesh(fixture.radius, fixture.length, fixture.element);
    case RigFixture::box:
      break;
  }
  return box_mesh(fixture.size, fixture.element, pad_thickness(fixture));
}

// the foam of the pad; its part
std::int64_t add_pad(const RigFixture& fixture, AssembledBody& assembled, Builder& builder,
                     RigCards& cards) {
  const double id = double(assembled.next_part++);
  const double curve = double(cards.curve(fixture.name + " pad", fixture.pad->compression));
  builder.add_card("MAT_LOW_DENSITY_FOAM")
      .set("mid", id)
      .set("ro", fixture.pad->density)
      .set("e", fixture.pad->modulus)
      .set("lcid", curve);
  builder.add_card("SECTION_SOLID").set("secid", id).set("elform", 1);
  Card& part = builder.add_card("PART");
  part.title = "rig." + fixture.name + " pad";
  part.set("pid", id).set("secid", id).set("mid", id);
  return std::int64_t(id);
}

}  // namespace

MountedPart add_fixture(const Rig& rig, const RigFixture& fixture, const Body& body,
                        AssembledBody& assembled, Builder& builder, RigCards& cards) {
  const Placement start{axes_of(fixture), fixture.at};
  double height = std::numeric_limits<double>::lowest();
  std::vector<std::int64_t> parts;
  for (const BoneName& name : fixture.touches) {
    const int b = need_bone(rig, body, name);
    bool rigid = false;
    for (const PartEntry& part : assembled.parts)
      if (part.bone == b) parts.push_back(part.id), rigid = rigid || part.rigid;
    const PlacedBone& bone = body.bones[std::size_t(b)];
    for (const Point& x : contact_surface(bone, rigid)) {
      const Point p = start.inverse(x);
      if (const auto low = lower_side(fixture, p.x, p.y)) height = std::max(height, p.z - *low);
    }
  }
  if (height == std::numeric_limits<double>::lowest())
    throw BodyError(fmt::format("{}: fixture '{}' passes {} by; change its 'at' or 'toward'",
                                rig.path, fixture.name, fixture.touches.front().text));
  const Placement place{start.R, start(Point{0, 0, height + fixture.gap})};
  const ShapeMesh mesh = mesh_of(fixture);
  const std::int64_t id =
      cards.rigid_part(fixture.name, fixture.mass / mesh.volume(), fixture.support,
                       cards.curves(fixture.name, fixture.support));
  const std::int64_t face = fixture.pad ? add_pad(fixture, assembled, builder, cards) : id;
  add_shape(mesh, id, face, place, assembled, builder);
  Card& c = builder.add_card("CONTACT_AUTOMATIC_SURFACE_TO_SURFACE");
  c.options = {"ID"};
  c.set("cid", double(id)).set("heading", fixture.name);
  c.set("ssid", double(cards.set("SET_PART_LIST", fixture.name, parts)))
      .set("msid", double(face))
      .set("sstyp", 2)
      .set("mstyp", 3)
      .set("fs", fixture.friction)
      .set("fd", fixture.friction)
      .set("soft", 1);
  return {id, fixture.name, place.t};
}

}  // namespace fabrica::body
