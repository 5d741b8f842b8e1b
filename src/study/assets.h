#pragma once
// The files of web/ that pages need; they are part of the program.
#include <string>

namespace fabrica::study {

// Writes them into FOLDER/assets. Throws StudyError if it cannot.
void write_assets(const std::string& folder);

}  // namespace fabrica::study
