#pragma once

#include "spelunk/mission/endurance.h"
#include "spelunk/mission/flight.h"
#include "spelunk/mission/mission_params.h"
#include "spelunk/mission/robot_watch.h"
#include "spelunk/mission/safe_space.h"

namespace spelunk::mission {

/// What every part may look at. Only the mission itself gives these parts orders; they know none of
/// the parts that look at them.
struct Basis {
  const MissionParams& params;
  const RobotModel& robot;
  const RobotWatch& watch;
  const Endurance& endurance;
  const Flight& flight;
  SafeSpace& space;  ///< Not const for what it keeps to answer faster.
};

}  // namespace spelunk::mission
