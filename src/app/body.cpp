#include "app/body.h"

#include <fmt/core.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>

#include "app/body_draws.h"
#include "app/body_pictures.h"
#include "body/assembly.h"
#include "body/body.h"
#include "body/goals.h"
#include "body/joint_gaps.h"
#include "body/landmarks.h"
#include "body/measures.h"
#include "body/mount.h"
#include "body/rig.h"
#include "body/surroundings.h"
#include "deck/writer.h"
#include "model/check.h"
#include "solver/simulation.h"

namespace fabrica {
namespace {

using body::BodyError;

// a line that is written over belongs on a terminal, not in a file
bool shows_progress(const BodyCommand& c) { return !c.quiet && ::isatty(STDERR_FILENO) == 1; }

body::BodyOptions options_of(const BodyCommand& c) {
  if (c.only != "skeleton")
    throw BodyError(fmt::format(
        "--only {}: the body is made of its skeleton so far; the only choice is skeleton", c.only));
  body::BodyOptions options;
  if (c.draw > 0) {
    options = drawn_body(c.draw);
  } else {
    options.subject = body::make_subject(c.sex, c.stature, c.mass);
    options.posture = body::named_posture(c.posture);
  }
  for (const std::string& assignment : c.set) body::set_angle(options.posture, assignment);
  if (!c.goals.empty()) body::solve(options.posture, options.subject, body::read_goals(c.goals));
  options.resolution = body::resolution_named(c.resolution);
  options.joints = !c.no_joints;
  options.only = c.bones;
  if (shows_progress(c))
    options.progress = [](const std::string& bone) { fmt::print(stderr, "\r{:<24}", bone); };
  return options;
}

void write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream out(path);
  out << text;
  out.close();
  if (!out) throw BodyError(fmt::format("cannot write {}", path.string()));
}

// penetrations and ties at the start, from the solver's first search
body::OutsideMeasures search_contacts(const Model& model, double seconds,
                                      Diagnostics& diagnostics) {
  body::OutsideMeasures outside;
  outside.seconds = seconds;
  if (model.contacts.empty()) return outside;
  Simulation simulation(model, {}, diagnostics);
  if (diagnostics.has_errors()) return outside;
  simulation.step();
  const InitialReport& r = simulation.contacts().initial_report();
  outside.searched = true;
  outside.penetrating_nodes = r.penetrating_nodes,
  outside.largest_penetration = r.largest_penetration;
  outside.untied_nodes = int(r.untied_nodes.size());
  std::map<std::string, double> depth;  // of the contacts of the worst nodes
  for (const InitialPenetration& p : r.worst) {
    double& deepest = depth[model.contacts[std::size_t(p.contact)].title];
    deepest = std::max(deepest, p.depth);
  }
  for (const auto& [title, deepest] : depth)
    outside.penetrations += fmt::format("; {} {:.2f}", title, deepest);
  return outside;
}

bool fracture_named(const std::string& name) {
  if (name == "count" || name == "delete") return name == "delete";
  throw BodyError(fmt::format("--fracture '{}' is unknown; there are count, delete", name));
}

// The body in its trial: one of the three by name, or a rig from a file.
struct Trial {
  explicit Trial(const BodyCommand& c) : name(c.trial), fracture(fracture_named(c.fracture)) {
    if (name.ends_with(".toml")) rig = body::read_rig(name);
  }
  body::Body build(body::BodyOptions options) const {
    if (rig) options.only = rig->bones(), options.joints = rig->joined();
    body::Body made = body::build_body(options);
    if (rig) body::place_specimens(*rig, made);
    return made;
  }
  body::AssemblyOptions assembly() const {
    body::AssemblyOptions options;
    options.end_time = rig ? rig->end_time : body::trial_time(name);
    options.fracture = fracture;
    if (!rig && name != "none") options.states_every = options.end_time / 50;  // for its joints
    if (rig) options.output_every = rig->output_every, options.states_every = rig->states_every;
    return options;
  }
  void surround(const body::Body& made, body::AssembledBody& assembled, Builder& builder) const {
    if (!rig) return body::surround(name, made, assembled, builder);
    for (const body::MountedPart& part : body::mount(*rig, made, assembled, builder))
      fmt::print("rig part {}: {}, pivot at {:.2f} {:.2f} {:.2f} mm\n", part.id, part.name,
                 part.pivot.x, part.pivot.y, part.pivot.z);
  }

  std::string name;
  bool fracture;
  std::optional<body::Rig> rig;
};

}  // namespace

