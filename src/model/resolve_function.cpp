// *DEFINE_FUNCTION, *DEFINE_FUNCTION_TABULATED, and *DEFINE_CURVE_FUNCTION, which becomes a curve
// over time before the run.
#include "model/resolve.h"

namespace fabrica {
namespace {

std::string text_of(const Card& card) {
  std::string text;
  for (int i = 0; i < card.row_count(); ++i) text += std::string(card.row_text(i, 0)) + '\n';
  return text;
}

}  // namespace

void Resolver::read_function(const Card& card) {
  define("function", card.id("fid"), card_index_[&card], card, "fid");
  function_cards_.push_back(&card);
}

void Resolver::read_curve_function(const Card& card) {
  if (define("function", card.id("lcid"), card_index_[&card], card, "lcid"))
    curve_functions_[card.id("lcid")] = &card;
}

void Resolver::add_function(FunctionLibrary& library, const Card& card) {
  try {
    if (card.schema->name == "DEFINE_FUNCTION") return library.add(text_of(card));
    Curve points;
    for (int i = 0; i < card.row_count(); ++i) {
      points.x.push_back(card.row(i, "a1")), points.y.push_back(card.row(i, "o1"));
      if (i > 0 && points.x[i] < points.x[i - 1])
        throw FunctionError("its arguments do not rise", false);
    }
    library.add(card.text("function"), std::move(points));
  } catch (const FunctionError& e) {
    unsupported(card, "function", "function-not-evaluated",
                "function " + std::to_string(card.id("fid")) + ": " + e.what(),
                "Write it with float variables, =, if, while, for and return");
  }
}

void Resolver::tabulate(FunctionLibrary& library, const Card& card, double end) {
  const std::int64_t id = card.id("lcid");
  curve_functions_[id] = nullptr;
  try {
    const Expression expression = library.expression(text_of(card));
    for (const std::int64_t named : expression.curves)
      if (const auto it = curve_functions_.find(named); it != curve_functions_.end() && it->second)
        tabulate(library, *it->second, end);
    Curve curve = library.tabulated(expression.value, end);
    curve.for_stress_initialisation = card.integer("sidr") == 1;
    add_curve(card, std::move(curve));
  } catch (const FunctionError& e) {
    const std::string what = "curve " + std::to_string(id) + ": " + e.what();
    if (e.unknown())
      unsupported(card, "function", "function-not-evaluated", what,
                  "Use TIME, curves (LC7), functions of the deck and arithmetic, or give the curve "
                  "by points");
    else
      error(card, "function", "bad-function", what, "Correct the function");
  }
}

void Resolver::resolve_functions() {
  if (curve_functions_.empty() && function_cards_.empty()) return;
  double end = 0;
  for (const auto& card : model_.cards)
    if (card->schema && card->schema->name == "CONTROL_TERMINATION") end = card->real("endtim");

  FunctionLibrary library([&](std::int64_t id, double time) {
    const int index = reference("curve", id);
    if (index < 0)
      throw FunctionError("there is no curve " + std::to_string(id) + " that is evaluated", true);
    return model_.curves[std::size_t(index)].at(time);
  });
  for (const Card* card : function_cards_) add_function(library, *card);
  for (const auto& [id, card] : curve_functions_) {
    if (!card) continue;
    if (end > 0)
      tabulate(library, *card, end);
    else
      error(*card, "lcid", "no-end-time",
            "curve " + std::to_string(id) + " is a function of time, and the run has no end",
            "Give *CONTROL_TERMINATION with ENDTIM");
  }
}

}  // namespace fabrica
