// The order of resolution, references between entities, and how problems are reported.
#include "model/resolve.h"

#include <cmath>

namespace fabrica {
namespace {

// reports of one kind before the rest is only counted
constexpr int report_limit = 20;

// name of the diagnostic for a missing entity of a kind
std::string missing_name(std::string_view kind) {
  if (kind.ends_with("_set")) return "missing-set";
  std::string name = "missing-" + std::string(kind);
  for (char& c : name)
    if (c == '_') c = '-';
  return name;
}

std::string words(std::string_view kind) {
  std::string text(kind);
  for (char& c : text)
    if (c == '_') c = ' ';
  return text;
}

}  // namespace

Resolver::Resolver(Builder& builder)
    : builder_(builder), model_(*builder.model_), diagnostics_(builder.diagnostics_) {
  for (const char* kind : {"part",
                           "section",
                           "material",
                           "curve",
                           "table",
                           "eos",
                           "hourglass",
                           "node_set",
                           "part_set",
                           "segment_set",
                           "shell_set",
                           "solid_set",
                           "beam_set",
                           "discrete_set",
                           "box",
                           "coordinate_system",
                           "sd_orientation",
                           "transformation",
                           "vector",
                           "function",
                           "sensor",
                           "contact",
                           "solid",
                           "shell",
                           "beam",
                           "discrete"})
    tables_[kind].reset(0);
  for (int i = 0; i < int(model_.cards.size()); ++i) card_index_[model_.cards[i].get()] = i;
  for (const Diagnostic& d : diagnostics_.list()) files_missing_ |= d.name == "missing-file";
}

void Resolver::run() {
  using R = Resolver;
  resolve_nodes();

  // what the rest refers to
  read_all({{"DEFINE_CURVE", &R::read_curve},
            {"DEFINE_CURVE_SMOOTH", &R::read_smooth_curve},
            {"DEFINE_CURVE_FUNCTION", &R::read_curve_function},
            {"DEFINE_FUNCTION", &R::read_function},
            {"DEFINE_FUNCTION_TABULATED", &R::read_function},
            {"DEFINE_BOX", &R::read_box},
            {"DEFINE_TRANSFORMATION", &R::read_transformation},
            {"DEFINE_COORDINATE_SYSTEM", &R::read_coordinate_system},
            {"DEFINE_COORDINATE_NODES", &R::read_coordinate_nodes},
            {"DEFINE_COORDINATE_VECTOR", &R::read_coordinate_vector},
            {"DEFINE_SD_ORIENTATION", &R::read_sd_orientation}});
  read_all({{"DEFINE_TABLE", &R::read_table},
            {"DEFINE_TABLE_2D", &R::read_table},
            {"DEFINE_VECTOR", &R::read_vector}});
  resolve_functions();
  finish_curves();
  finish_tables();
  read_all({{"CONTROL_*", &R::read_control}});

  // parts and mesh
  read_all({{"SECTION_*", &R::read_section},
            {"MAT_*", &R::read_material},
            {"EOS_*", &R::read_eos},
            {"HOURGLASS", &R::read_hourglass}});
  read_all({{"PART", &R::read_part}, {"PART_AVERAGED", &R::read_part}});
  resolve_elements();
  index_parts();
  resolve_sets();
  move_nodes();
  read_all({{"CONTROL_TIMESTEP", &R::read_selective_mass},
            {"DEFORMABLE_TO_RIGID", &R::read_deformable_to_rigid}});
  check_parts();

  // what acts on the mesh
  read_all({{"CONTACT_*", &R::read_contact},
            {"RIGIDWALL_*", &R::read_wall},
            {"CONSTRAINED_RIGID_BODIES", &R::read_rigid_bodies},
            {"CONSTRAINED_EXTRA_NODES_*", &R::read_extra_nodes},
            {"CONSTRAINED_NODAL_RIGID_BODY", &R::read_nodal_rigid_body},
            {"CONSTRAINED_SPOTWELD", &R::read_spotweld},
            {"CONSTRAINED_GENERALIZED_WELD_SPOT", &R::read_generalized_spot},
            {"CONSTRAINED_JOINT_*", &R::read_joint},
            {"BOUNDARY_SPC_*", &R::read_spc},
            {"BOUNDARY_PRESCRIBED_MOTION_*", &R::read_prescribed_motion},
            {"INITIAL_VELOCITY", &R::read_initial_velocity},
            {"INITIAL_VELOCITY_NODE", &R::read_initial_node},
            {"INITIAL_VELOCITY_GENERATION", &R::read_initial_generation},
            {"INITIAL_VELOCITY_RIGID_BODY", &R::read_initial_rigid},
            {"LOAD_BODY_PARTS", &R::read_body_parts}});
  read_all({{"LOAD_BODY_X", &R::read_body_load},
            {"LOAD_BODY_Y", &R::read_body_load},
            {"LOAD_BODY_Z", &R::read_body_load},
            {"LOAD_NODE_*", &R::read_node_load},
            {"LOAD_RIGID_BODY", &R::read_node_load},
            {"LOAD_SEGMENT", &R::read_segment_load},
            {"LOAD_SEGMENT_SET", &R::read_segment_load},
            {"LOAD_SHELL_*", &R::read_shell_load},
            {"DAMPING_GLOBAL", &R::read_global_damping},
            {"DAMPING_PART_*", &R::read_part_damping},
            {"DATABASE_*", &R::read_database}});

  // the whole
  check_references();
  check_mesh();
  check_mass();
  check_rigid_nodes();
  check_joints();
  check_termination();
  report_rest();
}

void Resolver::read_all(const std::vector<Handler>& handlers) {
  for (std::size_t i = 0; i < model_.cards.size(); ++i) {
    const Card& card = *model_.cards[i];
    if (!card.schema) continue;
    const std::string_view name = card.schema->name;
    for (const Handler& h : handlers) {
      const bool prefix = h.keyword.back() == '*';
      const auto stem = h.keyword.substr(0, h.keyword.size() - (prefix ? 1 : 0));
      if (prefix ? name.starts_with(stem) : name == stem) {
        (this->*h.read)(card);
        break;
      }
    }
  }
}

bool Resolver::may_report(const std::string& name, Severity severity) {
  const int n = ++reports_[{name, severity}];
  return n <= report_limit && !(files_missing_ && name.starts_with("missing-"));
}

void Resolver::report_rest() {
  for (const auto& [kind, n] : reports_) {
    const auto& [name, severity] = kind;
    if (files_missing_ && name.starts_with("missing-"))
      diagnostics_.add({Severity::note,
                        name,
                        {},
                        "",
                        "",
                        std::to_string(n) + " references lead nowhere while files are missing",
                        "Supply the files, then check again"});
    else if (n > report_limit)
      diagnostics_.add({severity,
                        name,
                        {},
                        "",
                        "",
                        std::to_string(n - report_limit) + " more of the same kind are not listed",
                        "Correct the first ones",
                        n - report_limit});
  }
}

void Resolver::error(const Card& card, std::string_view field, std::string name,
                     std::string message, std::string remedy) {
  if (!may_report(name)) return;
  const Location where =
      field.empty() || !card.has_field(field) ? card.where : card.where_of(field);
  diagnostics_.error(std::move(name), where, card.schema->name, std::string(field),
                     std::move(message), std::move(remedy));
}

void Resolver::warning(const Card& card, std::string_view field, std::string name,
                       std::string message, std::string remedy) {
  if (!may_report(name, Severity::warning)) return;
  const Location where =
      field.empty() || !card.has_field(field) ? card.where : card.where_of(field);
  diagnostics_.warning(std::move(name), where, card.schema->name, std::string(field),
                       std::move(message), std::move(remedy));
}

void Resolver::unsupported(const Card& card, std::string_view field, std::string name,
                           std::string message, std::string remedy) {
  if (!may_report(name, Severity::unsupported)) return;
  const Location where =
      field.empty() || !card.has_field(field) ? card.where : card.where_of(field);
  diagnostics_.add({Severity::unsupported, std::move(name), where, card.schema->name,
                    std::string(field), std::move(message), std::move(remedy)});
}

const IdTable& Resolver::table(std::string_view kind) const { return tables_.find(kind)->second; }
IdTable& Resolver::table(std::string_view kind) { return tables_.find(kind)->second; }

int Resolver::reference(std::string_view kind, std::int64_t id) const {
  if (id == 0) return -1;
  if (kind == "node") return nodes_.find(id);
  const auto it = tables_.find(kind);
  return it == tables_.end() ? -1 : it->second.find(id);
}

int Resolver::curve(const Card& card, std::string_view field) const {
  return reference("curve", card.id(field));
}

bool Resolver::define(std::string_view kind, std::int64_t id, int index, const Card& card,
                      std::string_view field) {
  if (table(kind).insert(id, index) < 0) return true;
  error(card, field, "duplicate-id", words(kind) + " " + std::to_string(id) + " is defined twice",
        "Give one of the two another id");
  return false;
}

// Every field that names an entity must name one that exists.
void Resolver::check_references() {
  for (const auto& owned : model_.cards) {
    const Card& card = *owned;
    if (!card.schema || card.schema->support != Support::full) continue;
    std::size_t k = 0;
    for (const CardSchema& group : card.schema->cards) {
      if (group.repeats) {
        for (int column = 0; column < int(group.fields.size()); ++column) {
          const FieldSchema& field = group.fields[column];
          if (field.reference.empty() || column >= card.columns()) continue;
          for (int i = 0; i < card.row_count(); ++i)
            check_reference(card, field, card.row(i, column), card.where_of_row(i));
        }
        continue;
      }
      for (const FieldSchema& field : group.fields) {
        if (!field.reference.empty() && k < card.values.size())
          check_reference(card, field, card.values[k], card.where_of(field.name));
        ++k;
      }
    }
  }
}

void Resolver::check_reference(const Card& card, const FieldSchema& field, double value,
                               Location where) {
  const auto id = to_id(std::abs(value));
  if (id == 0 || field.type != FieldType::integer || field.support == Support::ignored) return;
  const std::string& kind = field.reference;
  bool found = reference(kind, id) >= 0;
  // a table or a function may stand where a curve may
  if (!found && kind == "curve")
    found = reference("table", id) >= 0 || reference("function", id) >= 0;
  if (found || (kind != "node" && !tables_.contains(kind))) return;
  const std::string name = missing_name(kind);
  if (!may_report(name)) return;
  diagnostics_.error(name, where, card.schema->name, field.name,
                     "there is no " + words(kind) + " " + std::to_string(id),
                     "Define it, or correct the id");
}

}  // namespace fabrica
