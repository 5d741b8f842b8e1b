// Segment sets: by corner nodes, or as the outer surface of parts.
#include <algorithm>

#include "model/geometry.h"
#include "model/resolve.h"

namespace fabrica {

void Resolver::read_segment_set(const Card& card) {
  SegmentSet set{card.id("sid"), card.title, {}};
  if (card.schema->name == "SET_SEGMENT_GENERAL") {
    general_segments(card, set.segments);
  } else {
    for (int r = 0; r < card.row_count(); ++r) {
      std::array<int, 4> s;
      bool complete = true;
      for (int k = 0; k < 4; ++k) {
        std::int64_t id = to_id(card.row(r, k));
        if (k == 3 && id == 0) id = to_id(card.row(r, 2));
        s[k] = node(id);
        if (s[k] >= 0) continue;
        complete = false;
        if (may_report("missing-node"))
          diagnostics_.error("missing-node", card.where_of_row(r), card.schema->name,
                             "n" + std::to_string(k + 1),
                             "segment names node " + std::to_string(id) + ", which does not exist",
                             "Define the node, or correct the segment");
      }
      if (complete) set.segments.push_back(s);
    }
  }
  if (define("segment_set", set.id, int(model_.segment_sets.size()), card, "sid"))
    model_.segment_sets.push_back(std::move(set));
}

// Rows SEG, PART, SET_PART, SHELL, SET_SHELL and SET_SEGMENT.
bool Resolver::general_segments(const Card& card, std::vector<std::array<int, 4>>& segments) {
  const auto add_shell = [&](int e) {
    if (e >= 0) segments.push_back(model_.shells.node[e]);
  };
  for (int r = 0; r < card.row_count(); ++r) {
    const std::string option(card.row_text(r, 0));
    if (option == "SEG") {
      std::array<int, 4> s;
      for (int k = 0; k < 4; ++k) s[k] = node(to_id(card.row(r, k + 1)));
      if (s[3] < 0) s[3] = s[2];
      if (*std::min_element(s.begin(), s.end()) >= 0) segments.push_back(s);
      continue;
    }
    for (int c = 1; c < card.columns(); ++c) {
      const auto id = to_id(card.row(r, c));
      if (id == 0) continue;
      if (option == "PART") {
        if (const int p = part(id); p >= 0) segments_of_part(p, segments);
      } else if (option == "SET_PART") {
        if (const int s = reference("part_set", id); s >= 0)
          for (int p : model_.part_sets[s].parts) segments_of_part(p, segments);
      } else if (option == "SHELL") {
        add_shell(table("shell").find(id));
      } else if (option.starts_with("SET_SHELL")) {
        if (const int s = reference("shell_set", id); s >= 0)
          for (int e : model_.element_sets[s].elements) add_shell(e);
      } else if (option.starts_with("SET_SEG")) {
        if (const int s = reference("segment_set", id); s >= 0) {
          const auto more = model_.segment_sets[s].segments;
          segments.insert(segments.end(), more.begin(), more.end());
        }
      } else {
        unsupported(card, "sid", "unsupported-set-option",
                    "the row option " + option + " is not known",
                    "Use SEG, PART, SET_PART, SHELL, SET_SHELL or SET_SEGMENT");
        return false;
      }
    }
  }
  return true;
}

// Shells, and the faces of solids that no other solid of the part shares; normals point outwards.
void Resolver::segments_of_part(int part, std::vector<std::array<int, 4>>& segments) const {
  for (int e : elements_of_part(Family::shell, part)) segments.push_back(model_.shells.node[e]);

  struct Face {
    std::array<int, 4> key, node;
  };
  std::vector<Face> all;
  for (int e : elements_of_part(Family::solid, part)) {
    const auto& n = model_.solids.node[e];
    for (const auto& f : brick_faces) {
      Face face{{}, {n[f[0]], n[f[1]], n[f[2]], n[f[3]]}};
      // distinct corners in order; a face of a degenerate brick may be a triangle or nothing
      std::vector<int> corners;
      for (int k : face.node)
        if (std::find(corners.begin(), corners.end(), k) == corners.end()) corners.push_back(k);
      if (corners.size() < 3) continue;
      if (corners.size() == 3) corners.push_back(corners[2]);
      std::copy(corners.begin(), corners.end(), face.node.begin());
      if (corners[3] == corners[2]) corners[3] = -1;
      std::sort(corners.begin(), corners.end());
      std::copy(corners.begin(), corners.end(), face.key.begin());
      all.push_back(face);
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Face& a, const Face& b) { return a.key < b.key; });
  for (std::size_t i = 0; i < all.size();) {
    std::size_t j = i + 1;
    while (j < all.size() && all[j].key == all[i].key) ++j;
    if (j == i + 1) segments.push_back(all[i].node);
    i = j;
  }
}

}  // namespace fabrica
