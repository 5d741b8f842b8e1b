#pragma once
// What the other definitions refer to: curves, tables, sets, boxes, coordinate systems. Index -1
// means "none". Units are the deck's own.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/curve.h"
#include "base/tensor.h"
#include "model/mesh.h"

namespace fabrica {

struct Curve {
  std::int64_t id = 0;
  std::string title;
  std::vector<double> x, y;  // scaled and offset; x ascending
  bool for_stress_initialisation = false;
  // value at t, constant outside (time curves)
  double at(double t) const;
  double slope_integral(double a,
                        double b) const;  // exact integral of y over [a, b], end values outside
  // storage for the kernels' views
  std::vector<Real> x_real, y_real;
  CurveView view(bool extrapolate = true) const {
    return {x_real.data(), y_real.data(), int(x_real.size()), extrapolate};
  }
};
struct Table {
  std::int64_t id = 0;
  std::vector<double> rate;
  std::vector<int> curve;  // index into curves
  std::vector<Real> rate_real;
  std::vector<CurveView> views;
  bool log_rate = false;
};

struct NodeSet {
  std::int64_t id = 0;
  std::string title;
  std::vector<int> nodes;
};
struct PartSet {
  std::int64_t id = 0;
  std::string title;
  std::vector<int> parts;
};
struct SegmentSet {
  std::int64_t id = 0;
  std::string title;
  std::vector<std::array<int, 4>> segments;
};
struct ElementSet {
  std::int64_t id = 0;
  Family family = Family::none;
  std::string title;
  std::vector<int> elements;
};
struct Box {
  std::int64_t id = 0;
  Vec3d low, high;
};
struct CoordinateSystem {
  std::int64_t id = 0;
  Vec3d origin;
  Mat3d axes;                           // rows: local x, y, z in global components, at the start
  std::array<int, 3> node{-1, -1, -1};  // of *DEFINE_COORDINATE_NODES
  bool moves = false;                   // FLAG = 1
};
struct SdOrientation {
  std::int64_t id = 0;
  int option = 0;  // IOP
  Vec3d direction;
  std::array<int, 2> node{-1, -1};
};

}  // namespace fabrica
