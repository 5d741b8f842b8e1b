#pragma once
// The control block of a d3plot file and the word counts that follow from it. Facts: layout of the
// LS-DYNA database as public readers document it. Word = 4 bytes, or 8 if the file is in double
// precision.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace fabrica {

constexpr float d3plot_end = -999999.0f;  // closes every file
constexpr int d3plot_block = 512;         // files are padded to whole blocks of words

// Names are those of the format; values are words 10 to 70 of the control block.
struct D3plotLayout {
  int filetype = 1;
  float version = 960;
  int ndim = 4;   // 4 plain; 5, 7 with materials' types; 8, 9 with rigid bodies as well
  int numnp = 0;  // nodes
  int icode = 6;
  int nglbv = 0;               // global values per state
  int it = 0;                  // temperatures per node; tens digit: added mass per node
  int iu = 1, iv = 1, ia = 1;  // coordinates, velocities, accelerations are there
  int nel8 = 0;                // solids; negative: two extra nodes each
  int nummat8 = 0, numds = 0, numst = 0, nv3d = 7;
  int nel2 = 0, nummat2 = 0, nv1d = 6;  // beams
  int nel4 = 0, nummat4 = 0, nv2d = 0;  // shells
  int neiph = 0, neips = 0;             // extra values per solid, per shell layer
  int maxint = -10003;  // layers of a shell; below -10000: with a table of deleted elements
  int nmsph = 0, ngpsph = 0;
  int narbs = 0;
  int nelt = 0, nummatt = 0, nv3dt = 0;  // thick shells
  std::array<int, 4> ioshl{1000, 1000, 1000,
                           1000};  // stress, plastic strain, resultants, thickness and energy
  int ialemat = 0, ncfdv1 = 0, ncfdv2 = 0, nadapt = 0;
  int nmmat = 0;  // parts
  int numfluid = 0, inn = 1, npefg = 0, nel48 = 0, idtdt = 0, extra = 0;
  int nt3d = 0, neipb = 0;  // of the extra control words
  int rigid_shells = 0;     // of the material section: these have no state data

  int solids() const { return nel8 < 0 ? -nel8 : nel8; }
  int layers() const { return maxint <= -10000 ? -maxint - 10000 : maxint < 0 ? -maxint : maxint; }
  bool element_deletion() const { return maxint <= -10000; }
  bool node_deletion() const { return maxint < 0 && maxint > -10000; }
  bool has(int shell_output) const {
    return ioshl[shell_output] == 1000 || ioshl[shell_output] == 1;
  }
  // strains: 12 values per shell, the last 6 extra values of a solid
  bool strains() const;
  // values of a shell without strains
  int shell_values() const;

  int node_words() const;  // per node and state
  int geometry_words()
      const;  // coordinates and connectivity, after control block and material section
  int deletion_words() const;
  std::int64_t state_words() const;  // time included
};

// 10 + 6 words of pointers, all ids, three arrays of parts.
int numbering_words(const D3plotLayout& layout);

// Control words as 32-bit patterns, in the order of the file.
std::array<std::uint32_t, 64> encode(const D3plotLayout& layout, const std::string& title);

// The layout from 64 words (integers) and the version (a real); the extra words follow where extra
// > 0.
D3plotLayout decode(const std::vector<std::int64_t>& words, float version);

// "d3plot", "d3plot01", ..., "d3plot99", "d3plot100", ...
std::string family_member(const std::string& path, int number);

}  // namespace fabrica
