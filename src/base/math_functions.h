#pragma once
// Functions of one number that decks may name, in small letters: in *PARAMETER_EXPRESSION and in
// functions and curves given by formula.
#include <cmath>
#include <map>
#include <string>

namespace fabrica {

using FunctionOfOne = double (*)(double);

inline const std::map<std::string, FunctionOfOne, std::less<>>& functions_of_one() {
  static const std::map<std::string, FunctionOfOne, std::less<>> list{
      {"abs", [](double a) { return std::abs(a); }},
      {"fabs", [](double a) { return std::abs(a); }},
      {"sqrt", [](double a) { return std::sqrt(a); }},
      {"exp", [](double a) { return std::exp(a); }},
      {"log", [](double a) { return std::log(a); }},
      {"ln", [](double a) { return std::log(a); }},
      {"log10", [](double a) { return std::log10(a); }},
      {"sin", [](double a) { return std::sin(a); }},
      {"cos", [](double a) { return std::cos(a); }},
      {"tan", [](double a) { return std::tan(a); }},
      {"asin", [](double a) { return std::asin(a); }},
      {"acos", [](double a) { return std::acos(a); }},
      {"atan", [](double a) { return std::atan(a); }},
      {"sinh", [](double a) { return std::sinh(a); }},
      {"cosh", [](double a) { return std::cosh(a); }},
      {"tanh", [](double a) { return std::tanh(a); }},
      {"floor", [](double a) { return std::floor(a); }},
      {"ceil", [](double a) { return std::ceil(a); }},
      {"aint", [](double a) { return std::trunc(a); }},
      {"anint", [](double a) { return std::round(a); }}};
  return list;
}

}  // namespace fabrica
