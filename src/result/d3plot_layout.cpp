#include "result/d3plot_layout.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <stdexcept>

namespace fabrica {

int D3plotLayout::shell_values() const {
  return layers() * (6 * has(0) + has(1) + neips) + 8 * has(2) + 4 * has(3);
}

bool D3plotLayout::strains() const {
  if (idtdt >= 100) return idtdt / 10000 % 10 == 1;
  return nel4 > 0 && nv2d - shell_values() > 1;
}

int D3plotLayout::node_words() const {
  constexpr int thermal[] = {0, 1, 4, 6};  // temperature, with flux, with three temperatures
  const int temperatures = it % 10 < 4 ? thermal[it % 10] : 0;
  const int added_mass = it / 10 % 10 == 1;
  const int rates =
      idtdt % 10 + 6 * (idtdt / 10 % 10);  // of temperature; residual forces and moments
  return 3 * (iu != 0) + temperatures + added_mass + rates + 3 * (iv != 0) + 3 * (ia != 0);
}

int D3plotLayout::geometry_words() const {
  return 3 * numnp + 9 * solids() + 2 * (nel8 < 0 ? solids() : 0) + 9 * nelt + 6 * nel2 + 5 * nel4;
}

int D3plotLayout::deletion_words() const {
  return element_deletion() ? solids() + nelt + nel4 + nel2 : node_deletion() ? numnp : 0;
}

std::int64_t D3plotLayout::state_words() const {
  return 1 + std::int64_t(nglbv) + std::int64_t(numnp) * node_words() +
         std::int64_t(solids()) * (nv3d + nt3d) + std::int64_t(nelt) * nv3dt +
         std::int64_t(nel2) * nv1d + std::int64_t(nel4 - rigid_shells) * nv2d + deletion_words();
}

int numbering_words(const D3plotLayout& l) {
  return 16 + l.numnp + l.solids() + l.nel2 + l.nel4 + l.nelt + 3 * l.nmmat;
}

std::array<std::uint32_t, 64> encode(const D3plotLayout& l, const std::string& title) {
  std::array<std::uint32_t, 64> w{};
  std::string text = title;
  text.resize(40, ' ');
  std::memcpy(w.data(), text.data(), 40);
  // 10 is the time of the run: zero, so that equal runs give equal files
  std::memcpy(&w[13], "R712", 4);
  w[14] = std::bit_cast<std::uint32_t>(l.version);
  const int integers[] = {
      l.ndim,    l.numnp,   l.icode,   l.nglbv,  l.it,       l.iu,       l.iv,       l.ia,
      l.nel8,    l.nummat8, l.numds,   l.numst,  l.nv3d,     l.nel2,     l.nummat2,  l.nv1d,
      l.nel4,    l.nummat4, l.nv2d,    l.neiph,  l.neips,    l.maxint,   l.nmsph,    l.ngpsph,
      l.narbs,   l.nelt,    l.nummatt, l.nv3dt,  l.ioshl[0], l.ioshl[1], l.ioshl[2], l.ioshl[3],
      l.ialemat, l.ncfdv1,  l.ncfdv2,  l.nadapt, l.nmmat,    l.numfluid, l.inn,      l.npefg,
      l.nel48,   l.idtdt,   l.extra};
  w[11] = std::uint32_t(l.filetype);
  for (std::size_t i = 0; i < std::size(integers); ++i) w[15 + i] = std::uint32_t(integers[i]);
  return w;
}

D3plotLayout decode(const std::vector<std::int64_t>& w, float version) {
  D3plotLayout l;
  int* const fields[] = {&l.ndim,     &l.numnp,    &l.icode,   &l.nglbv,   &l.it,       &l.iu,
                         &l.iv,       &l.ia,       &l.nel8,    &l.nummat8, &l.numds,    &l.numst,
                         &l.nv3d,     &l.nel2,     &l.nummat2, &l.nv1d,    &l.nel4,     &l.nummat4,
                         &l.nv2d,     &l.neiph,    &l.neips,   &l.maxint,  &l.nmsph,    &l.ngpsph,
                         &l.narbs,    &l.nelt,     &l.nummatt, &l.nv3dt,   &l.ioshl[0], &l.ioshl[1],
                         &l.ioshl[2], &l.ioshl[3], &l.ialemat, &l.ncfdv1,  &l.ncfdv2,   &l.nadapt,
                         &l.nmmat,    &l.numfluid, &l.inn,     &l.npefg,   &l.nel48,    &l.idtdt,
                         &l.extra};
  l.filetype = int(w[11] % 1000);
  l.version = version;
  for (std::size_t i = 0; i < std::size(fields); ++i) *fields[i] = int(w[15 + i]);
  if (l.extra > 0 && w.size() >= 68) {
    l.nt3d = int(w[65]);
    l.neipb = int(w[67]);
  }
  const bool counts =
      l.numnp >= 0 && l.nel2 >= 0 && l.nel4 >= 0 && l.nelt >= 0 && l.nmmat >= 0 && l.narbs >= 0;
  if (!counts || l.ndim < 2 || l.ndim > 9)
    throw std::runtime_error("the control block is not that of a d3plot");
  return l;
}

std::string family_member(const std::string& path, int number) {
  return number == 0 ? path : fmt::format("{}{:02d}", path, number);
}

}  // namespace fabrica
