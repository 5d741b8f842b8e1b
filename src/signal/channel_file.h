#pragma once
// Signals in files: csv tables with units in their header, and channels of ISO/TS 13499 (ISO-MME).
#include <string>
#include <vector>

#include "signal/curve.h"

namespace fabrica {

// Reads one signal named as
//   table.csv                     the second column over the first
//   table.csv:y   table.csv:x:y   columns by name, with or without their unit
//   table.csv:y@column=value      only the rows in which that column holds that value
//   test.mme:CODE, folder:CODE    a channel of an ISO-MME test by its code, or the only one whose
//   code begins so channel.001                   an ISO-MME channel file
// A column's unit stands in its name: force_kN, force [kN], force (kN). Rows with an empty cell in
// either column are left out. Throws SignalError "no-such-file", "no-such-channel", "not-a-number",
// "no-such-row", "bad-channel-file".
Signal read_signal(const std::string& where);

// All columns over the first one, or all channels of an ISO-MME test.
std::vector<Signal> read_all_signals(const std::string& file);

// A csv with one x column for all; signals must share their base ("different-time-base").
void write_csv(const std::string& path, const std::vector<Signal>& signals,
               const std::string& comment = {});

// "force [kN]" -> {"force", "kN"}; the unit is "" where the name carries none that is known.
struct NameAndUnit {
  std::string name, unit;
};
NameAndUnit name_and_unit(const std::string& header);

}  // namespace fabrica
