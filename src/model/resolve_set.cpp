// Sets of nodes, parts, segments and elements, by lists, ranges, unions and general rows.
#include <algorithm>

#include "model/resolve.h"

namespace fabrica {

// Members in the order they were first named; a later row may take one out again.
struct Resolver::Marks {
  explicit Marks(std::size_t n) : in(n, 0), seen(n, 0) {}
  void add(int i) {
    if (i < 0) return;
    in[i] = 1;
    if (!seen[i]) seen[i] = 1, order.push_back(i);
  }
  void remove(int i) {
    if (i >= 0) in[i] = 0;
  }
  std::vector<int> members() const {
    std::vector<int> list;
    for (int i : order)
      if (in[i]) list.push_back(i);
    return list;
  }
  std::vector<std::uint8_t> in, seen;
  std::vector<int> order;
};

namespace {

struct ElementKind {
  std::string_view word;  // in keywords: SHELL
  const char* kind;       // of elements
  const char* set;        // of their sets
  Family family;
};
constexpr ElementKind element_kinds[] = {
    {"SHELL", "shell", "shell_set", Family::shell},
    {"SOLID", "solid", "solid_set", Family::solid},
    {"BEAM", "beam", "beam_set", Family::beam},
    {"DISCRETE", "discrete", "discrete_set", Family::discrete},
};

// the kind of element of a keyword "SET_SHELL_LIST", or null
const ElementKind* kind_of_keyword(std::string_view keyword) {
  for (const ElementKind& k : element_kinds)
    if (keyword.substr(4).starts_with(k.word)) return &k;
  return nullptr;
}
const ElementKind& kind_of_family(Family family) {
  for (const ElementKind& k : element_kinds)
    if (k.family == family) return k;
  return element_kinds[0];
}

// true for *SET_*_ADD and *SET_*_GENERAL, which may refer to other sets
bool refers(std::string_view keyword) {
  return keyword.ends_with("_ADD") || keyword.ends_with("_GENERAL");
}

// Position of a value among the given cells of a row: e1.. of a general row, from column 1.
std::vector<std::int64_t> row_values(const Card& card, int row) {
  std::vector<std::int64_t> values;
  for (int c = 1; c < card.columns(); ++c)
    if (card.row(row, c) != 0) values.push_back(to_id(card.row(row, c)));
  return values;
}

}  // namespace

// Sets of other sets come after plain sets; within both groups deck order holds.
void Resolver::resolve_sets() {
  for (const bool second : {false, true})
    for (const auto& owned : model_.cards) {
      const Card& card = *owned;
      if (!card.schema || !card.schema->name.starts_with("SET_")) continue;
      const std::string_view name = card.schema->name;
      if (name.starts_with("SET_PART") && refers(name) == second) read_part_set(card);
    }
  for (const bool second : {false, true})
    for (const auto& owned : model_.cards) {
      const Card& card = *owned;
      if (!card.schema || !card.schema->name.starts_with("SET_")) continue;
      const std::string_view name = card.schema->name;
      if (kind_of_keyword(name) && refers(name) == second) read_element_set(card);
    }
  for (const bool second : {false, true})
    for (const auto& owned : model_.cards) {
      const Card& card = *owned;
      if (!card.schema || !card.schema->name.starts_with("SET_SEGMENT")) continue;
      if (refers(card.schema->name) == second) read_segment_set(card);
    }
  for (const bool second : {false, true})
    for (const auto& owned : model_.cards) {
      const Card& card = *owned;
      if (!card.schema || !card.schema->name.starts_with("SET_NODE")) continue;
      if (refers(card.schema->name) == second) read_node_set(card);
    }
}

// ids of `all` that lie in the ranges of a *_GENERATE card, in ascending order per range
std::vector<std::int64_t> Resolver::generated_ids(const Card& card,
                                                  const std::vector<std::int64_t>& all) const {
  std::vector<std::int64_t> sorted = all, ids;
  std::sort(sorted.begin(), sorted.end());
  for (int r = 0; r < card.row_count(); ++r)
    for (int c = 0; c + 1 < card.columns(); c += 2) {
      const auto low = to_id(card.row(r, c)), high = to_id(card.row(r, c + 1));
      if (low == 0) continue;
      const auto from = std::lower_bound(sorted.begin(), sorted.end(), low);
      const auto to = std::upper_bound(from, sorted.end(), std::max(low, high));
      ids.insert(ids.end(), from, to);
    }
  return ids;
}

void Resolver::read_part_set(const Card& card) {
  Marks marks(model_.parts.size());
  const std::string_view name = card.schema->name;
  if (name.ends_with("_ADD")) {
    for (std::int64_t id : card.row_ids())
      if (const int s = reference("part_set", id); s >= 0)
        for (int p : model_.part_sets[s].parts) marks.add(p);
  } else if (name.ends_with("_GENERATE")) {
    std::vector<std::int64_t> all;
    for (const Part& p : model_.parts) all.push_back(p.id);
    for (std::int64_t id : generated_ids(card, all)) marks.add(part(id));
  } else {
    for (std::int64_t id : card.row_ids()) {
      if (part(id) < 0)
        warning(card, "sid", "missing-part",
                "set " + std::to_string(card.id("sid")) + " names part " + std::to_string(id) +
                    ", which does not exist",
                "Define the part, or take it out of the set");
      marks.add(part(id));
    }
  }
  PartSet set{card.id("sid"), card.title, marks.members()};
  if (define("part_set", set.id, int(model_.part_sets.size()), card, "sid"))
    model_.part_sets.push_back(std::move(set));
}

void Resolver::read_element_set(const Card& card) {
  const std::string_view name = card.schema->name;
  const ElementKind& kind = *kind_of_keyword(name);
  const std::vector<std::int64_t>* ids[5] = {nullptr, &model_.solids.id, &model_.shells.id,
                                             &model_.beams.id, &model_.discretes.id};
  const IdTable& elements = table(kind.kind);
  Marks marks(std::size_t(element_count(kind.family)));
  if (name.ends_with("_ADD")) {
    for (std::int64_t id : card.row_ids())
      if (const int s = reference(kind.set, id); s >= 0)
        for (int e : model_.element_sets[s].elements) marks.add(e);
  } else if (name.ends_with("_GENERAL")) {
    general_elements(card, kind.family, marks);
  } else if (name.ends_with("_GENERATE")) {
    for (std::int64_t id : generated_ids(card, *ids[int(kind.family)]))
      marks.add(elements.find(id));
  } else {
    for (std::int64_t id : card.row_ids()) {
      if (elements.find(id) < 0)
        warning(card, "sid", "missing-element",
                "set " + std::to_string(card.id("sid")) + " names element " + std::to_string(id) +
                    ", which does not exist",
                "Define the element, or take it out of the set");
      marks.add(elements.find(id));
    }
  }
  ElementSet set{card.id("sid"), kind.family, card.title, marks.members()};
  if (define(kind.set, set.id, int(model_.element_sets.size()), card, "sid"))
    model_.element_sets.push_back(std::move(set));
}

// Rows ALL, ELEM, PART, BOX, SET_<kind> and their D forms, which take members out.
bool Resolver::general_elements(const Card& card, Family family, Marks& marks) {
  const ElementKind& kind = kind_of_family(family);
  for (int r = 0; r < card.row_count(); ++r) {
    std::string_view option = card.row_text(r, 0);
    const bool out = option.starts_with("D") && !option.starts_with("DISC");
    if (out) option.remove_prefix(1);
    std::vector<int> list;
    const auto values = row_values(card, r);
    if (option == "ALL") {
      for (int e = 0; e < element_count(family); ++e) list.push_back(e);
    } else if (option == "ELEM") {
      for (std::int64_t id : values) list.push_back(table(kind.kind).find(id));
    } else if (option == "PART") {
      for (std::int64_t id : values)
        if (const int p = part(id); p >= 0)
          for (int e : elements_of_part(family, p)) list.push_back(e);
    } else if (option == "BOX") {
      std::vector<int> nodes;
      for (std::int64_t id : values)
        if (const int b = reference("box", id); b >= 0)
          for (int e = 0; e < element_count(family); ++e) {
            nodes.clear();
            element_nodes(family, e, nodes);
            if (std::all_of(nodes.begin(), nodes.end(),
                            [&](int n) { return in_box(model_.boxes[b], n); }))
              list.push_back(e);
          }
    } else if (option.starts_with("SET")) {
      for (std::int64_t id : values)
        if (const int s = reference(kind.set, id); s >= 0)
          list.insert(list.end(), model_.element_sets[s].elements.begin(),
                      model_.element_sets[s].elements.end());
    } else {
      unsupported(card, "sid", "unsupported-set-option",
                  "the row option " + std::string(card.row_text(r, 0)) + " is not known",
                  "Use ALL, ELEM, PART, BOX or a set");
      return false;
    }
    for (int e : list) out ? marks.remove(e) : marks.add(e);
  }
  return true;
}

void Resolver::read_node_set(const Card& card) {
  Marks marks(model_.nodes.id.size());
  const std::string_view name = card.schema->name;
  if (name.ends_with("_ADD")) {
    for (std::int64_t id : card.row_ids())
      if (const int s = reference("node_set", id); s >= 0)
        for (int n : model_.node_sets[s].nodes) marks.add(n);
  } else if (name.ends_with("_GENERAL")) {
    general_nodes(card, marks);
  } else if (name.ends_with("_GENERATE")) {
    for (std::int64_t id : generated_ids(card, model_.nodes.id)) marks.add(nodes_.find(id));
  } else {
    for (std::int64_t id : card.row_ids()) {
      if (nodes_.find(id) < 0)
        error(card, "sid", "missing-node",
              "set " + std::to_string(card.id("sid")) + " names node " + std::to_string(id) +
                  ", which does not exist",
              "Define the node, or take it out of the set");
      marks.add(nodes_.find(id));
    }
  }
  NodeSet set{card.id("sid"), card.title, marks.members()};
  if (define("node_set", set.id, int(model_.node_sets.size()), card, "sid"))
    model_.node_sets.push_back(std::move(set));
}

// Rows ALL, NODE, PART, BOX, SET_* and their D forms.
bool Resolver::general_nodes(const Card& card, Marks& marks) {
  for (int r = 0; r < card.row_count(); ++r) {
    std::string_view option = card.row_text(r, 0);
    const bool out = option.starts_with("D") && !option.starts_with("DISC");
    if (out) option.remove_prefix(1);
    std::vector<int> list;
    const auto append = [&](const std::vector<int>& more) {
      list.insert(list.end(), more.begin(), more.end());
    };
    for (std::int64_t id : option == "ALL" ? std::vector<std::int64_t>{1} : row_values(card, r)) {
      if (option == "ALL") {
        append(set_or_all(0));
      } else if (option == "NODE") {
        list.push_back(node(id));
      } else if (option == "PART") {
        if (const int p = part(id); p >= 0) append(nodes_of_part(p));
      } else if (option == "BOX") {
        if (const int b = reference("box", id); b >= 0)
          for (int n = 0; n < model_.nodes.size(); ++n)
            if (in_box(model_.boxes[b], n)) list.push_back(n);
      } else if (option == "SET_PART") {
        if (const int s = reference("part_set", id); s >= 0)
          append(nodes_of_parts(model_.part_sets[s].parts));
      } else if (option == "SET_NODE" || option == "SET") {
        if (const int s = reference("node_set", id); s >= 0) append(model_.node_sets[s].nodes);
      } else if (option == "SET_SEGM" || option == "SET_SEGMENT" || option == "SEG") {
        if (const int s = reference("segment_set", id); s >= 0)
          for (const auto& segment : model_.segment_sets[s].segments)
            for (int n : segment) list.push_back(n);
      } else if (const ElementKind* k =
                     option.starts_with("SET_") ? kind_of_keyword(option) : nullptr) {
        if (const int s = reference(k->set, id); s >= 0)
          append(nodes_of_elements(k->family, model_.element_sets[s].elements));
      } else {
        unsupported(card, "sid", "unsupported-set-option",
                    "the row option " + std::string(card.row_text(r, 0)) + " is not known",
                    "Use ALL, NODE, PART, BOX or a set");
        return false;
      }
    }
    for (int n : list) out ? marks.remove(n) : marks.add(n);
  }
  return true;
}

std::vector<int> Resolver::set_or_all(std::int64_t id) const {
  if (id != 0) {
    const int s = reference("node_set", id);
    return s >= 0 ? model_.node_sets[s].nodes : std::vector<int>{};
  }
  std::vector<int> all(model_.nodes.id.size());
  for (int n = 0; n < int(all.size()); ++n) all[n] = n;
  return all;
}

std::vector<int> Resolver::selected_nodes(std::int64_t set, std::int64_t excluded,
                                          std::int64_t box) const {
  std::vector<int> nodes = set_or_all(set);
  if (const int s = reference("node_set", excluded); s >= 0) {
    std::vector<std::uint8_t> out(model_.nodes.id.size(), 0);
    for (int n : model_.node_sets[s].nodes) out[n] = 1;
    std::erase_if(nodes, [&](int n) { return out[n] != 0; });
  }
  if (const int b = reference("box", box); b >= 0)
    std::erase_if(nodes, [&](int n) { return !in_box(model_.boxes[b], n); });
  return nodes;
}

}  // namespace fabrica
