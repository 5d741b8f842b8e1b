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

// LS-DYNA pushes back what penetrates at the start where IGNORE is 0; here it stays
void warn_of_penetrations(const Model& model, const Contacts& contacts, Diagnostics& diagnostics) {
  for (const ContactCheck& c : contacts.checks()) {
    const Contact& contact = model.contacts[c.contact];
    if (contact.ignore == 0 && c.initial_nodes > 0)
      diagnostics.warning(
          "contact-ignore-0", contact.where, "CONTACT", "ignore",
          fmt::format("contact {}: {} nodes penetrate at the start, by up to {:.4g}; "
                      "this is not pushed back",
                      contact.id, c.initial_nodes, c.initial_depth),
          "Move the surfaces apart, or accept it by IGNORE = 1");
  }
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
        warn_of_penetrations(*model, simulation.contacts(), diagnostics);
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
