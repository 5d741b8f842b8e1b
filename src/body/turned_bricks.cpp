#include "body/turned_bricks.h"

#include <algorithm>

namespace fabrica::body {

bool turned_over(const Corners& corners) {
  for (int c = 0; c < 8; ++c) {
    const auto& next = corner_neighbours[c];
    const Point a = corners[next[0]] - corners[c], b = corners[next[1]] - corners[c],
                d = corners[next[2]] - corners[c];
    if (dot(a, cross(b, d)) < 0) return true;
  }
  return false;
}

std::string kind_of_part(const std::string& title) {
  const auto has = [&](const char* text) { return title.find(text) != std::string::npos; };
  if (has("costal_cartilage")) return "costal cartilage";
  if (has(".cartilage_")) return "joint cartilage";
  if (has("_meniscus")) return "meniscus";
  if (has(".disc")) return "disc";
  for (const char* tissue :
       {".cortical", ".trabecular", ".outer_table", ".diploe", ".inner_table", ".whole"})
    if (title.ends_with(tissue)) return "bone";
  return "other";
}

TurnedBrickCounter::TurnedBrickCounter(std::vector<Brick> bricks, std::vector<std::string> title)
    : bricks_(std::move(bricks)), title_(std::move(title)), ever_(bricks_.size()) {
  for (const std::string& t : title_) {
    kind_.push_back(&kinds_[kind_of_part(t)]);
    ++kind_.back()->bricks;
  }
}

void TurnedBrickCounter::take(double time, const std::vector<Point>& nodes,
                              const std::vector<std::uint8_t>& alive) {
  for (auto& [name, kind] : kinds_) kind.last = 0;
  for (std::size_t e = 0; e < bricks_.size(); ++e) {
    if (!alive.empty() && !alive[e]) continue;
    if (!turned_over(corners_of(nodes, bricks_[e]))) continue;
    ++kind_[e]->last;
    if (!ever_[e]) ++kind_[e]->ever, ++kind_[e]->parts[title_[e]];
    ever_[e] = true;
  }
  for (auto& [name, kind] : kinds_)
    if (kind.last > kind.most) kind.most = kind.last, kind.most_time = time;
}

}  // namespace fabrica::body
