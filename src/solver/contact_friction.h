#pragma once
// Friction of a contact: one law for all; with FS = -1 the mean of the two laws that *PART_CONTACT
// gives the parts that touch, where a part without one counts as smooth (the LS-DYNA manual
// (public) leaves open how two parts combine); with FS = -2 the law that *DEFINE_FRICTION gives the
// pair of parts, or its own default for pairs that it does not list.
#include <algorithm>
#include <map>
#include <utility>
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
    if (const Card* card = table(model, contact)) read(model, *card, contact);
    if (contact.fs != -1) return;
    for (const Part& part : model.parts) {
      const PartContact p = part.contact.value_or(PartContact{});
      by_part_.push_back({p.fs * contact.fsf, p.fd * contact.fsf, p.dc, p.vc * contact.vsf});
    }
  }
  bool active() const {
    const auto active = [](const Friction& f) { return f.active(); };
    return law_.active() || std::any_of(by_part_.begin(), by_part_.end(), active) ||
           std::any_of(by_pair_.begin(), by_pair_.end(),
                       [&](const auto& pair) { return active(pair.second); });
  }
  // The law between two parts; -1: of no part.
  Friction between(int part_a, int part_b) const {
    if (!by_pair_.empty()) {
      const auto found = by_pair_.find(std::minmax(part_a, part_b));
      return found == by_pair_.end() ? law_ : found->second;
    }
    if (by_part_.empty()) return law_;
    const Friction a = of(part_a), b = of(part_b);
    return {0.5 * (a.fs + b.fs), 0.5 * (a.fd + b.fd), 0.5 * (a.dc + b.dc),
            0.5 * (a.stress_limit + b.stress_limit)};
  }
  // The *DEFINE_FRICTION of a contact with FS = -2: the one that FD names, or the only one; null if
  // there is none.
  static const Card* table(const Model& model, const Contact& contact) {
    const Card* found = nullptr;
    int count = 0;
    if (contact.fs != -2) return found;
    for (const auto& card : model.cards) {
      if (card->schema->name != "DEFINE_FRICTION") continue;
      if (double(card->id("id")) == contact.fd) return card.get();
      found = card.get(), ++count;
    }
    return count == 1 && contact.fd == 0 ? found : nullptr;
  }

 private:
  void read(const Model& model, const Card& card, const Contact& contact) {
    const auto law = [&](double fs, double fd, double dc, double vc) {
      return Friction{fs * contact.fsf, fd * contact.fsf, dc, vc * contact.vsf};
    };
    const auto part_of = [&](double id) {
      const auto& parts = model.parts;
      const auto found = std::find_if(parts.begin(), parts.end(),
                                      [&](const Part& p) { return p.id == to_id(id); });
      return int(found - parts.begin());
    };
    law_ = law(card.real("fs_d"), card.real("fd_d"), card.real("dc_d"), card.real("vc_d"));
    for (int r = 0; r < card.row_count(); ++r) {
      const int a = part_of(card.row(r, "pid_i")), b = part_of(card.row(r, "pid_j"));
      by_pair_[std::minmax(a, b)] = law(card.row(r, "fs_ij"), card.row(r, "fd_ij"),
                                        card.row(r, "dc_ij"), card.row(r, "vc_ij"));
    }
  }
  Friction of(int part) const { return part < 0 ? Friction{} : by_part_[part]; }
  Friction law_;
  std::vector<Friction> by_part_;                    // empty: the same law for all
  std::map<std::pair<int, int>, Friction> by_pair_;  // lower part first
};

}  // namespace fabrica
