#include <fmt/core.h>

#include <CLI/CLI.hpp>

#include "app/bench.h"
#include "app/body.h"
#include "app/injury.h"
#include "app/joints.h"
#include "app/run.h"
#include "app/show.h"
#include "app/signals.h"
#include "app/study.h"
#include "model/wall_method.h"

namespace {

void add_run(CLI::App& app, fabrica::RunCommand& c) {
  auto* run = app.add_subcommand("run", "Solve a keyword deck");
  run->add_option("deck", c.deck, "keyword deck (.k, .key; also .gz, .zst)")
      ->required()
      ->check(CLI::ExistingFile);
  run->add_option("--out", c.out, "folder for results (made if missing)")->capture_default_str();
  run->add_option("--threads", c.threads, "threads; 0 takes every core")->capture_default_str();
  run->add_option("--until", c.until, "end time; 0 takes the deck's")->capture_default_str();
  run->add_option("--restart", c.restart, "continue from this restart file")
      ->check(CLI::ExistingFile);
  run->add_option("--restart-every", c.restart_interval,
                  "time between restart files; 0 writes one at the end");
  run->add_flag("--vtu", c.vtu, "also write a .vtu series for ParaView");
  run->add_flag("--allow-unsupported", c.allow_unsupported,
                "run although the deck holds keywords that are not supported");
  run->add_option("--walls", c.walls,
                  "how rigid walls stop nodes: impulse (before they are behind, Coulomb friction), "
                  "constraint (put back once found behind, as LS-DYNA is described to)")
      ->check(CLI::IsMember(fabrica::wall_method_names()))
      ->capture_default_str();
  run->add_flag("--quiet", c.quiet, "no progress lines");
  run->callback([&c] { throw CLI::RuntimeError(fabrica::run_command(c)); });
}

void add_check(CLI::App& app, fabrica::CheckCommand& c) {
  auto* check =
      app.add_subcommand("check", "Read a deck, report what it holds and what is wrong with it");
  check->add_option("deck", c.deck, "keyword deck")->required()->check(CLI::ExistingFile);
  check->add_option("--write", c.write, "write the model back as one deck");
  check->callback([&c] { throw CLI::RuntimeError(fabrica::check_command(c)); });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"fabrica: explicit finite elements for crash and injury research"};
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string(FABRICA_VERSION));
  fabrica::RunCommand run;
  fabrica::CheckCommand check;
  fabrica::BenchCommand bench;
  fabrica::ShowCommands show;
  fabrica::BodyCommand body;
  fabrica::StudyCommands study;
  add_run(app, run);
  add_check(app, check);
  fabrica::add_bench(app, bench);
  fabrica::add_show(app, show);
  fabrica::add_body(app, body);
  fabrica::SignalCommands signals;
  fabrica::add_signals(app, signals);
  fabrica::add_study(app, study);
  fabrica::JointsCommand joints;
  fabrica::add_joints(app, joints);
  fabrica::InjuryCommand injury;
  fabrica::add_injury(app, injury);
  try {
    app.parse(argc, argv);
  } catch (const CLI::RuntimeError& e) {
    return e.get_exit_code();
  } catch (const CLI::ParseError& e) {
    return app.exit(e);
  } catch (const std::exception& e) {
    fmt::print(stderr, "fabrica: {}\n", e.what());
    return 1;
  }
  return 0;
}