int body_command(const BodyCommand& c) {
  if (c.list) {
    for (const std::string& name : body::bone_names()) fmt::print("{}\n", name);
    return 0;
  }
  if (c.random > 0) return draw_bodies(c.random, c.resolution, !c.no_joints, c.bones);
  const std::clock_t start = std::clock();
  const Trial trial(c);
  const body::Body made = trial.build(options_of(c));
  Diagnostics diagnostics;
  Builder builder(diagnostics);
  body::AssembledBody assembled = body::assemble(made, trial.assembly(), builder);
  trial.surround(made, assembled, builder);
  const std::unique_ptr<Model> model = builder.finish();
  const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
  if (shows_progress(c)) fmt::print(stderr, "\r{:<24}\r", "");
  for (const Diagnostic& d : diagnostics.list()) fmt::print(stderr, "{}\n", diagnostics.format(d));
  if (diagnostics.has_errors()) return 1;
  const std::filesystem::path deck = c.out, folder = deck.parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder);
  // closed before the rest, so that a run may start, or the pictures fail, beside a whole deck
  std::ofstream out(deck);
  write_deck(*model, out);
  out.close();
  if (!out) throw BodyError(fmt::format("cannot write {}", deck.string()));
  write_file(folder / (deck.stem().string() + "_landmarks.csv"),
             body::landmarks_csv(made.skeleton));
  if (const auto rows = body::joint_rows(made, assembled); !rows.empty())
    write_file(folder / (deck.stem().string() + "_joints.csv"), body::joints_csv(rows));
  const CheckReport check = check_model(*model, diagnostics);
  const body::OutsideMeasures outside = search_contacts(*model, seconds, diagnostics);
  write_file(folder / (deck.stem().string() + "_measures.md"),
             body::measures_text(made, assembled, *model, check, outside));
  if (c.pictures) draw_body(made, (folder / (deck.stem().string() + "_pictures")).string());
  fmt::print("{}: {} bones, {} parts, {} nodes, {} solids, {} shells in {:.1f} s of one core\n",
             c.out, made.bones.size(), assembled.parts.size(), model->nodes.size(),
             model->solids.size(), model->shells.size(), seconds);
  return 0;
}

void add_body(CLI::App& app, BodyCommand& c) {
  auto* cmd = app.add_subcommand("body", "Make a human body in a posture as a keyword deck");
  cmd->add_option("--sex", c.sex, "male")->capture_default_str();
  cmd->add_option("--stature", c.stature, "body height [mm]")->capture_default_str();
  cmd->add_option("--mass", c.mass, "body mass [kg]")->capture_default_str();
  cmd->add_option("--posture", c.posture, "standing, driver, passenger or supine")
      ->capture_default_str();
  cmd->add_option("--set", c.set,
                  "joint angle [degrees], such as knee.right=110 or lumbar.flexion=20");
  cmd->add_option("--goals", c.goals,
                  "file of goals: H-point, torso angle, head level, hands, feet")
      ->check(CLI::ExistingFile);
  cmd->add_option("--resolution", c.resolution, "coarse, standard or fine")->capture_default_str();
  cmd->add_option("--only", c.only, "what to make: skeleton")->capture_default_str();
  cmd->add_option("--bones", c.bones,
                  "only these bones, as --list names them; right.femur, left.femur one of a pair")
      ->delimiter(',');
  cmd->add_option("--trial", c.trial,
                  "what surrounds it: none, seat, drop, sternum, or FILE.toml, a rig for bones")
      ->capture_default_str();
  cmd->add_option("--fracture", c.fracture,
                  "bone above its strain at fracture: count (after the run) or delete (in it)")
      ->capture_default_str();
  cmd->add_option("--out", c.out, "deck to write; landmarks stand beside it")
      ->capture_default_str();
  cmd->add_flag("--pictures", c.pictures, "also draw it, whole and region by region");
  cmd->add_flag("--no-joints", c.no_joints, "bones alone, without what joins them");
  cmd->add_option("--random", c.random,
                  "make so many bodies of random posture and size, report each, write nothing");
  cmd->add_option("--draw", c.draw,
                  "make the one of them with this number, counted from 1, in place of --sex, "
                  "--stature, --mass and --posture")
      ->check(CLI::PositiveNumber);
  cmd->add_flag("--list", c.list, "list the bones");
  cmd->add_flag("--quiet", c.quiet, "no progress (none is shown where stderr is no terminal)");
  cmd->callback([&c] { throw CLI::RuntimeError(body_command(c)); });
}

}  // namespace fabrica
