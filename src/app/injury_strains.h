#pragma once
// Strains of organs and ribs from the animation of a run.
#include <map>
#include <string>
#include <vector>

#include "injury/measures.h"

namespace fabrica {

// What `--part` and `--strain` say: parts by tissue ("brain", "ribs", "liver", ...), each a list of
// items with '+' between the parts of one item; a part is an id or its title.
struct StrainRequest {
  std::map<std::string, std::vector<std::string>> parts;
  std::string measure = "logarithmic";
};
// "brain=12,13" and "ribs=thorax.left.rib05.cortical,301+302". Throws SignalError.
StrainRequest strain_request(const std::vector<std::string>& parts, const std::string& measure);

// The channels "TISSUE.strain" of a run's folder and a line for each that says what they were taken
// from: of brain, liver, spleen, kidney, heart and lung from their solids, of each rib the largest
// of its shells and solids. Without a request the parts are those whose title holds the word of the
// organ, and "cortical" beside "ribN". Empty where the folder has no d3plot. Throws SignalError
// "no-such-part", "no-elements", "cannot-read".
struct RunStrains {
  Channels channels;
  std::vector<std::string> notes;
};
RunStrains strains_of_run(const std::string& folder, const StrainRequest& request);

}  // namespace fabrica
