#pragma once
// ISO/TS 13499 (ISO-MME): a test is a folder with <test>.mme and, in Channel/, <test>.chn and one
// text file per channel: lines "key :value", the last of them "Number of samples", then one value a
// line.
#include <string>
#include <vector>

#include "signal/curve.h"

namespace fabrica {

// A channel of a test by its code (or unique beginning); of a channel file if `code` is "".
// Errors "no-such-channel", "bad-channel-file", "not-a-number".
Signal read_mme_channel(const std::string& path, const std::string& code);

// Every channel of the test that `path` belongs to: its folder, its .mme or .chn file; or one
// channel file.
std::vector<Signal> read_mme_test(const std::string& path);

// Writes a test: <folder>/<test>.mme, Channel/<test>.chn, Channel/<test>.001, ... A signal's name
// is taken as its channel code; samples must lie at a constant step and x be a time.
void write_mme_test(const std::string& folder, const std::string& test,
                    const std::vector<Signal>& signals);

// "m/s²" and "m/(s*s)" -> "m/s2", "N·m" -> "Nm", "°/s" -> "deg/s"
std::string plain_unit(std::string unit);

}  // namespace fabrica
