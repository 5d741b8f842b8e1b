#include "model/check.h"

#include <fmt/core.h>

#include <fstream>

#include "app/run.h"
#include "deck/reader.h"
#include "deck/writer.h"
#include "solver/simulation.h"

namespace fabrica {
namespace {

// what contacts find at the start: penetrations and ties
void print_contacts(const Model& model, const InitialReport& r) {
  if (model.contacts.empty()) return;
  fmt::print(
      "contacts: {} nodes penetrate at the start, deepest {:.4g}; {} nodes tied, {} not tied\n",
      r.penetrating_nodes, r.largest_penetration, r.tied_nodes, r.untied_nodes.size());
  for (const InitialPenetration& p : r.worst)
    fmt::print("  contact {} node {} in part {} depth {:.4g}\n", model.contacts[p.contact].id,
               model.nodes.id[p.node], p.segment_part >= 0 ? model.parts[p.segment_part].id : 0,
               p.depth);
}

}  // namespace

int check_command(const CheckCommand& c) {
  Diagnostics diagnostics;
  std::unique_ptr<Model> model = read_deck(c.deck, diagnostics);
  CheckReport report;
  if (model) {
    report = check_model(*model, diagnostics);
    if (!diagnostics.has_errors()) {
      Simulation simulation(*model, {}, diagnostics);
      if (!diagnostics.has_errors()) {
        simulation.step();
        print_contacts(*model, simulation.contacts().initial_report());
      }
    }
    if (!c.write.empty()) {
      std::ofstream out(c.write);
      write_deck(*model, out);
      if (!out) {
        fmt::print(stderr, "fabrica: cannot write {}\n", c.write);
        return 1;
      }
    }
  }
  fmt::print("{}", format_check(report, diagnostics));
  if (diagnostics.has_errors() || !model) return 1;
  return diagnostics.count(Severity::unsupported) > 0 ? 2 : 0;
}

}  // namespace fabrica
