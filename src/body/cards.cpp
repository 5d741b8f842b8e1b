#include "body/cards.h"

#include <cmath>

namespace fabrica::body {

Card& titled(Builder& builder, const char* keyword, const std::string& title) {
  Card& card = builder.add_card(keyword);
  card.options = {"TITLE"};
  card.title = title;
  return card;
}

Point to_field(const Point& p) {
  constexpr double per_mm = 1e6;
  return {std::round(p.x * per_mm) / per_mm, std::round(p.y * per_mm) / per_mm,
          std::round(p.z * per_mm) / per_mm};
}
double to_field(double thickness) { return std::round(thickness * 1024) / 1024; }

void add_curve(Builder& builder, std::int64_t id, const std::string& title,
               const std::vector<std::pair<double, double>>& points) {
  Card& curve = titled(builder, "DEFINE_CURVE", title);
  curve.set("lcid", double(id));
  for (const auto& [x, y] : points) curve.add_row({x, y});
}

void add_shape(const ShapeMesh& mesh, std::int64_t part, std::int64_t pad,
               const Placement& placement, AssembledBody& assembled, Builder& builder) {
  const std::int64_t first = assembled.next_node;
  for (const Point& p : mesh.nodes) builder.add_node(assembled.next_node++, placement(p));
  for (std::size_t e = 0; e < mesh.bricks.size(); ++e) {
    std::array<std::int64_t, 8> corner{};
    for (std::size_t k = 0; k < 8; ++k) corner[k] = first + mesh.bricks[e][k];
    builder.add_solid(assembled.next_element++,
                      e + mesh.pad_bricks < mesh.bricks.size() ? part : pad, corner.data(), 8);
  }
}

}  // namespace fabrica::body
