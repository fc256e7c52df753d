#pragma once

namespace spelunk {

/// How a robot with legs is to wait; robots that fly know no difference.
enum class Posture {
  kStand,
  kLie  ///< Down on the ground, as low as it gets without lying on its side.
};

}  // namespace spelunk
