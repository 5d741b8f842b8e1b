#pragma once
// Cards of a rig's rigid parts: material, support, motion, load, mesh, sets.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "body/assembly.h"
#include "body/rig.h"

namespace fabrica::body {

// Mass [kg], place [mm] and inertia about it [kg mm2] (xx xy xz yy yz zz, tensor components) of a
// rigid part, instead of those of its elements.
struct RigidMass {
  double mass = 0;
  Point centre{0, 0, 0};
  std::array<double, 6> inertia{};

  void add(double m, const Point& x);  // a point mass
};

class RigCards {
 public:
  // curves of a support in the model, in the order motion, loads
  using Curves = std::vector<std::int64_t>;

  RigCards(AssembledBody& assembled, Builder& builder);

  std::int64_t set(const char* keyword, const std::string& title,
                   const std::vector<std::int64_t>& ids);
  std::int64_t curve(const std::string& title,
                     const std::vector<std::pair<double, double>>& points);
  Curves curves(const std::string& title, const RigSupport& support);
  // a part of rigid material [kg/mm3] with its motion and loads; its number
  std::int64_t rigid_part(const std::string& title, double density, const RigSupport& support,
                          const Curves& curves, const std::optional<RigidMass>& mass = {});

 private:
  AssembledBody& assembled_;
  Builder& builder_;
  std::int64_t last_curve_ = 8000000;
};

}  // namespace fabrica::body
