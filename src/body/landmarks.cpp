#include "body/landmarks.h"

#include <fmt/format.h>

#include "body/tables.h"

namespace fabrica::body {

std::vector<Landmark> landmarks(const Skeleton& skeleton, const std::string& column) {
  static const Table table("anatomy/landmarks.csv");
  std::vector<Landmark> list;
  for (int r = 0; r < table.rows(); ++r) {
    const std::string& frame = table.text(r, "frame");
    const auto at = [&](const std::string& c) {
      return Point{table.number(r, "x_" + c), table.number(r, "y_" + c), table.number(r, "z_" + c)};
    };
    const Point standing = at("stand");
    if (frame == "ground") continue;
    const bool midline = std::abs(standing.y) < 1 && !skeleton.has_frame(frame, Side::right);
    for (const Side side : {Side::right, Side::left}) {
      if (midline && side == Side::left) continue;
      Landmark mark;
      mark.name = table.text(r, "name"), mark.kind = table.text(r, "kind"), mark.frame = frame;
      mark.side = midline ? Side::midline : side;
      mark.x = skeleton.carried(frame, side, side == Side::left ? mirror(standing) : standing);
      mark.in_table = !table.text(r, "x_" + column).empty();
      if (mark.in_table) mark.table = side == Side::left ? mirror(at(column)) : at(column);
      list.push_back(mark);
    }
  }
  return list;
}

std::string landmarks_csv(const Skeleton& skeleton) {
  std::string text =
      "# landmarks of the posed skeleton, mm: X forward, Y left, Z "
      "up\nname,side,kind,frame,x,y,z\n";
  for (const Landmark& m : landmarks(skeleton))
    text += fmt::format("{},{},{},{},{:.2f},{:.2f},{:.2f}\n", m.name,
                        m.side == Side::midline ? "mid"
                        : m.side == Side::left  ? "left"
                                                : "right",
                        m.kind, m.frame, m.x.x, m.x.y, m.x.z);
  return text;
}

}  // namespace fabrica::body
