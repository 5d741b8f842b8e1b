#pragma once
// The body as parts of a model: nodes, elements, sections, materials, contacts, sets, output. Ids
// are coded by region: 1xxxxxx head, 2xxxxxx neck, 3xxxxxx thorax, 4xxxxxx abdomen (lumbar spine),
// 5xxxxxx pelvis, 6xxxxxx arms, 7xxxxxx legs; 8xxxxxx is left for what surrounds the body.
#include <string>
#include <vector>

#include "body/body.h"
#include "model/model.h"

namespace fabrica::body {

// What became of each bone and piece, for measures, sets and cases.
struct PartEntry {
  std::int64_t id = 0;
  std::string name;      // region.side.bone.tissue
  std::string material;  // row of data/materials.csv, or the law's keyword
  std::string source;
  int bone = -1, piece = -1;
  int elements = 0;
  bool rigid = false;
};
struct AssembledBody {
  std::vector<PartEntry> parts;
  std::vector<std::vector<std::int64_t>> bone_node;   // bone -> node -> id
  std::vector<std::vector<std::int64_t>> piece_node;  // piece -> node -> id
  std::vector<std::vector<std::int64_t>> bone_brick;  // bone -> brick -> id
  std::vector<std::vector<std::int64_t>> bone_shell;  // bone -> quad of the surface -> id, 0: none
  std::int64_t all_parts_set = 0;                     // part set of the whole body
  std::int64_t next_part = 8000001, next_node = 8000001, next_element = 8000001, next_set = 8000001;
};

struct AssemblyOptions {
  double end_time = 100;    // [ms]
  double step_scale = 0.9;  // of the stable time step
  double output_every = 1;  // [ms] of histories
  double states_every = 5;  // [ms] of the animation
  bool contacts = true;
  bool fracture = false;  // criteria of materials.csv in strain delete elements
};

// Adds the body to a builder; the caller adds what surrounds it and finishes.
AssembledBody assemble(const Body& body, const AssemblyOptions& options, Builder& builder);

}  // namespace fabrica::body
