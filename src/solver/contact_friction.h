#pragma once
// Friction of a contact: one law for all, or with FS = -1 the mean of the two laws that
// *PART_CONTACT gives the parts that touch; a part without one counts as smooth. The LS-DYNA manual
// (public) leaves open how two parts combine.
#include <algorithm>
#include <vector>

#include "contact/penalty.h"
#include "model/model.h"

namespace fabrica {

class ContactFriction {
 public:
  ContactFriction(const Model& model, const Contact& contact) {
    law_ = {contact.fs * contact.fsf, contact.fd * contact.fsf, contact.dc,
            contact.vc * contact.vsf};
    if (contact.fs >= 0) return;
    law_ = {};
    if (contact.fs != -1) return;
    for (const Part& part : model.parts) {
      const PartContact p = part.contact.value_or(PartContact{});
      by_part_.push_back({p.fs * contact.fsf, p.fd * contact.fsf, p.dc, p.vc * contact.vsf});
    }
  }
  bool active() const {
    return law_.active() || std::any_of(by_part_.begin(), by_part_.end(),
                                        [](const Friction& f) { return f.active(); });
  }
  // The law between two parts; -1: of no part.
  Friction between(int part_a, int part_b) const {
    if (by_part_.empty()) return law_;
    const Friction a = of(part_a), b = of(part_b);
    return {0.5 * (a.fs + b.fs), 0.5 * (a.fd + b.fd), 0.5 * (a.dc + b.dc),
            0.5 * (a.stress_limit + b.stress_limit)};
  }

 private:
  Friction of(int part) const { return part < 0 ? Friction{} : by_part_[part]; }
  Friction law_;
  std::vector<Friction> by_part_;  // empty: the same law for all
};

}  // namespace fabrica
