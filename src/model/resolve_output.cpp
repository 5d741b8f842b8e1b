// Control cards and output requests.
#include <algorithm>

#include "model/resolve.h"

namespace fabrica {

void Resolver::read_control(const Card& card) {
  Controls& c = model_.controls;
  const std::string_view name = card.schema->name;
  if (name == "CONTROL_TERMINATION") {
    c.end_time = card.real("endtim");
    c.end_cycle = card.integer("endcyc");
    c.minimum_time_step_factor = card.real("dtmin");
    check_erosion(card);
  } else if (name == "CONTROL_TIMESTEP") {
    read_timestep(card);
  } else if (name == "CONTROL_HOURGLASS") {
    c.hourglass.type = card.integer("ihq");
    c.hourglass.coefficient = nonzero(card, "qh", 0.1);
    c.hourglass.bending = c.hourglass.warping = c.hourglass.coefficient;
  } else if (name == "CONTROL_BULK_VISCOSITY") {
    c.hourglass.quadratic_viscosity = nonzero(card, "q1", 1.5);
    c.hourglass.linear_viscosity = nonzero(card, "q2", 0.06);
    c.shell_viscosity = std::max(0, -card.integer("type"));
  } else if (name == "CONTROL_SHELL") {
    c.shell_update = card.integer("istupd");
    c.shell_warping = to_int(nonzero(card, "bwc", 2));
    c.shell_projection = card.integer("proj");
    c.shell_theory = to_int(nonzero(card, "theory", 2));
  } else if (name == "CONTROL_CONTACT") {
    read_control_contact(card);
  } else if (name == "CONTROL_ACCURACY") {
    c.objective_update = card.integer("osu");
    c.node_numbering = to_int(nonzero(card, "inn", 1));
  }
}

void Resolver::read_timestep(const Card& card) {
  Controls& c = model_.controls;
  c.initial_time_step = card.real("dtinit");
  c.time_step_scale = nonzero(card, "tssfac", 0.9);
  c.shell_time_step = card.integer("isdo");
  c.mass_scaling_time_step = card.real("dt2ms");
  c.mass_scaling_first_cycle_only = card.integer("ms1st") == 1;
  c.time_step_curve = curve(card, "lctm");
  c.erode = card.integer("erode") != 0;
  check_erosion(card);
}

// DTMIN stops the run where ERODE asks for the element to go; which card comes second reports it
void Resolver::check_erosion(const Card& card) {
  const Controls& c = model_.controls;
  if (c.erode && c.minimum_time_step_factor > 0)
    unsupported(card, "", "unsupported-erosion",
                "elements below DTMIN are not removed (ERODE = 1); the run ends there",
                "Leave DTMIN at 0, so that the run goes on, or accept that it ends");
}

// IMSCL = 1: all parts; negative: a part set, so that sets come first
void Resolver::read_selective_mass(const Card& card) {
  Controls& c = model_.controls;
  const int option = card.integer("imscl");
  if (option == 0) return;
  if (!(c.mass_scaling_time_step < 0))
    error(card, "imscl", "selective-mass-without-step",
          "selective mass scaling needs the step of mass scaling in DT2MS, as a negative number",
          "give DT2MS < 0, or leave IMSCL out");
  if (option > 0) {
    c.selective_mass_all = true;
    return;
  }
  if (const int set = reference("part_set", -std::int64_t(option)); set >= 0)
    c.selective_mass_parts = model_.part_sets[set].parts;
  else
    error(card, "imscl", "missing-set", "there is no part set " + std::to_string(-option),
          "define it with *SET_PART, or correct IMSCL");
}

void Resolver::read_control_contact(const Card& card) {
  Controls& c = model_.controls;
  c.contact_scale = nonzero(card, "slsfac", 0.1);
  c.rigid_wall_penalty = card.real("rwpnal");
  c.shell_thickness_option = card.integer("shlthk");
  c.penalty_option = to_int(nonzero(card, "penopt", 1));
  c.tied_projection = card.integer("tiedprj") == 0;
  c.contact_ignore = card.integer("ignore");
  c.contact_orientation = int(nonzero(card, "orien", 1));
}

// *DATABASE_GLSTAT and its like: the interval; sections and histories have readers of their own.
void Resolver::read_database(const Card& card) {
  const std::string_view name = card.schema->name;
  if (name.starts_with("DATABASE_HISTORY_")) return read_history(card);
  if (name == "DATABASE_CROSS_SECTION_SET") return read_cross_section_set(card);
  if (name == "DATABASE_CROSS_SECTION_PLANE") return read_cross_section_plane(card);
  if (name == "DATABASE_EXTENT_BINARY") return read_extent(card);
  if (card.schema->support != Support::full || !card.has_field("dt")) return;

  std::string key(name.substr(name.starts_with("DATABASE_BINARY_") ? 16 : 9));
  for (char& ch : key) ch = char(std::tolower(static_cast<unsigned char>(ch)));
  double interval = card.real("dt");
  if (key == "d3plot" && card.integer("npltc") > 0)
    interval = model_.controls.end_time / card.integer("npltc");
  const int by_curve = curve(card, key == "d3plot" ? "lcdt" : "lcur");
  if (interval > 0) model_.output.interval[key] = interval;
  if (by_curve >= 0) model_.output.interval_curve[key] = by_curve;
}

void Resolver::read_extent(const Card& card) {
  model_.output.write_strains = card.integer("strflg") % 10 != 0;
  model_.output.shell_layers = to_int(nonzero(card, "maxint", 3));
}

void Resolver::read_history(const Card& card) {
  if (card.schema->support != Support::full) return;
  OutputRequests& out = model_.output;
  const std::string_view name = std::string_view(card.schema->name).substr(17);
  const bool sets = name.ends_with("_SET");
  struct Kind {
    std::string_view word;
    const char *kind, *set;
    std::vector<int>* list;
  };
  const Kind kinds[] = {{"SHELL", "shell", "shell_set", &out.shells},
                        {"SOLID", "solid", "solid_set", &out.solids},
                        {"BEAM", "beam", "beam_set", &out.beams},
                        {"DISCRETE", "discrete", "discrete_set", &out.discretes}};
  const bool named = card.has_option("ID");
  const auto missing = [&](std::string_view what, std::int64_t id) {
    warning(card, "", "missing-history-entity",
            "there is no " + std::string(what) + " " + std::to_string(id),
            "Correct the id; nothing is written for it");
  };
  for (int r = 0; r < card.row_count(); ++r)
    for (int c = 0; c < (named ? 1 : card.columns()); ++c) {
      const auto id = to_id(card.row(r, c));
      if (id == 0) continue;
      if (name.starts_with("NODE")) {
        const auto add = [&](int n) {
          if (std::find(out.nodes.begin(), out.nodes.end(), n) != out.nodes.end()) return;
          out.nodes.push_back(n);
          out.node_names.emplace_back(named ? card.row_text(r, 1) : std::string_view{});
        };
        const int found = reference(sets ? "node_set" : "node", id);
        if (found < 0)
          missing(sets ? "node set" : "node", id);
        else if (sets)
          for (int n : model_.node_sets[found].nodes) add(n);
        else
          add(found);
        continue;
      }
      for (const Kind& k : kinds) {
        if (!name.starts_with(k.word)) continue;
        const int found = reference(sets ? k.set : k.kind, id);
        if (found < 0)
          missing(sets ? k.set : k.kind, id);
        else if (sets)
          k.list->insert(k.list->end(), model_.element_sets[found].elements.begin(),
                         model_.element_sets[found].elements.end());
        else
          k.list->push_back(found);
      }
    }
}

void Resolver::read_cross_section_set(const Card& card) {
  CrossSection s;
  s.id = card.has_option("ID") ? card.id("csid") : 0;
  if (s.id == 0) s.id = std::int64_t(model_.cross_sections.size()) + 1;
  s.title = card.has_option("ID") ? std::string(card.text("heading")) : card.title;
  s.nodes = set_or_all(card.id("nsid"));
  const auto take = [&](const char* field, const char* kind, std::vector<int>& list) {
    if (const int i = reference(kind, card.id(field)); i >= 0)
      list = model_.element_sets[i].elements;
  };
  take("hsid", "solid_set", s.solids);
  take("ssid", "shell_set", s.shells);
  take("bsid", "beam_set", s.beams);
  take("dsid", "discrete_set", s.discretes);
  if (card.integer("itype") == 2) s.local_system = reference("coordinate_system", card.id("id"));
  model_.cross_sections.push_back(std::move(s));
}

void Resolver::read_cross_section_plane(const Card& card) {
  CrossSection s;
  s.id = card.has_option("ID") ? card.id("csid") : 0;
  if (s.id == 0) s.id = std::int64_t(model_.cross_sections.size()) + 1;
  s.title = card.has_option("ID") ? std::string(card.text("heading")) : card.title;
  if (card.integer("itype") == 2) s.local_system = reference("coordinate_system", card.id("id"));
  read_plane_elements(card, s);
  model_.cross_sections.push_back(std::move(s));
}

// Elements with nodes on both sides of the plane, inside its bounds; nodes of these behind the
// plane. Bounds: a circle of radius R about the tail, or a rectangle along the edge vector and the
// direction normal to it; none where neither is given.
void Resolver::read_plane_elements(const Card& card, CrossSection& section) {
  const Vec3d tail{card.real("xct"), card.real("yct"), card.real("zct")};
  const Vec3d head{card.real("xch"), card.real("ych"), card.real("zch")};
  const Vec3d edge_head{card.real("xhev"), card.real("yhev"), card.real("zhev")};
  const double length = norm(head - tail);
  if (!(length > 0)) {
    error(card, "xch", "degenerate-cross-section", "the normal of the plane has no length",
          "Give a head that differs from the tail");
    return;
  }
  const Vec3d normal = (1 / length) * (head - tail);
  const double l = card.real("lenl"), m = card.real("lenm"), radius = card.real("radius");
  Vec3d el{0, 0, 0}, em{0, 0, 0};
  if (const Vec3d edge = edge_head - tail; norm(edge) > 0) {
    const Vec3d in_plane = edge - dot(edge, normal) * normal;
    if (norm(in_plane) > 0) el = (1 / norm(in_plane)) * in_plane, em = cross(normal, el);
  }
  std::vector<int> parts;
  const int set = reference("part_set", card.id("psid"));
  if (set >= 0) parts = model_.part_sets[set].parts;
  if (set < 0)
    for (int p = 0; p < int(model_.parts.size()); ++p) parts.push_back(p);

  std::vector<int> nodes;
  std::vector<std::uint8_t> behind(model_.nodes.id.size(), 0);
  std::vector<int>* lists[5] = {nullptr, &section.solids, &section.shells, &section.beams,
                                &section.discretes};
  for (int p : parts)
    for (int f = 1; f < 5; ++f)
      for (int e : elements_of_part(Family(f), p)) {
        nodes.clear();
        element_nodes(Family(f), e, nodes);
        if (nodes.empty()) continue;
        double low = 1e300, high = -1e300;
        Vec3d centre{0, 0, 0};
        for (int n : nodes) {
          const double d = dot(model_.nodes.x[n] - tail, normal);
          low = std::min(low, d), high = std::max(high, d);
          centre += (1.0 / double(nodes.size())) * model_.nodes.x[n];
        }
        if (!(low < 0 && high >= 0)) continue;
        const Vec3d r = centre - tail;
        const double a = dot(r, el), b = dot(r, em);
        if (radius > 0 && norm(r - dot(r, normal) * normal) > radius) continue;
        if (radius == 0 && ((l > 0 && (a < 0 || a > l)) || (m > 0 && (b < 0 || b > m)))) continue;
        lists[f]->push_back(e);
        for (int n : nodes)
          if (dot(model_.nodes.x[n] - tail, normal) < 0) behind[n] = 1;
      }
  for (int n = 0; n < int(behind.size()); ++n)
    if (behind[n]) section.nodes.push_back(n);
}

}  // namespace fabrica
